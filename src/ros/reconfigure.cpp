#include "hybrid_sphere/ros/reconfigure.hpp"

#include <dynamic_reconfigure/server.h>
#include <hybrid_sphere/SimulatorConfig.h>

#include <boost/thread/recursive_mutex.hpp>
#include <utility>

namespace hybrid_sphere::ros_interface {
namespace {

SimulatorConfig config_of(const Adjustable& values) {
  SimulatorConfig config;
  config.rate = values.rate;
  config.real_time_factor = values.real_time_factor;
  config.accuracy = values.accuracy;
  config.trail_length = values.markers.trail_length;
  config.impulse_lifetime = values.markers.impulse_lifetime;
  config.arrow_scale = values.markers.arrow_scale;
  return config;
}

Adjustable values_of(const SimulatorConfig& config) {
  return {config.rate,
          config.real_time_factor,
          config.accuracy,
          {config.trail_length, config.impulse_lifetime, config.arrow_scale}};
}

}  // namespace

class Reconfigure::Server {
 public:
  Server(const ros::NodeHandle& node, const Adjustable& begin, std::function<void(const Adjustable&)> apply)
      : apply_(std::move(apply)), in_force_(begin), server_(mutex_, node) {
    server_.updateConfig(config_of(begin));
    server_.setCallback([this](SimulatorConfig& config, std::uint32_t) { take(config); });
  }

 private:
  // The generated ranges are intervals; between 0 and the least factor there is none.
  void take(SimulatorConfig& config) {
    if (config.real_time_factor != 0 && config.real_time_factor < least_real_time_factor) {
      ROS_WARN("real_time_factor: %g is refused; allowed: 0, or a number from %g to 1000",
               config.real_time_factor, least_real_time_factor);
      config = config_of(in_force_);
      return;
    }
    in_force_ = values_of(config);
    apply_(in_force_);
  }

  std::function<void(const Adjustable&)> apply_;
  Adjustable in_force_;
  boost::recursive_mutex mutex_;
  dynamic_reconfigure::Server<SimulatorConfig> server_;
};

Reconfigure::Reconfigure(const ros::NodeHandle& node, const Adjustable& begin,
                         std::function<void(const Adjustable&)> apply)
    : server_(std::make_unique<Server>(node, begin, std::move(apply))) {}

Reconfigure::~Reconfigure() = default;

}  // namespace hybrid_sphere::ros_interface
