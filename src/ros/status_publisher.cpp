#include "hybrid_sphere/ros/status_publisher.hpp"

#include <diagnostic_msgs/DiagnosticStatus.h>
#include <diagnostic_updater/diagnostic_updater.h>

#include <string>
#include <utility>

namespace hybrid_sphere::ros_interface {
namespace {

using diagnostic_msgs::DiagnosticStatus;

constexpr std::chrono::seconds period(1);
constexpr std::uint32_t queue_size = 10;

}  // namespace

StatusPublisher::StatusPublisher(const ros::NodeHandle& node, Plant& plant, const TickClock& clock,
                                 bool diagnostics)
    : plant_(plant),
      clock_(clock),
      node_(node),
      publisher_(node_.advertise<SimulatorStatus>("status", queue_size)),
      due_(Wall::now() + period),
      last_wall_(Wall::now()) {
  status_.method = scene::to_string(plant.solver().method);
  if (!diagnostics) return;
  updater_ = std::make_unique<diagnostic_updater::Updater>(ros::NodeHandle(), node_, node_.getNamespace());
  updater_->setHardwareID("none");
  updater_->add("time", [this](Report& report) { report_time(report); });
  updater_->add("solver", [this](Report& report) { report_solver(report); });
}

StatusPublisher::~StatusPublisher() = default;

void StatusPublisher::add(const TickClock::Lateness& lateness) {
  ++status_.ticks;
  status_.late_ticks += lateness.late();
}

void StatusPublisher::publish(Wall::time_point now) {
  due_ = now + period;
  fill(now);
  if (publisher_.getNumSubscribers() != 0) publisher_.publish(status_);
  if (updater_) updater_->force_update();
}

void StatusPublisher::fill(Wall::time_point now) {
  const double wall = std::chrono::duration<double>(now - last_wall_).count();
  const ros::Time stamp = clock_.stamp(clock_.time());
  const bool runs = clock_.runs();
  const bool measured = runs && was_running_ && last_stamp_ != ros::Time();
  status_.real_time_factor = measured && wall > 0 ? (stamp - last_stamp_).toSec() / wall : 0;
  status_.real_time_factor_target = clock_.factor();
  newly_late_ = status_.late_ticks - std::exchange(last_late_, status_.late_ticks);
  last_wall_ = now;
  last_stamp_ = stamp;
  was_running_ = runs;
  status_.header.stamp = stamp;
  status_.paused = !runs;
  status_.time = plant_.time();
  status_.estimated_error = plant_.estimated_error();
  status_.rhs_evaluations = plant_.evaluations();
  status_.switches = plant_.switches();
}

/// Whether simulated time passes as it should; in the first second after a pause that is not known yet.
void StatusPublisher::report_time(Report& report) const {
  constexpr double tolerated = 0.95;
  const double wanted = status_.real_time_factor_target;
  if (status_.paused) {
    report.summary(DiagnosticStatus::OK, "paused");
  } else if (status_.real_time_factor > 0 && status_.real_time_factor < tolerated * wanted) {
    report.summary(DiagnosticStatus::WARN, "slower than asked for");
  } else if (newly_late_ > 0) {
    report.summary(DiagnosticStatus::WARN, "late ticks");
  } else {
    report.summary(DiagnosticStatus::OK, "on time");
  }
  report.add("real-time factor asked for", wanted);
  report.add("real-time factor reached", status_.real_time_factor);
  report.add("rate [Hz of simulated time]", clock_.rate());
  report.add("ticks", status_.ticks);
  report.add("late ticks", status_.late_ticks);
  report.add("late ticks in the last second", newly_late_);
}

void StatusPublisher::report_solver(Report& report) const {
  const double accuracy = plant_.solver().accuracy;
  if (plant_.halted()) {
    report.summary(DiagnosticStatus::ERROR, plant_.halt());
  } else if (status_.estimated_error > accuracy) {
    report.summary(DiagnosticStatus::WARN, "the estimated error is larger than the accuracy asked for");
  } else {
    report.summary(DiagnosticStatus::OK, "as accurate as asked for");
  }
  report.add("method", status_.method);
  report.add("accuracy asked for", accuracy);
  report.add("estimated error", status_.estimated_error);
  report.add("right-hand sides", status_.rhs_evaluations);
  report.add("switches", status_.switches);
  report.add("time [s]", status_.time);
}

}  // namespace hybrid_sphere::ros_interface
