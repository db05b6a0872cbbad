#pragma once

#include <algorithm>
#include <cfloat>
#include <exception>
#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "hybrid_sphere/ground/edge_events.hpp"
#include "hybrid_sphere/interrupt/interrupt.hpp"
#include "hybrid_sphere/simulation/records.hpp"
#include "hybrid_sphere/simulation/segment.hpp"
#include "hybrid_sphere/simulation/switching_rules.hpp"
#include "hybrid_sphere/simulation/zeno_detector.hpp"
#include "hybrid_sphere/sphere/sphere.hpp"

namespace hybrid_sphere {

/// The computation cannot go on: what() says why and where, time() when.
class HaltedError : public std::runtime_error {
 public:
  HaltedError(double time, const std::string& reason) : std::runtime_error(reason), time_(time) {}
  /// For the reason of another one; takes no memory.
  HaltedError(double time, const HaltedError& other) : std::runtime_error(other), time_(time) {}
  double time() const { return time_; }

 private:
  double time_;
};

/// The three stages of the sphere, event-driven: the one place where stages switch.
///
/// Between two switches the motion is a function of the time since the last one (Segment), so that the
/// trajectory does not depend on when, or how often, it is looked at. Rules of switching: docs/theory.md 5.2.
class Simulation {
 public:
  /// The latest time that can be asked for [s]: speeds up to 1e15 m/s and the forces that a scene allows give
  /// places and angles that are numbers until then.
  static constexpr double max_time = hybrid_sphere::max_time;

  /// Called for every switch, in order, during advance_to.
  using SwitchSink = std::function<void(const Switch&)>;

  /// The sphere stands at its initial state at time 0; the ground under it acts in the first advance_to.
  /// @throws std::invalid_argument  if the method exact is asked for, but some ground leaves a motion no
  /// closed form
  explicit Simulation(const scene::Scene& scene);

  Simulation(const Simulation&) = delete;
  Simulation& operator=(const Simulation&) = delete;

  /// Goes on to a time, reporting each switch up to and including that time.
  /// @param time  since the initial state [s], from time() to max_time
  /// @throws std::invalid_argument  for any other time; nothing has changed then
  /// @throws HaltedError            where the computation cannot go on, whatever was thrown below: the sphere
  ///                                stands at that instant, in the state after the last switch reported or
  ///                                later. What on_switch throws comes out as it is; the next call goes on
  ///                                after that switch.
  /// @throws Interrupted            where set_interrupt's function says so: the sphere stands at time(), the
  ///                                last time up to which all is known, after every switch that was reported.
  ///                                Everything may be asked and done there; the next call goes on with what
  ///                                has been computed, and the trajectory is the same to the bit.
  void advance_to(double time, const SwitchSink& on_switch) {
    if (time >= now_ && time < certain_until_) {
      now_ = time;
    } else {
      advance_over_instants(time, on_switch);
    }
  }

  /// From now on a computation that takes long asks this function, about every millisecond and in the thread
  /// that computes, whether it should stop: advance_to throws Interrupted then. Nothing else asks, and what
  /// has a closed form near by is told without being asked. What is kept are steps and pieces of the path
  /// that are complete: one who is always told to stop within a piece (half a second for 20,000 edges on one
  /// line) gets no further. An empty function: never.
  void set_interrupt(std::function<bool()> should_stop);

  /// Time reached [s].
  double time() const { return now_; }

  /// State at time(); at the instant of a switch the one after it. Valid until the next call. Throws nothing:
  /// after a halt it is the state in which the sphere stands, which agrees with the last switch reported.
  const State& state() {
    if (state_is_held_) return state_;
    if (!segment_.uniform()) return state_of_motion();
    const double tau = std::max(0.0, epoch_.until(now_));
    state_.time = now_;
    state_.position = segment_.uniform_motion().position(tau);
    state_.orientation = segment_.uniform_motion().orientation(tau);
    return state_;
  }

  /// Force of the ground on the sphere at time(): lambda_1, lambda_2 and the normal force [N]. Throws
  /// nothing.
  Vector3d reaction();

  /// Number of switches since the initial state.
  std::uint64_t switches() const { return switches_; }

  /// Right-hand sides evaluated since the beginning; 0 where every motion had a closed form.
  std::uint64_t evaluations() const { return segment_.evaluations(); }

  /// Puts the sphere somewhere: time and switches start again at 0; what the ground there imposes, it imposes
  /// suddenly.
  /// @throws std::invalid_argument  beyond what a scene can have (1e15 m, m/s, rad/s in each component), or
  ///                                where the orientation is 0 or not finite; nothing has changed then
  void set_initial_state(const scene::InitialState& initial_state);

  /// Back to the last initial state.
  void reset() { set_initial_state(scene::InitialState(initial_state_)); }

  /// Exchanges the ground under the moving sphere, from time() on. A constraint that comes with it is
  /// suddenly applied. The second form takes a ground that was prepared elsewhere.
  /// @throws std::invalid_argument  as the constructor does; nothing has changed then
  /// @throws std::bad_alloc         nothing has changed then
  void set_surface(const scene::Surface& surface) { set_ground(std::make_shared<const Ground>(surface)); }
  void set_ground(std::shared_ptr<const Ground> ground);

  /// A wrench on the sphere beside that of the scene, from time() on until the next one.
  /// @throws std::invalid_argument  as the constructor does, and for components above those of a scene's
  ///                                wrench (1e15 m, 1e15 m k^2); nothing has changed then
  void set_command(const scene::Wrench& command);

  /// Another accuracy: from time() on for a motion that is integrated, which begins a new segment there; else
  /// from the next segment on, so that a closed form stays the same.
  /// @param accuracy  from 1e-14 to 1
  /// @throws std::invalid_argument  for any other; nothing has changed then
  void set_accuracy(double accuracy);

  /// An impulse on the centre at time(), from outside; several at one time add up. What the ground imposes on
  /// the velocities after it, it imposes suddenly, in the next advance_to: a sphere that rolls goes on
  /// rolling, its velocity changed by impulse R^2/(m (R^2+k^2)); with coulomb friction, whose impulse in no
  /// time is 0, it slips. Source: docs/theory.md 5.2, rule 9.
  /// @param impulse  J [N s]; J/m up to 1e15 m/s
  /// @throws std::invalid_argument  for any other impulse; nothing has changed then
  /// @throws HaltedError            where the computation has halted; nothing has changed then
  void kick(const Vector2d& impulse);

  /// Estimated error that the steps of a method have made: of the motions that were integrated, relative to
  /// the scale of motion, and of the orientation, relative to the angle turned; since the initial state. Not
  /// that of rounding.
  double estimated_error() const { return segment_.estimated_error(); }

  const scene::Surface& surface() const { return ground_->surface(); }
  std::shared_ptr<const Ground> ground() const { return ground_; }
  const Sphere& sphere() const { return sphere_; }

 private:
  /// What is known of the path of the segment, and what remains to be done at this instant once it is.
  enum class Ahead : std::uint8_t {
    known,        ///< traced: nothing
    to_place,     ///< not traced: the ground into which the path leads acts
    to_throw,     ///< not traced: the ground into which the path leads acts, if it is another one
    to_slide,     ///< not traced: nothing, the sphere slides along an edge
    to_schedule,  ///< traced before; the switch is yet to be reported, and the next instant to be found
  };

  /// A ground with which the sphere rolled for no time, as its impulse threw it back.
  struct Thrown {
    RegionId from;
    Vector2d velocity;      ///< after the impulse [m/s]
    Vector2d acceleration;  ///< with which it would roll there [m/s^2]
  };

  /// An edge between two grounds, with one of them on each side.
  struct SharedEdge {
    Contact piece;
    RegionId first;
    RegionId second;
    Vector2d normal;  ///< of length 1, into the first
  };

  /// The last instant of an accumulation, and what the sphere does from then on.
  struct Limit {
    SplitTime time;
    Vector2d position;  ///< of a corner [m]
    RegionId ground;    ///< on which it goes on or, with another one, along whose edge
    RegionId other = no_region;
    Contact edge{no_region, {}};         ///< where one ground has thrown it back
    Vector2d normal = Vector2d::Zero();  ///< of that edge there, into the ground, of length 1
  };

  /// What a function of the caller has thrown, on its way through.
  struct Foreign {
    std::exception_ptr what;
  };

  void advance_over_instants(double time, const SwitchSink& on_switch);
  void pass_instants(double time, const SwitchSink& on_switch);
  void check_method(const scene::Surface& surface, const scene::Wrench& command) const;
  void reserve_contacts(const Ground& ground);
  void pass_many_instants();
  void monitor_zeno();
  bool is_deep_in_cusp() const;
  bool throws_meet_in_corner() const;
  double unseen_excursion(const ZenoDetector::Arrival& arrival);
  void find_limit(const ZenoDetector::Cycle& cycle);
  bool ends_throws(const Vector2d& position);
  bool leaves_edge_before_limit(const Contact& contact, const Vector2d& position);
  double last_throw(const Contact& contact, const Vector2d& normal, double guess);
  void find_limit_on_edge(const Contact& contact, const Vector2d& position);
  void find_limit_in_corner(const ZenoDetector::Cycle& cycle);
  void pass_limit(const SwitchSink& on_switch);
  void pass_corner(Arrival& arrival, const SwitchSink& on_switch);
  void add_corner(RegionId region, const Vector2d& corner);
  std::optional<SharedEdge> edge_ahead(RegionId first, RegionId second, const Segment::Start& state) const;
  /// What is computed from speeds so far may be off by that, at most [m/s].
  double rounding_of_speeds() const { return 32 * DBL_EPSILON * fastest_; }
  SwitchingRules rules() const { return {sphere_, segment_.dynamics(), rounding_of_speeds()}; }
  void reach(double time);
  void schedule(double instant);
  void place(Cause cause);
  void restart();
  void apply_pending(const SwitchSink& on_switch);
  RegionId region_ahead() const;
  void trace_ahead(const SwitchSink& on_switch);
  void strike(Arrival& arrival);
  void go_on_kicked(Arrival& arrival, const Segment::Start& before, const SwitchSink& on_switch);
  void begin_free(const SplitTime& instant, Arrival& arrival, const Segment::Start& before);
  bool stays_on_edge(const Segment::Start& kicked) const;
  void pass_instant(const SwitchSink& on_switch);
  void extend(double traced);
  void pass_crossing(double tau, const SwitchSink& on_switch);
  void check_doubt(const PointState& center);
  void pass_end(double tau, const SwitchSink& on_switch);
  void schedule_next();
  void update_state(double tau);
  const State& state_of_motion();
  void note_velocities(const MotionState& now);
  void describe(ContactMode mode, const Twist& twist, const Vector2d& contact_velocity, bool at_rest,
                const Vector2d& position);
  Vector3d reaction_of(const PointState& center) const;
  void hold_state();
  void detach(const Segment::Start& start);
  void name_ground();
  void give_up(const char* reason);

  Arrival start() const;
  Arrival arrive_at_place();
  Arrival arrive(double tau, const MotionState& now, const Vector2d& position, Cause cause) const;
  void enter_ground(RegionId region, const Arrival& arrival, const SwitchSink& on_switch);
  void switch_to(RegionId region, const SwitchSink& on_switch);
  bool has_ended_here(double tau);
  void hold(Arrival& arrival);
  double first_horizon() const;
  double first_piece() const;
  void begin_segment(const SplitTime& epoch, ContactMode mode, const scene::Material& material,
                     const Segment::Start& start);
  void trace();
  void complete(Arrival& arrival);
  double rounded_way(const Arrival& arrival);
  void meet_corners(Arrival& arrival);
  void commit_transition(RegionId region, const Constraint& constraint, const Arrival& arrival, Switch& event,
                         const SwitchSink& on_switch, RegionId partner = no_region);

  void resolve_livelock(RegionId again, const SwitchSink& on_switch);
  bool slide_along_edge(const SharedEdge& edge, Arrival& arrival, const SwitchSink& on_switch);
  void follow(const SharedEdge& edge);
  bool strikes(RegionId region) const;
  bool is_ground(RegionId region, const scene::Material& material) const;
  bool is_in_corner() const;
  void add_contacts(RegionId region, const Vector2d& position);
  std::optional<SharedEdge> edge_between(RegionId first, RegionId second) const;
  [[noreturn]] void halt_in_livelock();
  [[noreturn]] void halt_in_accumulation();
  [[noreturn]] void halt(const std::string& reason);
  [[noreturn]] void halt_without_memory();
  [[noreturn]] void stop(const HaltedError& reason);

  Sphere sphere_;
  scene::InitialState initial_state_;
  scene::Forces forces_;
  scene::Wrench command_;
  bool new_forces_ = false;           // they act from next_instant_ on, and so does another accuracy
  Vector2d kick_ = Vector2d::Zero();  // change of the velocity that is still to come [m/s]
  std::shared_ptr<const Ground> ground_;
  std::shared_ptr<const Ground> named_by_;  // keeps the name in state_.region
  EdgeEvents edge_events_;

  double now_ = 0;
  double next_instant_ = 0;    // when something may change next
  double next_remainder_ = 0;  // what its time in the segment leaves out
  double certain_until_ = 0;   // before, nothing changes and the state is known
  SlowZenoDetector slow_zeno_;
  StandstillDetector standstill_;
  ZenoDetector zeno_;
  bool comes_ = false;            // at the instant that is being passed, to an edge: zeno_.next()
  bool jumped_ = false;           // the last switch had an impulse
  std::optional<Thrown> thrown_;  // back, at the instant that was passed last
  std::optional<Limit> limit_;    // of an accumulation, still to come: nothing else counts until then
  double limit_passed_at_ = -1;   // time of the last one [s]
  bool on_ground_ = false;        // false: the ground under the sphere has yet to act
  std::uint64_t switches_ = 0;
  std::optional<HaltedError> halted_;
  HaltedError out_of_memory_{0, "there is no memory left"};
  bool state_is_held_ = false;  // state_ and reaction_ are those at now_
  bool detached_ = false;       // and the segment is none
  std::function<bool()> should_stop_;

  SplitTime epoch_;  // beginning of the segment
  Segment segment_;  // since then
  Vector2d sigma_ =
      Vector2d::Zero();  // of a uniform segment: exactly that of the ground where it holds the sphere
  double fastest_ = 0;   // speed of the centre or of the contact with which a segment began [m/s]
  Constraint constraint_;
  ContactMode mode_ = ContactMode::free;  // that of the last switch, or of the ground entered without one
  RegionId region_ = no_region;
  RegionId partner_ = no_region;   // the other ground of an edge slide
  SharedEdge slid_along_{};        // that edge
  Cause placing_ = Cause::placed;  // why the ground has yet to act
  Contacts contacts_;              // edges on which the sphere is where something changes
  std::vector<RegionId> visited_;  // at one instant
  Arrival arrival_{};              // at the instant come to last, as the switches there have left it
  Segment::Start before_{};        // where it goes on freely: before an impulse from outside
  Ahead ahead_ = Ahead::known;
  unsigned ended_at_once_ = 0;  // modes that have ended at one instant, where none has lasted
  double ended_at_ = 0;         // that instant [s]
  State state_;                 // what is constant over a uniform segment is always up to date
  Vector3d reaction_ = Vector3d::Zero();
};

}  // namespace hybrid_sphere
