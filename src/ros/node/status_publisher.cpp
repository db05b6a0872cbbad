#include "ros/node/status_publisher.hpp"

#include <diagnostic_msgs/DiagnosticStatus.h>
#include <diagnostic_updater/diagnostic_updater.h>

#include <algorithm>
#include <iomanip>
#include <sstream>
#include <string>
#include <utility>

namespace hybrid_sphere::ros_interface {
namespace {

using diagnostic_msgs::DiagnosticStatus;

constexpr std::chrono::seconds period(1);
constexpr std::uint32_t status_queue_size = 10;

/// ros::Duration holds no more than 68 years.
double seconds_between(const ros::Time& before, const ros::Time& after) {
  return static_cast<double>(static_cast<std::int64_t>(after.toNSec() - before.toNSec())) * 1e-9;
}

}  // namespace

StatusPublisher::StatusPublisher(const ros::NodeHandle& node, DrivenPlant& plant, const TickClock& clock,
                                 const TimeParameters& parameters)
    : plant_(plant),
      clock_(clock),
      follows_(parameters.clock == ClockMode::follow),
      node_(node),
      publisher_(node_.advertise<SimulatorStatus>("status", status_queue_size)),
      due_(Wall::now() + period),
      diagnostic_period_(std::chrono::round<std::chrono::nanoseconds>(
          std::chrono::duration<double>(parameters.diagnostic_period))),
      diagnostics_due_(parameters.diagnostics ? Wall::now() + diagnostic_period_ : Wall::time_point::max()),
      last_wall_(Wall::now()) {
  status_.method = plant.method();
  if (!parameters.diagnostics) return;
  updater_ = std::make_unique<diagnostic_updater::Updater>(ros::NodeHandle(), node_, node_.getNamespace());
  updater_->setHardwareID("none");
  updater_->add("time", [this](Report& report) { report_time(report); });
  updater_->add("solver", [this](Report& report) { report_solver(report); });
}

StatusPublisher::~StatusPublisher() = default;

void StatusPublisher::publish(Wall::time_point now) {
  if (now >= due_) {
    due_ = now + period;
    fill(now);
    if (publisher_.getNumSubscribers() != 0) publisher_.publish(status_);
  }
  if (updater_ && now >= diagnostics_due_) {
    diagnostics_due_ = now + diagnostic_period_;
    updater_->force_update();
  }
}

void StatusPublisher::fill(Wall::time_point now) {
  const double wall = std::chrono::duration<double>(now - last_wall_).count();
  const ros::Time stamp = clock_.stamp(clock_.time());
  const bool runs = clock_.runs();
  // Steps of a paused simulation take no wall time that could be compared.
  const bool measured = runs && clock_.starts() == last_starts_ && last_stamp_ != ros::Time();
  const double passed =
      seconds_between(last_stamp_, stamp) - (clock_.held() - std::exchange(last_held_, clock_.held()));
  // Both differences are of the rounding of stamps.
  status_.real_time_factor = measured && wall > 0 ? std::max(0.0, passed) / wall : 0;
  status_.real_time_factor_target = clock_.factor();
  newly_late_ = status_.late_ticks - std::exchange(last_late_, status_.late_ticks);
  new_ticks_ = status_.ticks - std::exchange(last_ticks_, status_.ticks);
  last_wall_ = now;
  last_stamp_ = stamp;
  last_starts_ = clock_.starts();
  status_.header.stamp = stamp;
  status_.paused = !runs;
  status_.time = plant_.time();
  status_.estimated_error = plant_.estimated_error();
  status_.rhs_evaluations = plant_.evaluations();
  status_.switches = plant_.switches();
  status_.dropped_inputs = plant_.dropped_inputs();
  status_.lag = clock_.lag();
  status_.behind = 0;
  if (plant_.under_way()) {
    status_.behind = std::chrono::duration<double>(now - plant_.pursuit()->since).count();
  }
  status_.message = plant_.halted() ? plant_.halt() : why_behind();
}

/// Why simulated time does not pass as it should; empty where it does, or where that is not known yet.
std::string StatusPublisher::why_behind() const {
  constexpr double tolerated = 0.95;
  constexpr double many_late = 0.05;  // of the ticks
  std::ostringstream text;
  if (plant_.under_way()) {
    text << std::setprecision(9) << "behind: t = " << plant_.pursuit()->to << " s has taken "
         << std::setprecision(3) << status_.behind
         << " s of wall time so far, from t = " << std::setprecision(9) << plant_.time() << " s on";
    const std::string motion = plant_.motion();
    if (!motion.empty()) text << ", where " << motion;
  } else if (!follows_ && !status_.paused && status_.real_time_factor > 0 &&
             status_.real_time_factor < tolerated * status_.real_time_factor_target) {
    text << std::setprecision(3) << "slower than requested: " << newly_late_
         << " late ticks in the last second, real-time factor " << status_.real_time_factor;
  } else if (!status_.paused &&
             static_cast<double>(newly_late_) > many_late * static_cast<double>(new_ticks_)) {
    text << newly_late_ << " ticks were left out in the last second, " << new_ticks_ << " were taken";
  }
  return text.str();
}

/// Whether simulated time passes as it should; in the first second after a pause that is not known yet.
void StatusPublisher::report_time(Report& report) const {
  const std::string why = why_behind();
  if (plant_.under_way()) {
    report.summary(DiagnosticStatus::WARN, status_.message);
  } else if (status_.paused) {
    report.summary(DiagnosticStatus::OK, "paused");
  } else if (!why.empty()) {
    report.summary(DiagnosticStatus::WARN, why);
  } else if (newly_late_ > 0) {
    report.summary(DiagnosticStatus::WARN, "late ticks");
  } else {
    report.summary(DiagnosticStatus::OK, "on time");
  }
  report.add("behind [s of wall time]", status_.behind);
  report.add("lag of the stamps [s of wall time]", status_.lag);
  report.add("inputs dropped", status_.dropped_inputs);
  report.add("real-time factor asked for", status_.real_time_factor_target);
  report.add("real-time factor reached", status_.real_time_factor);
  report.add("rate [Hz of simulated time]", clock_.rate());
  report.add("ticks", status_.ticks);
  report.add("late ticks", status_.late_ticks);
  report.add("late ticks in the last second", newly_late_);
}

void StatusPublisher::report_solver(Report& report) const {
  const double accuracy = plant_.accuracy();
  if (plant_.halted()) {
    report.summary(DiagnosticStatus::ERROR, plant_.halt());
  } else if (status_.estimated_error > accuracy) {
    report.summary(DiagnosticStatus::WARN, "the estimated error exceeds the requested accuracy");
  } else {
    report.summary(DiagnosticStatus::OK, "as accurate as requested");
  }
  report.add("method", status_.method);
  report.add("accuracy asked for", accuracy);
  report.add("estimated error", status_.estimated_error);
  report.add("right-hand sides", status_.rhs_evaluations);
  report.add("switches", status_.switches);
  report.add("time [s]", status_.time);
}

}  // namespace hybrid_sphere::ros_interface
