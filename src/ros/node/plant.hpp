#pragma once

#include <functional>
#include <memory>
#include <string>

#include "hybrid_sphere/simulation/simulation.hpp"
#include "ros/node/command.hpp"
#include "ros/node/driven_plant.hpp"
#include "ros/node/drop_log.hpp"
#include "ros/node/switch_queue.hpp"
#include "simulation/error_estimate.hpp"

namespace hybrid_sphere::ros_interface {

/// The simulation as it is driven from outside: by ticks, by wrenches that are commanded, by new maps and new
/// initial states.
class Plant final : public DrivenPlant {
 public:
  /// @param command_timeout  after which a commanded wrench is dropped [s]; 0: never
  /// @param sink             called for every switch, in the thread that calls the functions here
  /// @param ended            called in another thread when what was under way has ended
  Plant(const scene::Scene& scene, double command_timeout, Simulation::SwitchSink sink,
        std::function<void()> ended);
  ~Plant() override { stop_computing(); }

  /// At the time reached, while something is under way an earlier one, every number finite; null where they
  /// have not been so.
  const State* state();
  double time() const override { return under_way() ? figures_.time : simulation_.time(); }
  Vector3d reaction();
  std::uint64_t switches() const override { return under_way() ? figures_.switches : simulation_.switches(); }
  std::uint64_t evaluations() const override {
    return under_way() ? figures_.evaluations : simulation_.evaluations();
  }
  const Sphere& sphere() const { return simulation_.sphere(); }
  std::shared_ptr<const Ground> ground() const { return simulation_.ground(); }
  std::string method() const override { return scene::to_string(solver_.method); }
  double accuracy() const override { return solver_.accuracy; }
  std::string motion() override;
  double estimated_error() override;

  void take_command(const scene::Wrench& wrench) { command_.take(wrench); }
  /// The wrench in force acts from the time reached on; one that is too old, or that the method cannot
  /// follow, is dropped.
  /// @param clock  reading of the clock by which it ages [s]
  void apply_command(double clock);
  DropLog& command_drops() { return command_drops_; }
  std::uint64_t dropped_inputs() const override { return command_drops_.count(); }

  void set_accuracy(double accuracy);

  /// An impulse on the centre at the time reached; act_now() has it answered. Must not have halted.
  /// @param change  impulse over the mass, up to 1e15 [m/s]
  void kick(const Vector2d& change);

  /// Exchanges the ground under the sphere; drops a command with which the method cannot go on there.
  /// @param estimate  of the same ground
  void set_ground(const std::shared_ptr<const Ground>& ground, const ErrorEstimate& estimate);
  void set_initial_state(const scene::InitialState& state);
  /// The same, but time and index of switches go on, and the command stays in force.
  void set_state(const scene::InitialState& state);
  void reset() override;

 private:
  /// What is shown of the simulation while another thread has it.
  struct Figures {
    double time = 0;
    std::uint64_t switches = 0;
    std::uint64_t evaluations = 0;
    double estimated_error = 0;
    Vector3d reaction = Vector3d::Zero();
  };
  /// With the names of the regions, which are valid only during the call that reports a switch.
  struct KeptSwitch {
    Switch event;
    std::string from;
    std::string to;
  };

  Failure failure_of(const std::exception& error) const override;
  void compute(double time) override { simulation_.advance_to(time, sink_); }
  void compute_beside(double time) override;
  void report_kept() override;
  void keep_present() override;
  void show(const State& state);
  void restart();

  Simulation simulation_;
  Simulation::SwitchSink sink_;
  scene::Solver solver_;
  ErrorEstimate estimate_;
  Command command_;
  DropLog command_drops_{"cmd_wrench"};
  double fastest_spin_ = 0;  // that has been looked at since the initial state [rad/s]
  State shown_;              // the last one that was asked for and known
  std::string shown_region_;
  bool is_shown_ = false;
  Figures figures_;
  SwitchQueue<KeptSwitch> beside_;  // switches of the other thread
};

}  // namespace hybrid_sphere::ros_interface
