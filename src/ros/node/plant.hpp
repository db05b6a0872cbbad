#pragma once

#include <chrono>
#include <functional>
#include <optional>
#include <string>

#include "hybrid_sphere/simulation/simulation.hpp"
#include "ros/node/command.hpp"
#include "ros/node/computation.hpp"
#include "ros/node/drop_log.hpp"
#include "ros/node/switch_queue.hpp"
#include "simulation/error_estimate.hpp"

namespace hybrid_sphere::ros_interface {

/// The simulation as it is driven from outside: by ticks, by wrenches that are commanded, by new maps and new
/// initial states. All functions return soon: what takes longer than a moment is under way in a thread of its
/// own, and the last state is shown meanwhile. Where the computation cannot go on, whatever it throws, or a
/// number is not finite, it halts: the last state is held until it is told how to go on. Whoever tells it
/// something interrupts what is under way; the next advance_to goes on with it.
class Plant {
 public:
  using Wall = Computation::Wall;

  /// @param command_timeout  after which a commanded wrench is dropped [s]; 0: never
  /// @param sink             called for every switch, in the thread that calls the functions here
  /// @param ended            called in another thread when what was under way has ended
  Plant(const scene::Scene& scene, double command_timeout, Simulation::SwitchSink sink,
        std::function<void()> ended);

  /// Goes on to a time since the initial state [s]; where it has halted nothing happens.
  /// @return false: that is under way, or something else is
  bool advance_to(double time);
  /// A constraint that came with a new map or a new state is applied now, not at the next tick.
  void let_ground_act() { advance_to(time()); }

  bool under_way() const { return computation_.under_way(); }
  /// Reports the switches of what is under way.
  /// @return whether nothing is under way any more
  bool collect();
  /// Interrupts what is under way: the sphere stands at the last time that is certain.
  void stand();

  /// Since when it computes towards which time.
  struct Pursuit {
    Wall::time_point since;
    double to;  ///< since the initial state [s]
  };
  /// While something is under way, and until the next advance_to.
  const std::optional<Pursuit>& pursuit() const { return pursuit_; }

  bool halted() const { return !halt_.empty(); }
  /// Why, and when; empty while it runs.
  const std::string& halt() const { return halt_; }
  /// Halts for a reason that is none of the simulation's: what has been thrown, and where.
  void fail(const std::string& reason);

  /// At the time reached, while something is under way an earlier one, every number finite; null where they
  /// have not been so.
  const State* state();
  /// Of the state that is known [s].
  double time() const { return under_way() ? figures_.time : simulation_.time(); }
  Vector3d reaction();
  std::uint64_t switches() const { return under_way() ? figures_.switches : simulation_.switches(); }
  std::uint64_t evaluations() const { return under_way() ? figures_.evaluations : simulation_.evaluations(); }
  const Sphere& sphere() const { return simulation_.sphere(); }
  std::shared_ptr<const Ground> ground() const { return simulation_.ground(); }
  const scene::Solver& solver() const { return solver_; }

  /// Of the outputs since the initial state, relative to the scale of motion.
  double estimated_error();

  /// @param now  when it came
  void take_command(const scene::Wrench& wrench, Command::Wall::time_point now) {
    command_.take(wrench, now);
  }
  /// The wrench in force acts from the time reached on; one that the method cannot follow is dropped.
  void apply_command(Command::Wall::time_point now);
  DropLog& command_drops() { return command_drops_; }

  void set_accuracy(double accuracy);

  /// An impulse on the centre at the time reached; let_ground_act() has it answered. Must not have halted.
  /// @param change  impulse over the mass, up to 1e15 [m/s]
  void kick(const Vector2d& change);

  /// Exchanges the ground under the sphere; drops a command with which the method cannot go on there.
  /// @param estimate  of the same ground
  void set_ground(const std::shared_ptr<const Ground>& ground, const ErrorEstimate& estimate);
  void set_initial_state(const scene::InitialState& state);
  /// The same, but time and index of switches go on, and the command stays in force.
  void set_state(const scene::InitialState& state);
  void reset();

 private:
  /// What is shown of the simulation while another thread has it.
  struct Figures {
    double time = 0;
    std::uint64_t switches = 0;
    std::uint64_t evaluations = 0;
    double estimated_error = 0;
    Vector3d reaction = Vector3d::Zero();
  };

  template <class Function>
  void guarded(const Function& function);
  void go_on_beside(double time);
  void show(const State& state);
  void halt_at(double time, const std::string& reason, const char* held);
  void restart();

  Simulation simulation_;
  Simulation::SwitchSink sink_;
  std::function<void()> ended_;
  scene::Solver solver_;
  ErrorEstimate estimate_;
  Command command_;
  DropLog command_drops_{"cmd_wrench"};
  std::string halt_;
  double fastest_spin_ = 0;  // that has been looked at since the initial state [rad/s]
  State shown_;              // the last one that was asked for and known
  std::string shown_region_;
  bool is_shown_ = false;
  Figures figures_;
  std::optional<Pursuit> pursuit_;
  SwitchQueue beside_;       // switches of the other thread
  Computation computation_;  // last: what is under way uses the others
};

}  // namespace hybrid_sphere::ros_interface
