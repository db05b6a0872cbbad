#pragma once

#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "ground/edge_events.hpp"
#include "hybrid_sphere/simulation/simulation.hpp"
#include "interrupt/interrupt.hpp"
#include "simulation/arrival.hpp"
#include "simulation/hidden_excursion.hpp"
#include "simulation/hybrid_state.hpp"
#include "simulation/pending.hpp"
#include "simulation/repeated_ends.hpp"
#include "simulation/state_report.hpp"
#include "simulation/zeno_monitor.hpp"

namespace hybrid_sphere {

/// The event loop behind Simulation: segments follow one another, each until its next instant, at which the
/// rules of switching apply. Functions are documented in simulation.hpp.
class EventLoop {
 public:
  using SwitchSink = Simulation::SwitchSink;

  /// @param outlook  kept up to date; has to live as long as this
  EventLoop(const scene::Scene& scene, detail::Outlook& outlook);

  void advance_to(double time, const SwitchSink& on_switch);
  void set_interrupt(std::function<bool()> should_stop);
  void set_region_sink(Simulation::RegionSink on_region) { on_region_ = std::move(on_region); }
  /// Of a motion that is none of constant twist.
  const State& state();
  Status status() const;
  Vector3d reaction();
  std::uint64_t switches() const { return switches_; }
  const HybridState& hybrid() const { return hybrid_; }

  void set_initial_state(const scene::InitialState& initial_state);
  void set_state(const scene::InitialState& state);
  void reset() { set_initial_state(scene::InitialState(initial_state_)); }
  void set_ground(std::shared_ptr<const Ground> ground);
  void set_command(const scene::Wrench& command);
  void set_accuracy(double accuracy);
  void follow_orientation(bool follow) {
    hybrid_.segment.follow_orientation(follow);
    reset();
  }
  void kick(const Vector2d& impulse);

 private:
  /// Whether the path of the segment is known, and what remains to be done at this instant once it is.
  enum class Ahead : std::uint8_t {
    known,        ///< traced: nothing
    to_place,     ///< not traced: the ground into which the path leads acts
    to_throw,     ///< not traced: the ground into which the path leads acts, if it is another one
    to_slide,     ///< not traced: nothing remains, the sphere slides along an edge
    to_schedule,  ///< traced before; the switch is yet to be reported, and the next instant to be found
  };

  /// The instant reached last, as its switches have left it.
  struct Instant {
    EdgeContacts contacts;
    std::vector<RegionId> visited;  ///< grounds entered at it
    Arrival arrival{};
    Segment::Start before{};           ///< where the sphere continues freely: before an external impulse
    Vector2d kick = Vector2d::Zero();  ///< that impulse, by the mass [m/s]
    bool jumped = false;               ///< the last switch had an impulse
    bool stays = false;                ///< after it, on an edge: stay_on_edge()
    double drawn_in_at = -1;           ///< by end_hidden_throws() [s]
    std::optional<HiddenExcursion> excursion;  ///< that begins at it
    Ahead ahead = Ahead::known;
  };

  /// Forces of the scene, and the commanded wrench.
  struct Load {
    scene::Forces forces;
    scene::Wrench command;
    scene::Forces with(const scene::Wrench& wrench) const;
  };

  /// Where the computation has halted.
  struct Halt {
    std::optional<HaltedError> reason;
    HaltedError out_of_memory{Stop::out_of_memory, 0, "out of memory"};
    double interrupted_at = -1;  ///< last [s]
  };

  /// An exception of a caller's function, on its way through.
  struct CallerException {
    std::exception_ptr what;
  };

  // event_loop.cpp
  void pass_instants(double time, const SwitchSink& on_switch);
  void pass_instant(const SwitchSink& on_switch);
  void extend(double traced);
  void pass_crossing(double tau, const SwitchSink& on_switch);
  void check_doubt(const PointState& center);
  void pass_end(double tau, const SwitchSink& on_switch);
  void hold(Arrival& arrival);
  /// Ensures that the state at a time can be evaluated, or halts at the last time at which it can.
  void reach(double time) {
    if (should_stop_) ++instants_;
    const bool is_known = hybrid_.segment.uniform() && !is_question_due();
    if (!is_known && !report_.is_detached()) follow_to(time);
  }
  bool is_question_due() const { return instants_ >= detail::turns_between_questions; }
  void follow_to(double time);
  void schedule(double instant);
  void schedule_next();

  // interventions.cpp
  void check_method(const scene::Surface& surface, const scene::Wrench& command) const;
  void place_in(const scene::InitialState& state);
  void place(Cause cause);
  void restart();
  void apply_pending(const SwitchSink& on_switch);
  Arrival start() const;
  Arrival arrive_at_place();
  void go_on_kicked(Arrival& arrival, const Segment::Start& before, const SwitchSink& on_switch);
  void begin_free(const SplitTime& instant, Arrival& arrival, const Segment::Start& before);
  bool stays_on_edge(const Segment::Start& kicked) const;

  // switching.cpp
  Arrival arrive(double tau, const MotionState& now, const Vector2d& position, Cause cause) const;
  void enter_ground(RegionId region, const Arrival& arrival, const SwitchSink& on_switch);
  void switch_to(RegionId region, const SwitchSink& on_switch);
  ContactMode keep_on_line(ContactMode mode, const scene::Material& material, Segment::Start& state) const;
  void begin_segment(const SplitTime& epoch, ContactMode mode, const scene::Material& material,
                     const Segment::Start& start);
  void complete(Arrival& arrival);
  double rounded_way(const Arrival& arrival);
  template <class Call>
  static void tell(const Call& call);
  void commit_transition(RegionId region, const Constraint& constraint, const Arrival& arrival, Switch& event,
                         const SwitchSink& on_switch, RegionId partner = no_region);

  // look_ahead.cpp
  double first_horizon() const;
  double first_piece() const;
  void trace();
  RegionId region_ahead() const;
  bool rests_beside_edge();
  bool may_stay_on_edge() const {
    const Vector2d& velocity = instant_.arrival.state.twist.velocity;
    return !instant_.stays && !instant_.contacts.are_crossed(velocity, hybrid_.rounding_of_speeds());
  }
  bool stay_on_edge(RegionId next);
  void trace_ahead(const SwitchSink& on_switch);
  void hold_before_kick();
  bool begin_hidden_excursion(RegionId next);
  Segment::Start end_of_excursion(double tau);
  void pass_excursion(const SwitchSink& on_switch);
  void note_rebound();

  // livelock.cpp
  void resolve_livelock(RegionId again, const SwitchSink& on_switch);
  bool end_hidden_throws(const SwitchSink& on_switch);
  double speed_of_hidden_throws(const SharedEdge& edge) const;
  void go_on_from_edge(RegionId region, const Segment::Start& state, const SwitchSink& on_switch);
  bool slide_along_edge(const SharedEdge& edge, Arrival& arrival, const SwitchSink& on_switch);
  void pass_limit(const SwitchSink& on_switch);
  void pass_corner(Arrival& arrival, const SwitchSink& on_switch);

  // halt.cpp
  void give_up(const char* reason);
  [[noreturn]] void halt_in_livelock();
  [[noreturn]] void halt_in_accumulation();
  [[noreturn]] void halt(Stop stop, const std::string& reason);
  [[noreturn]] void halt_without_memory();
  [[noreturn]] void stop(const HaltedError& reason);

  detail::Outlook& outlook_;
  HybridState hybrid_;
  scene::InitialState initial_state_;
  Load load_;
  Pending pending_;
  EdgeEvents edge_events_;
  SplitTime next_;  // when something may change next
  ZenoMonitor zeno_;
  RepeatedEnds repeated_ends_;
  Instant instant_;
  StateReport report_;
  std::uint64_t switches_ = 0;
  Halt halt_;
  std::function<bool()> should_stop_;
  Simulation::RegionSink on_region_;
  std::uint32_t instants_ = 0;  // since a question whether to stop
};

}  // namespace hybrid_sphere
