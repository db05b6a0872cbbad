#pragma once

#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "ground/ground.hpp"
#include "ground/straight_run.hpp"
#include "ground/trace_curve.hpp"

namespace hybrid_sphere {

/// What a path meets, in order: at each instant the regions whose edges it crosses there, and which region
/// then lies under it. Rules: docs/theory.md 5.2.
///
/// A path is traced a piece at a time, over the regions near that piece. Instants of a straight path that
/// differ by less than rounding are separated exactly; those of a curved path count as one if their error
/// bounds overlap that of the best-known one.
class EdgeEvents {
 public:
  explicit EdgeEvents(std::shared_ptr<const Ground> ground);

  /// Replaces the ground; begin() must follow.
  void set_ground(std::shared_ptr<const Ground> ground);

  /// Traces the first piece of a new straight path. Does not allocate if the map is small.
  /// @param start     [m]
  /// @param velocity  of the centre, constant [m/s]
  /// @param contacts  edges on which the path is known to start
  void begin(const Vector2d& start, const Vector2d& velocity, const Contacts& contacts);

  /// The same for an accelerated path, which must outlive it.
  /// @param scale  time in which forces change the motion [s]: the first piece is not much longer
  /// @param first  for an integrated motion, bound on the length of the first piece, > 0 [s]
  void begin(Motion& motion, double scale, double first, const Contacts& contacts);

  /// Time from the start of the path to the next instant at which an edge is crossed or, if no crossing is
  /// known ahead, to the end of the traced piece [s]; infinite if nothing lies ahead.
  double next_instant() const {
    return (crosses_next() ? crossings_[next_].time : traced_until_) * time_unit_;
  }

  /// Whether next_instant() is a crossing rather than just the end of the traced piece.
  bool crosses_next() const {
    return next_ != crossings_.size() && crossings_[next_].time + crossings_[next_].error < traced_until_;
  }

  /// What next_instant() loses by rounding, if known: on straight paths to straight edges [s].
  double remainder_of_next_instant() const {
    if (motion_ || !crosses_next()) return 0;
    const Crossing& next = crossings_[next_];
    return time_remainder(path_, ground_->shape(next.region), next) * time_unit_;
  }

  /// When the motion ends by itself, if the path is traced that far; otherwise `never` [s].
  double end() const { return end_; }

  /// Traces the next piece; call it when no crossing lies before next_instant().
  void extend();

  /// Crosses all edges of the next instant.
  void pass_instant();

  /// Bound on the error of the instant passed last [s].
  double doubt() const { return group_ < next_ ? crossings_[group_].doubt * time_unit_ : 0; }

  /// Passes an instant at which no edge is crossed.
  void pass_without_crossing() {
    group_ = next_;
    run_.pass_without_crossing();
  }

  /// Direction of the straight line on which the path lies and accelerates, of any length; 0 if there is
  /// none.
  Vector2d line() const { return run_.direction(); }
  bool is_on_line() const { return run_.runs(); }

  /// The next path is unrelated to the previous one.
  void forget_path() { run_.forget(); }

  /// The region in force just after the current instant: the one in force before if it is still visible,
  /// otherwise the topmost visible one.
  RegionId forward_region(RegionId in_force) const;

  /// Whether a region is visible just after the current instant.
  bool visible(RegionId region) const { return forward_region(region) == region; }

  /// Edges on which the path is at the instant reached last. Valid until the next call.
  const Contacts& contacts();

  /// The last edge of either region crossed at the instant passed last; if there is none, a contact with no
  /// region.
  Contact crossed_edge(RegionId a, RegionId b) const;

  /// The position at the instant passed last, exact in each coordinate that the crossed edges fix, or the
  /// line of a straight path along an axis.
  Vector2d snap_to_edge(Vector2d position) const;

 private:
  struct RegionStatus {
    RegionId region = 0;
    Side side = Side::outside;
    EdgePiece along;  // followed while side is Side::edge
    bool followed = false;
    bool crosses_ahead = false;  // in the traced part
  };

  /// What a piece of path meets of one region.
  struct Found {
    std::size_t begin;  // of candidates_
    std::size_t end;
    double left;  // until then it is indistinguishable from lying on the edge on which it begins
  };

  void clear();
  void begin_piece();
  void find_piece();
  void extend_straight();
  void extend_curved();
  void extend_line();
  double choose_until();
  void locate_at(const Vector2d& position);
  bool choose_straight_piece(double& until) const;
  bool meets_many_from(const Vector2d& place) const;
  double choose_curved_span() const;
  void adapt_span(std::size_t cost);
  double choose_line_span() const;
  bool repeats_itself() const;
  void activate(const Box& box);
  void trace_straight(RegionStatus& status);
  std::optional<Side> side_of_short_path(const CurvedPath& path, const RegionStatus& status) const;
  void find_curved_candidates(const CurvedPath& path);
  double end_of_few(double until);
  double end_of_certainty(double until) const;
  double certain_before(double time) const;
  void trace_curved(const CurvedPath& path, const RegionStatus& status, const Found& found);
  void agree_on_times();
  bool is_same_instant(const Crossing& before, const Crossing& next) const;
  int compare_crossings(const Crossing& a, const Crossing& b) const;
  RegionStatus* status_of(RegionId region);
  Side side_on_edge(const RegionStatus& status) const;
  /// The next of the statuses, by region.
  void add_status(const RegionStatus& status) {
    statuses_.push_back(status);
    note_cover();
  }
  void note_cover() {
    if (statuses_.back().side != Side::outside) covering_.push_back(statuses_.size() - 1);
  }
  void change_covering(std::size_t i);
  void find_covering();

  std::shared_ptr<const Ground> ground_;
  Motion* motion_ = nullptr;  // null: the velocity is constant
  StraightRun run_;           // of a motion on a straight line
  Path path_;
  double time_unit_ = 1;     // time [s] = crossing time * time_unit_, a power of two
  double traced_until_ = 0;  // all crossings before that are known
  double span_ = 0;          // of the next piece [in the unit of crossing times]
  double scale_ = never;     // [s]
  double end_ = never;       // of the motion [s]
  double quiet_from_ = 0;    // a curved path has met no edge since then [s]
  bool at_start_ = false;

  std::vector<Crossing> crossings_;     // ascending
  std::size_t next_ = 0;                // the first one ahead
  std::size_t group_ = 0;               // the first one of the instant passed last
  std::vector<RegionStatus> statuses_;  // of the regions near the traced piece, by region
  std::vector<std::size_t> covering_;   // indices in it of those that contain the sphere, edges included
  Contacts contacts_;
  Contacts start_contacts_;

  // Storage reused from piece to piece.
  std::vector<RegionId> near_;
  std::vector<RegionId> near_bounded_;
  std::vector<RegionStatus> statuses_before_;
  std::vector<Crossing> crossings_before_;
  StartLines start_lines_;
  Candidates candidates_;
  std::vector<double> times_;
  std::vector<Found> found_;
  Contacts region_contacts_;
  std::vector<std::pair<RegionId, std::size_t>> crossed_;  // at one instant, and the crossing's number
};

}  // namespace hybrid_sphere
