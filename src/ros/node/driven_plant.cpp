#include "ros/node/driven_plant.hpp"

#include <ros/console.h>

#include <sstream>
#include <utility>

namespace hybrid_sphere::ros_interface {
namespace {

std::string said(double time, const std::string& reason) {
  std::ostringstream text;
  text.precision(9);
  text << "halted at t = " << time << " s: " << reason;
  return text.str();
}

}  // namespace

DrivenPlant::DrivenPlant(std::function<void()> ended, std::string ways_on)
    : ended_(std::move(ended)), ways_on_(std::move(ways_on)) {}

DrivenPlant::Failure DrivenPlant::failure_of(const std::exception& error) const {
  return {time(), std::string("the computation failed: ") + error.what()};
}

void DrivenPlant::halt_at(double time, const std::string& reason, const char* held) {
  if (halted()) return;
  halt_ = said(time, reason);
  ROS_ERROR("%s; %s until %s", halt_.c_str(), held, ways_on_.c_str());
}

void DrivenPlant::fail(const std::string& reason) { halt_at(time(), reason, last_state_held); }

bool DrivenPlant::advance_to(double time) {
  if (halted()) return true;
  if (under_way()) return false;
  pursuit_.reset();
  bool arrived = true;
  guarded([&] { arrived = computation_.attempt([&] { compute(time); }); });
  if (!arrived) go_on_beside(time);
  return arrived;
}

void DrivenPlant::go_on_beside(double time) {
  keep_present();
  pursuit_ = Pursuit{Wall::now(), time};
  computation_.go_on([this, time] { compute_beside(time); }, ended_);
}

bool DrivenPlant::collect() {
  report_kept();
  bool ended = !under_way();
  guarded([&] { ended = computation_.finish() || ended; });
  if (under_way()) return false;
  report_kept();
  return true;
}

void DrivenPlant::stand() {
  guarded([&] { computation_.interrupt(); });
  report_kept();
}

}  // namespace hybrid_sphere::ros_interface
