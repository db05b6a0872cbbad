#pragma once

#include <deque>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "hybrid_sphere/mechanics/plant.hpp"
#include "mechanics/active_set_rules.hpp"
#include "mechanics/segment.hpp"

namespace hybrid_sphere::mechanics {

/// What a TimeStepper is asked for.
struct TimeDemand {
  double horizon = 0;  ///< time over which errors may add up to the accuracy [s]
  double end = std::numeric_limits<double>::infinity();  ///< nothing after it is computed [s]
  bool keeps_history = false;                            ///< whether segments before the present are kept
};

/// Advances a hybrid system in time: takes the steps of its segments, and applies the resets between them. It
/// takes whole steps, beyond the time asked for, so that the motion does not depend on the times asked for; a
/// switch happens when its time is reached.
class TimeStepper {
 public:
  /// @param model    must outlive this object; if it changes, restore(memory()) must follow
  /// @param initial  checked
  TimeStepper(const Model& model, const Initial& initial, const Options& options, const TimeDemand& demand);

  /// To be called once, first: the constraints that hold already.
  /// @param active  see Initial
  /// Throws std::invalid_argument if the initial state is off one of them.
  Status start(const std::optional<ActiveSet>& active);

  /// @param on_switch  called with time() at the switch; may call memory() and begin_again()
  /// @return  reached_end at `until`, or why and where the motion has ended before
  Status advance(double until, const SwitchSink& on_switch);

  double time() const { return now_; }
  /// That in which time() is.
  const Segment& segment() const { return segments_.back(); }
  /// All, if the history is kept; the last use of this object.
  std::vector<Segment> take_segments() { return std::move(segments_); }
  Effort effort() const { return integrator_.effort(); }
  std::uint64_t switches() const { return counts_.switches; }
  /// The scale of the motion so far.
  Sizes sizes() const { return integrator_.sizes(lead_.time, lead_.q, lead_.v); }
  Precision precision() const { return {options_.accuracy, integrator_.position_scale()}; }
  /// Change of the initial state by start().
  const Projection& projection() const { return projection_; }

  /// What the motion depends on from time() on, besides the model.
  struct Memory {
    double time = 0;
    Node node;  // x = 0
    ActiveSetRules::Memory rules;
    SegmentIntegrator::Memory integrator;
    std::uint64_t switches = 0;
  };
  Memory memory() const;
  /// Begins a segment at time(), after the model has changed. Velocities that violate a constraint that holds
  /// are put onto it by an impulse when the motion continues. Switches that have not been reported yet stay.
  /// @param memory  memory(), from before the change
  void begin_again(const Memory& memory);
  /// The same in an earlier state; switches that have not been reported yet are dropped.
  void restore(const Memory& memory);

 private:
  template <class Work>
  std::optional<Status> guarded(const Work& work);
  void project_positions(const std::optional<ActiveSet>& active);
  void require_constraints(const ActiveSet& holding);
  std::optional<Status> go_on(double until);
  std::optional<Status> pass_end_of_segment();
  std::optional<Status> take_step();
  void begin_segment();
  double look_ahead() const;
  void switch_constraints();
  void keep(std::vector<Switch>& changes);
  void push_segment();
  void take_last();
  void tell(const SwitchSink& on_switch);
  void forget_before(double time);
  bool is_cancelled() const;
  bool accumulates();
  Status stopped(Stop why, const std::string& message) const { return {why, lead_.time, message}; }

  /// The last node.
  struct Lead {
    double time;  // t [s]
    Vector q;
    Vector v;
  };
  enum class Phase { to_begin, goes_on, changed, ended };  // changed: ended where a guard changed
  struct Counts {
    std::uint64_t switches = 0;         // so far
    std::uint64_t switches_before = 0;  // this call of advance()
    std::uint64_t steps_before = 0;
  };

  const Model* model_;
  Options options_;
  TimeDemand demand_;
  double now_;  // asked for [s]
  Lead lead_;
  Projection projection_;
  ActiveSetRules rules_;
  SegmentIntegrator integrator_;
  // The last step leads beyond the present: what it has seen there is nothing that has happened.
  std::optional<SegmentIntegrator::Memory> before_last_step_;
  std::vector<Segment> segments_;
  Phase phase_ = Phase::ended;  // of the last one
  double until_ = 0;            // t at which it ends by a schedule [s]
  bool is_disturbed_ = false;   // velocities may be off the constraints that hold
  Counts counts_;
  std::vector<MonitoredGuard> passed_;  // at the end of the last segment
  std::deque<Switch> untold_;
  std::deque<double> instants_;  // at which a guard changed, the last many [s]
};

}  // namespace hybrid_sphere::mechanics
