#pragma once

#include <array>

#include "ground/crossing.hpp"
#include "ground/edge_functions.hpp"
#include "motion/motion.hpp"

/// Where a curved path meets the edges of regions. Between two times all roots of the edges' equations along
/// the path are found, none missed; the region's side between two roots follows from an exact test of a point
/// in between. Source: docs/theory.md 5.3.
namespace hybrid_sphere {

/// A piece of a curved path between two times since the beginning of its segment.
struct CurvedPath {
  /// @param of_curve  that of the motion
  CurvedPath(Motion& of_motion, const Curve& of_curve, double from_time, double until_time);

  /// Motion::path at a time. Regions ask for the same few times: the last ones are remembered.
  const PointState& at(double time) const;
  /// The same of Motion::center: the place [m].
  Vector2d place_at(double time) const {
    return is_integrated ? motion.center(time).position : at(time).position;
  }

  Motion& motion;
  Curve curve;
  double from;
  double until;
  Vector2d start;                   ///< its place at `from` [m]
  Vector2d low;                     ///< corners of a box that holds the piece
  Vector2d high;                    ///< [m]
  Vector2d velocity;                ///< of the centre, at `from` [m/s]
  Vector2d contact_velocity;        ///< of the contact
  Vector2d reference_velocity;      ///< see Motion
  bool is_integrated;               ///< if so, the velocities are no better than the tolerance of a step
  PointState first{};               ///< of an integrated path, at `from`
  PointState last{};                ///< and at `until`
  mutable std::size_t samples = 0;  ///< evaluations of the path asked for so far: the cost of the search

 private:
  struct Sample {
    double time = -1;
    PointState state{};
  };
  mutable std::array<Sample, 4> remembered_{};
  mutable std::size_t oldest_ = 0;
};

/// A time at which a path may meet a piece of edge.
struct Candidate {
  double time;
  double error;
  EdgePiece piece;
};
using Candidates = std::vector<Candidate>;

/// Lines on which a path starts. Regions whose edges lie on one line share one function of it, so that
/// rounding cannot make the path leave one edge and not the other.
class StartLines {
 public:
  void reserve(std::size_t count) { lines_.reserve(count); }
  void clear() { lines_.clear(); }
  /// The function of this line that was requested first.
  LineFunction shared(const LineFunction& own);

 private:
  std::vector<LineFunction> lines_;
};

/// How a path leaves the edge on which it starts.
struct EdgeInterval {
  double until;  ///< until then it is indistinguishable from lying on the edge; path.from without contacts
  bool on_edge;  ///< it lies on the edge until then
  std::optional<EdgePiece> piece{};  ///< of a polygon, on which it lies then
};

/// Appends, in any order, the times in [path.from, path.until] at which the path meets the edge of a region;
/// may include a few near misses.
/// @param contacts_begin, contacts_end  pieces of it on which the path is at path.from: no roots there
/// @param lines  of the contacts of this path at path.from
EdgeInterval find_candidates(const CurvedPath& path, const scene::Shape& shape, const Contact* contacts_begin,
                             const Contact* contacts_end, StartLines& lines, Candidates& candidates);

/// Pieces of a region's edge on which a point lies exactly.
void pieces_at(const scene::Shape& shape, RegionId id, const Vector2d& point, Contacts& pieces);

}  // namespace hybrid_sphere
