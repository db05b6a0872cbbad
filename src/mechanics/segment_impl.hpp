#pragma once

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <functional>
#include <map>
#include <optional>
#include <vector>

#include "mechanics/guard_search.hpp"
#include "mechanics/motion_scale.hpp"
#include "mechanics/motion_step.hpp"
#include "mechanics/segment.hpp"

namespace hybrid_sphere::mechanics {

/// The implementation of SegmentIntegrator: segment_integrator.cpp takes the steps, segment_tolerances.cpp
/// sets their tolerances, segment_events.cpp checks guards and constraints within a step,
/// segment_method.cpp chooses the method, segment_errors.cpp adds up the errors.
struct SegmentIntegrator::Impl {
  Impl(const Model& model_, const StepDemand& demand_, const Vector& q_)
      : model(model_),
        demand(demand_),
        motion(model_),
        scale(model_, q_),
        motion_step(motion),
        state_size(model_.equations->coordinates() + model_.equations->velocities()),
        node_rate(Vector::Zero(state_size)),
        noise(node_rate),
        projection_noise(node_rate),
        errors{ErrorSum(state_size)},
        q(q_),
        v(model_.equations->velocities()) {}

  /// Guards of positions come first, and are integrated beside the motion.
  Index positions() const {
    const auto is_position = [](const MonitoredGuard& g) { return g.kind == MonitoredGuard::Kind::position; };
    return std::count_if(guards.begin(), guards.end(), is_position);
  }
  /// Reactions, limits and slips come after them; their integrals go along, too.
  Index reactions() const {
    const auto is_event = [](const MonitoredGuard& g) { return g.kind == MonitoredGuard::Kind::event; };
    return static_cast<Index>(guards.size()) - positions() -
           std::count_if(guards.begin(), guards.end(), is_event);
  }
  Index monitored() const { return positions() + reactions(); }
  bool is_gap(Index i) const {
    return model.constraints[guards[static_cast<std::size_t>(i)].constraint].unilateral.has_value();
  }
  const Guard& guard(Index i) const { return guard_of(guards[static_cast<std::size_t>(i)]); }
  const Guard& guard_of(const MonitoredGuard& monitored) const {
    return *model.constraints[monitored.constraint].schedule.guard;
  }

  bool advance();
  void evaluate_at(const Node& node);
  void set_tolerances(const Node& node);
  void set_tolerances_of_state(const Node& node);
  void allow_rounding_of_forces();
  void allow_errors_that_are_forgotten();
  void set_rate_sizes();
  void set_tolerances_of_positions(const Node& node);
  void set_tolerances_of_reactions();
  void expect_speed(const Node& from, const Node& to, double h);
  void allow_rounding_of_coordinates(const Node& node);
  double first_step() const;
  Node attempt();
  double error_of_step();
  double error_of_directions();
  bool is_jump_at_resolution(double h) const;
  double projection_of_step() const;
  bool is_roundoff_of_coordinates_negligible(const Node& node);
  bool see_roundoff_of_coordinates(const Node& node);
  void begin_passage(double to);
  void choose_next_step(double h, double error);
  void begin_explicitly();
  void see_stability(double h);
  void choose_method();
  void take_up_implicit();
  void set_implicit(std::shared_ptr<const ImplicitStart> start);
  bool renew_implicit();
  void leave_implicit(double h);
  double longest_by_slips(double h, double SlidingFriction::Speed::*where) const;
  bool is_too_long_for_slips(double h);
  void add_errors_of_step(const Node& end);
  void add_errors_of_switch(const Node& before);
  void pass_time(double h);
  void require_agreement() const;
  void require_small_turns() const;
  /// @param attempted  length of the step @param passed  up to the first change in it
  void require_progress(double attempted, double passed);
  bool is_at_rest() const;
  void require_directions(const Node& from);
  Vector sizes_at(const Node& node);
  bool changed(const MonitoredGuard& monitored, const Node& node);
  double place_before_change(const std::function<double(double)>& value,
                             const std::function<double(double)>& interpolated_value,
                             const MonitoredGuard& monitored, double low, double high);
  /// Where a function changes its sign, with its values there.
  struct Change {
    double low, high;
    double at_low, at_high;
  };
  void narrow(const std::function<double(double)>& value,
              const std::function<double(double)>& interpolated_value, Change& change);
  double instant_of_change(const MonitoredGuard& monitored, const Node& from, double low, const Node& there);
  std::vector<double> places_to_check(const Node& from, const Node& reached);
  double value_of(const MonitoredGuard& monitored, double x, const Vector& state);
  double slip_that_ends(const MonitoredGuard& monitored) const;
  double slowest_slip(std::size_t friction) const;
  double smooth_value(const MonitoredGuard& monitored) const;
  double size_of(const MonitoredGuard& monitored) const;
  double size_of_terms(const MonitoredGuard& monitored) const;
  GuardSample sample_guard(const MonitoredGuard& monitored, double x, const Vector& state,
                           double most_roundoff);
  double rounding_at(const MonitoredGuard& monitored, double x, const Vector& state) const;
  GuardSample sample_event(const MonitoredGuard& monitored, double x, const Vector& state, double h);
  GuardSample sample_reaction(std::size_t guard, double x, double low, double high);
  /// The value of a reaction, limit or slip on the interpolant of the last step.
  struct ReactionValue {
    double value = 0;
    double roundoff = 0;
    bool is_roundoff() const { return std::abs(value) <= roundoff; }
  };
  const std::vector<ReactionValue>& reactions_at(double x);
  void evaluate_stage(double t, const Vector& state);
  void add_simultaneous(const Node& change, const Node& there);
  std::optional<Node> first_change(const Node& from, const Node& reached);

  /// The method of the steps from the last node.
  struct Method {
    std::shared_ptr<const ImplicitStart> start;  // of implicit steps; null: explicit
    double linearized = 0;                       // x at which that was found
    double explicit_step = 0;                    // step when the implicit method took over
    bool is_damped = false;                      // whether a fast damper acts
    int held = 0;                                // explicit steps in a row that a fast damper has kept short
  };

  const Model& model;
  StepDemand demand;
  ConstrainedMotion motion;
  MotionScale scale;
  MotionStep motion_step;
  Index state_size;         // N + n
  Vector allowed;           // errors of q, v and the guards in a step
  Vector node_rate;         // of q and v at the last node
  Vector noise;             // of q and v, in a step, by the round-off of large coordinates
  Vector projection_noise;  // of q and v, in their projection
  std::vector<Index> large_coordinates;
  Vector projection_roundoff;  // what the projection does to q and v for the round-off of large coordinates
  Vector guard_sizes;          // largest value, or change in a step, of each monitored guard
  Vector difference;           // of the last step to that of the embedded method
  /// Of the motion so far.
  struct Errors {
    ErrorSum sum;
    double gain = 0;            // error of the last step as part of that of the embedded method
    double force_roundoff = 0;  // of it, relative to the scale of motion
  };
  Errors errors;
  Segment* segment = nullptr;
  Node latest;                  // reached
  std::optional<Node> reached;  // by a step in which guards have not been looked for to the end
  std::vector<MonitoredGuard> guards;
  std::vector<MonitoredGuard> passed;  // in the last step
  double end = 0;
  Method method;
  Redundancy redundancy;
  double step = 0;         // length that the accuracy allows the next step; 0: none yet in this motion
  double passage_end = 0;  // x of the end of the last step that was too long
  Vector passage_allowed;  // what was allowed to it
  double refusals = 0;     // of steps that the projection moves too far, less those that are forgotten
  int steps_without_progress = 0;
  int short_steps = 0;  // in a row
  Vector q;
  Vector v;
  Vector q_rate;
  Vector rate_sizes;  // of the numbers from which q' is computed (N)
  Vector interpolated;
  Matrix gradient;                                               // C at the last node
  Matrix gradient_before;                                        // and at the one before
  std::map<double, std::vector<ReactionValue>> reaction_values;  // of all guards, by x within the last step
  /// The last state at which evaluate_stage() evaluated the motion.
  struct Evaluated {
    double t = 0;
    Vector state;
    std::uint64_t evaluations = 0;  // of the motion, up to then; 0: none
  };
  Evaluated evaluated;
  std::uint64_t steps = 0;  // taken
};

}  // namespace hybrid_sphere::mechanics
