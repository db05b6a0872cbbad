#pragma once

#include <hybrid_sphere/SimulatorStatus.h>
#include <ros/ros.h>

#include <algorithm>
#include <chrono>
#include <memory>

#include "ros/node/driven_plant.hpp"
#include "ros/node/parameters.hpp"
#include "ros/node/tick_clock.hpp"

namespace diagnostic_updater {
class DiagnosticStatusWrapper;
class Updater;
}  // namespace diagnostic_updater

namespace hybrid_sphere::ros_interface {

/// How the simulator is doing, once a second of wall time: ~status, and /diagnostics if that is wanted.
class StatusPublisher {
 public:
  using Wall = TickClock::Wall;

  /// @param plant, clock  have to live as long as this
  StatusPublisher(const ros::NodeHandle& node, DrivenPlant& plant, const TickClock& clock,
                  const TimeParameters& parameters);
  ~StatusPublisher();

  /// Counts a tick that was computed.
  void add_tick() { ++status_.ticks; }
  /// Counts ticks that were late.
  void add_late(std::uint64_t ticks) { status_.late_ticks += ticks; }

  /// When something is to be published next.
  Wall::time_point due() const { return std::min(due_, diagnostics_due_); }
  /// Publishes ~status and /diagnostics if they are due.
  void publish(Wall::time_point now);

 private:
  using Report = diagnostic_updater::DiagnosticStatusWrapper;

  void fill(Wall::time_point now);
  std::string why_behind() const;
  void report_time(Report& report) const;
  void report_solver(Report& report) const;

  DrivenPlant& plant_;
  const TickClock& clock_;
  bool follows_;  // another node's /clock sets the pace
  ros::NodeHandle node_;
  ros::Publisher publisher_;
  std::unique_ptr<diagnostic_updater::Updater> updater_;  // none where diagnostics are not wanted
  SimulatorStatus status_;
  Wall::time_point due_;
  std::chrono::nanoseconds diagnostic_period_;
  Wall::time_point diagnostics_due_;
  // At the last status.
  Wall::time_point last_wall_;
  ros::Time last_stamp_;
  double last_held_ = 0;
  std::uint64_t last_late_ = 0;
  std::uint64_t newly_late_ = 0;
  std::uint64_t last_ticks_ = 0;
  std::uint64_t new_ticks_ = 0;
  std::uint64_t last_starts_ = 0;
};

}  // namespace hybrid_sphere::ros_interface
