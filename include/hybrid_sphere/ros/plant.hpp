#pragma once

#include <string>

#include "hybrid_sphere/ros/command.hpp"
#include "hybrid_sphere/ros/drop_log.hpp"
#include "hybrid_sphere/simulation/error_estimate.hpp"
#include "hybrid_sphere/simulation/simulation.hpp"

namespace hybrid_sphere::ros_interface {

/// The simulation as it is driven from outside: by ticks, by wrenches that are commanded, by new maps and new
/// initial states. Where the computation cannot go on, or a number is not finite, it halts: the last state is
/// held until it is told how to go on.
class Plant {
 public:
  /// @param command_timeout  after which a commanded wrench is dropped [s]; 0: never
  /// @param sink             called for every switch
  Plant(const scene::Scene& scene, double command_timeout, Simulation::SwitchSink sink);

  /// Goes on to a time since the initial state [s]; where it has halted nothing happens.
  void advance_to(double time);
  /// A constraint that came with a new map or a new state is applied now, not at the next tick.
  void let_ground_act() { advance_to(simulation_.time()); }

  bool halted() const { return !halt_.empty(); }
  /// Why, and when; empty while it runs.
  const std::string& halt() const { return halt_; }

  /// At the time reached, every number finite; null where they have not been so, never before.
  const State* state();
  double time() const { return simulation_.time(); }
  Vector3d reaction() { return simulation_.reaction(); }
  std::uint64_t switches() const { return simulation_.switches(); }
  std::uint64_t evaluations() const { return simulation_.evaluations(); }
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
  /// @param change  impulse over the mass, up to 1e100 [m/s]
  void kick(const Vector2d& change) { simulation_.kick(sphere().mass() * change); }

  /// Exchanges the ground under the sphere; drops a command with which the method cannot go on there.
  /// @param estimate  of the same ground
  void set_ground(const std::shared_ptr<const Ground>& ground, const ErrorEstimate& estimate);
  void set_initial_state(const scene::InitialState& state);
  void reset();

 private:
  void restart();

  Simulation simulation_;
  Simulation::SwitchSink sink_;
  scene::Solver solver_;
  ErrorEstimate estimate_;
  Command command_;
  DropLog command_drops_{"cmd_wrench"};
  std::string halt_;
  double fastest_spin_ = 0;  // that has been looked at since the initial state [rad/s]
};

}  // namespace hybrid_sphere::ros_interface
