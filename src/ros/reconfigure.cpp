#include "hybrid_sphere/ros/reconfigure.hpp"

#include <dynamic_reconfigure/server.h>
#include <hybrid_sphere/SimulatorConfig.h>

#include <boost/any.hpp>
#include <boost/thread/recursive_mutex.hpp>
#include <cmath>
#include <utility>

namespace hybrid_sphere::ros_interface {
namespace {

using scene::SceneError;

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

/// What the generated ranges let through: they are intervals, without the gap above a factor of 0, and pass
/// what is no number.
/// @throws scene::SceneError
void check(const SimulatorConfig& config) {
  for (const auto& parameter : SimulatorConfig::__getParamDescriptions__()) {
    boost::any value;
    parameter->getValue(config, value);
    const double* number = boost::any_cast<double>(&value);
    if (number && std::isnan(*number)) throw SceneError(parameter->name, "nan", "a number");
  }
  if (config.real_time_factor != 0 && config.real_time_factor < least_real_time_factor) {
    throw SceneError("real_time_factor", scene::Tree(config.real_time_factor).describe(),
                     "0, or a number from 0.001 to 1000");
  }
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
  void take(SimulatorConfig& config) {
    try {
      check(config);
    } catch (const SceneError& error) {
      ROS_WARN("%s", error.what());
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
