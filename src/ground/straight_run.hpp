#pragma once

#include <optional>
#include <vector>

#include "geometry/certified_root.hpp"
#include "ground/ground.hpp"
#include "ground/line_profile.hpp"
#include "motion/motion.hpp"

namespace hybrid_sphere {

/// What an accelerated motion on one straight line meets. The edges on the line, their order and the line's
/// sides in between are exact (line_profile.hpp); the motion only determines when it reaches the next edge,
/// and when it turns back to pass the same ones again. A line outlasts the segment: the next segment
/// continues along it if its velocity is parallel to the line to rounding. Source: docs/theory.md 5.3.
class StraightRun {
 public:
  /// Replaces the ground, which must outlive this object; begin() must follow.
  void set_ground(const Ground& ground);
  /// The next path is on a new line.
  void forget() { line_.reset(); }

  /// @param motion    begins at its time 0; must outlive the run
  /// @param contacts  edges on which it begins
  /// @return          whether its path lies on a straight line; if not, the other members do not apply
  bool begin(Motion& motion, const Contacts& contacts);
  bool runs() const { return motion_ != nullptr; }
  /// That of the motion, whether it is straight or not.
  const Curve& curve() const { return curve_; }
  /// Direction of the line, of any length; 0 if there is none.
  Vector2d direction() const { return runs() ? line_->direction() : Vector2d(Vector2d::Zero()); }
  void end() {
    motion_ = nullptr;
    forget();
  }

  /// Traces those of the regions that are not known yet, and forgets all regions not listed.
  /// @param from  the motion is known up to here [s]
  void keep(const std::vector<RegionId>& regions, double from);

  /// Side and side followed just after the start, of a region that is kept.
  Section section_ahead(RegionId region) const;

  /// Appends what is crossed between two times: ascending, one time for each instant.
  /// @param from   where the last call ended
  /// @param ended  whether the motion ends at `until` of itself
  void find_crossings(double from, double until, bool ended, std::vector<Crossing>& crossings);

  /// The motion has crossed an edge.
  void pass(const Crossing& crossing);
  /// The motion has reached an instant at which no edge is crossed.
  void pass_without_crossing() { place_.reset(); }

  /// A coordinate that the line fixes.
  void snap_to_edge(Vector2d& position) const;

  /// Number of evaluations of the motion so far: the cost of the search.
  std::size_t samples() const { return samples_; }
  /// Whether the motion has a constant acceleration.
  bool is_parabola() const { return curve_.form == CurveForm::parabola; }

 private:
  struct Profile {
    RegionId region = no_region;
    std::size_t begin = 0;  // of its crossings
    std::size_t size = 0;
    Section last;            // above all of them
    std::size_t found = 0;   // number below the place up to which crossings have been found
    std::size_t passed = 0;  // the same for the place that the motion has reached
    bool operator<(RegionId id) const { return region < id; }
  };
  /// The motion along the line at a time, in units of lambda.
  struct Sample {
    double place;
    double speed;
    double noise;  // of the place
  };

  Vector2d direction_from(const Contacts& contacts);
  bool follow(const Contacts& contacts);
  void see_reach();
  bool goes_on() const;
  void place_at_start(Profile& profile) const;
  void trace(Profile& profile, double from);
  void collect(const std::vector<RegionId>& regions, double from);
  const LineCrossing& level(const Profile& profile, std::size_t i) const {
    return levels_[profile.begin + i];
  }
  const LineCrossing* ahead(const Profile& profile, int way) const;
  int order(const LineCrossing& a, const LineCrossing& b) const;
  const scene::Shape& shape(const LineCrossing& crossing) const { return ground_->shape(crossing.region); }

  Sample sample(double time) const;
  void find_nearest();
  void sweep(double from, double until, std::vector<Crossing>& crossings);
  void run_parabola(double from, double until, std::vector<Crossing>& crossings);
  void cross(int way, const Sample& limit, double from, double until, std::vector<Crossing>& crossings);
  void stop_on_edges(double end, std::vector<Crossing>& crossings);
  geometry::Root time_of(const LineCrossing& level, int way, double from, double until) const;
  geometry::Root time_on_parabola(const LineCrossing& level, double from) const;
  double guess_time(double lambda, double from) const;

  const Ground* ground_ = nullptr;
  std::optional<Line> line_;
  Contacts contacts_;                        // edges on which its anchor lies
  std::optional<LineCrossing> place_;        // where the motion is, if that is a known place on the line
  std::optional<LineCrossing> start_place_;  // where it began

  Motion* motion_ = nullptr;
  Curve curve_;
  double start_ = 0;     // lambda
  int way_ = 1;          // in which it begins
  double turn_ = never;  // of a parabola [s]
  double speed_ = 0;  // along the line, of centre and contact where the last search began, times its length
  double pull_ = 0;   // of the forces there, also of those that cancel, of an integrated motion
  double reach_ = 0;  // greatest coordinate so far of a place from which later results are computed [m]

  std::vector<Profile> profiles_;     // by region
  std::vector<LineCrossing> levels_;  // of all of them
  double above_ = never;              // nothing lies between these two but the place
  double below_ = -never;
  mutable std::size_t samples_ = 0;

  struct Met {
    const LineCrossing* level;
    Section after;
  };
  std::vector<Met> met_;
  std::vector<Profile> profiles_before_;
  std::vector<LineCrossing> levels_before_;
  LineRoom room_;
};

}  // namespace hybrid_sphere
