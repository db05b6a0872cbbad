#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "hybrid_sphere/mechanics/plant.hpp"
#include "hybrid_sphere/ros/system_plugin.hpp"
#include "ros/node/age_limit.hpp"
#include "ros/node/driven_plant.hpp"
#include "ros/node/drop_log.hpp"
#include "ros/node/switch_queue.hpp"

namespace hybrid_sphere::ros_interface {

/// Any Lagrangian system as it is driven from outside: by ticks and by its input.
class SystemPlant final : public DrivenPlant {
 public:
  /// @param accuracy  mechanics::Options::accuracy
  /// @param duration  over which errors may add up to that, > 0 [s]
  /// @param timeout   after which an input gives way to the initial one [s]; 0: never
  /// @param sink      called for every switch, in the thread that calls the functions here
  /// @param ended     called in another thread when what was under way has ended
  /// @throws std::invalid_argument  for a system that the engine refuses
  SystemPlant(std::shared_ptr<const SystemPlugin> system, double accuracy, double duration, double timeout,
              mechanics::SwitchSink sink, std::function<void()> ended);
  ~SystemPlant() override { stop_computing(); }

  /// At the time reached, while something is under way an earlier one, every number finite; null where they
  /// have not been so.
  const mechanics::State* state();
  /// Names and sizes, which no input changes.
  const mechanics::Model& model() const { return names_; }
  /// t of the initial state [s]: times of the functions here count from it.
  double begin() const { return begin_; }
  /// q' of that state (N).
  const mechanics::Vector& rate() const { return rate_; }
  /// C^T lambda of that state, on each velocity (n).
  const mechanics::Vector& constraint_forces() const { return forces_; }
  /// In force.
  const mechanics::Vector& input() const { return input_; }

  double time() const override;
  std::uint64_t switches() const override { return under_way() ? figures_.switches : plant_->switches(); }
  std::uint64_t evaluations() const override {
    return under_way() ? figures_.evaluations : plant_->evaluations();
  }
  /// What accuracy and duration promise up to now.
  double estimated_error() override;
  std::string method() const override { return "auto"; }
  double accuracy() const override { return options_.accuracy; }
  std::string motion() override;

  /// Takes an input that apply_input() puts in force; one of another size, or with numbers that are not
  /// finite, is dropped.
  void take_input(const mechanics::Vector& input);
  /// From the time reached on, until there is another one; the initial input once it is too old.
  /// @param clock  reading of the clock by which it ages [s]
  void apply_input(double clock);
  std::uint64_t dropped_inputs() const override { return drops_.count(); }

  /// The initial state and the initial input.
  void reset() override;

 private:
  /// What is shown of the plant while another thread has it.
  struct Figures {
    double time = 0;
    std::uint64_t switches = 0;
    std::uint64_t evaluations = 0;
  };

  mechanics::Plant make_plant() const;
  void advance(double time, const mechanics::SwitchSink& sink);
  void show(const mechanics::State& state);
  void find_forces(const mechanics::State& state);
  Failure failure_of(const std::exception& error) const override;
  void compute(double time) override { advance(time, sink_); }
  void compute_beside(double time) override;
  void report_kept() override;
  void keep_present() override;

  std::shared_ptr<const SystemPlugin> system_;
  mechanics::SwitchSink sink_;
  mechanics::Options options_;
  double duration_;
  double begin_;
  mechanics::Model names_;
  std::optional<mechanics::Plant> plant_;
  mechanics::Vector input_;
  std::optional<mechanics::Vector> next_input_;
  AgeLimit input_age_;
  DropLog drops_{"input"};
  std::optional<mechanics::State> shown_;  // the last one that was asked for and known
  mechanics::Vector rate_;
  mechanics::Vector forces_;
  Figures figures_;
  SwitchQueue<mechanics::Switch> beside_;  // switches of the other thread
};

}  // namespace hybrid_sphere::ros_interface
