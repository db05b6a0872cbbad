#pragma once

#include <limits>
#include <memory>
#include <vector>

#include "hybrid_sphere/ground/ground.hpp"

namespace hybrid_sphere {

/// What a path meets, in order: at each instant the regions whose edges it crosses there, and which region
/// then lies under it. Instants that differ by less than rounding are told apart exactly. Rules:
/// docs/theory.md 5.2.
class Itinerary {
 public:
  explicit Itinerary(std::shared_ptr<const Ground> ground);

  /// Exchanges the ground; begin() must follow.
  void set_ground(std::shared_ptr<const Ground> ground);

  /// Traces a new path over all regions. Does not allocate.
  /// @param start     [m]
  /// @param velocity  of the centre, constant [m/s]
  /// @param contacts  edges on which the path is known to start
  void begin(const Vector2d& start, const Vector2d& velocity, const Contacts& contacts);

  /// Time from the start of the path to the next instant at which an edge is crossed [s]; infinite when there
  /// is none.
  double next_instant() const {
    return next_ == crossings_.size() ? std::numeric_limits<double>::infinity()
                                      : std::ldexp(crossings_[next_].time, time_exponent_);
  }

  /// Crosses all edges of the next instant.
  void pass_instant();

  /// The region in force just after the current instant: the one in force before as long as it is visible,
  /// else the topmost visible one.
  RegionId forward_region(RegionId in_force) const;

  /// Edges on which the path is at the instant that was passed last. Valid until the next call.
  const Contacts& contacts();

  /// The position at the instant passed last, exact in each coordinate that the crossed edges fix.
  Vector2d settle(Vector2d position) const;

 private:
  struct Standing {
    Side side = Side::outside;
    EdgePiece along;  // followed while side is Side::edge
  };

  void agree_on_times();
  int compare_crossings(const Crossing& a, const Crossing& b) const;

  std::shared_ptr<const Ground> ground_;
  Path path_;
  int time_exponent_ = 0;            // time [s] = crossing time * 2^time_exponent_
  std::vector<Crossing> crossings_;  // of all regions, ascending
  std::size_t next_ = 0;             // the first one ahead
  std::size_t group_ = 0;            // the first one of the instant passed last
  std::vector<Standing> standing_;   // by region
  Contacts contacts_;
};

}  // namespace hybrid_sphere
