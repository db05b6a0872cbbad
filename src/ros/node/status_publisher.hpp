#pragma once

#include <hybrid_sphere/SimulatorStatus.h>
#include <ros/ros.h>

#include <chrono>
#include <memory>

#include "ros/node/driven_plant.hpp"
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

  /// @param plant        both have to live as long as this
  /// @param diagnostics  whether /diagnostics is published
  /// @param follows      whether somebody else tells how fast time passes
  StatusPublisher(const ros::NodeHandle& node, DrivenPlant& plant, const TickClock& clock, bool diagnostics,
                  bool follows);
  ~StatusPublisher();

  /// Counts a tick that was computed.
  void add_tick() { ++status_.ticks; }
  /// Counts ticks that were late.
  void add_late(std::uint64_t ticks) { status_.late_ticks += ticks; }

  /// When it is to be published next.
  Wall::time_point due() const { return due_; }
  void publish(Wall::time_point now);

 private:
  using Report = diagnostic_updater::DiagnosticStatusWrapper;

  void fill(Wall::time_point now);
  std::string why_behind() const;
  void report_time(Report& report) const;
  void report_solver(Report& report) const;

  DrivenPlant& plant_;
  const TickClock& clock_;
  bool follows_;
  ros::NodeHandle node_;
  ros::Publisher publisher_;
  std::unique_ptr<diagnostic_updater::Updater> updater_;  // none where diagnostics are not wanted
  SimulatorStatus status_;
  Wall::time_point due_;
  // At the last status.
  Wall::time_point last_wall_;
  ros::Time last_stamp_;
  double last_held_ = 0;
  std::uint64_t last_late_ = 0;
  std::uint64_t newly_late_ = 0;
  std::uint64_t last_starts_ = 0;
};

}  // namespace hybrid_sphere::ros_interface
