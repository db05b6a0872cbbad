#include "ros/node/reconfigure.hpp"

#include <dynamic_reconfigure/server.h>
#include <hybrid_sphere/SimulatorConfig.h>

#include <boost/any.hpp>
#include <boost/thread/recursive_mutex.hpp>
#include <cmath>
#include <utility>

#include "ros/node/callback_thread.hpp"
#include "ros/node/queues.hpp"

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

}  // namespace

/// dynamic_reconfigure puts what is outside of a range to its end and says nothing; these values stay as they
/// were asked for, and are refused.
class AskedConfig : public SimulatorConfig {
 public:
  AskedConfig() = default;
  AskedConfig(const SimulatorConfig& config)
      : SimulatorConfig(config) {}  // NOLINT(google-explicit-constructor)
  void __clamp__() {}               // NOLINT: its name there
};

namespace {

/// Of a value that is another than the one in force, which may be beyond: parameters have wider ranges.
template <class Value>
void check_range(const SimulatorConfig::AbstractParamDescriptionConstPtr& parameter,
                 const SimulatorConfig& config, const SimulatorConfig& in_force, const char* kind) {
  boost::any asked;
  boost::any before;
  boost::any least;
  boost::any most;
  parameter->getValue(config, asked);
  parameter->getValue(in_force, before);
  parameter->getValue(SimulatorConfig::__getMin__(), least);
  parameter->getValue(SimulatorConfig::__getMax__(), most);
  const Value* value = boost::any_cast<Value>(&asked);
  if (!value || *value == boost::any_cast<Value>(before)) return;
  const auto described = [](const boost::any& number) {
    return scene::Tree(static_cast<double>(boost::any_cast<Value>(number))).describe();
  };
  if (!(*value >= boost::any_cast<Value>(least) && *value <= boost::any_cast<Value>(most))) {
    throw SceneError(parameter->name, described(asked),
                     kind + (" from " + described(least) + " to " + described(most)));
  }
}

/// @throws scene::SceneError  for what is outside of the ranges, or in the gap above a factor of 0
void check(const SimulatorConfig& config, const SimulatorConfig& in_force) {
  for (const auto& parameter : SimulatorConfig::__getParamDescriptions__()) {
    check_range<double>(parameter, config, in_force, "a number");
    check_range<int>(parameter, config, in_force, "a whole number");
  }
  if (config.real_time_factor != 0 && config.real_time_factor < least_real_time_factor) {
    throw SceneError("real_time_factor", scene::Tree(config.real_time_factor).describe(),
                     "0, or a number from 0.001 to 100");
  }
}

}  // namespace

class Reconfigure::Server {
 public:
  Server(const ros::NodeHandle& node, const Adjustable& begin, ros::CallbackQueueInterface& loop,
         std::function<void(const Adjustable&)> apply)
      : loop_(loop),
        apply_(std::move(apply)),
        in_force_(begin),
        node_(with_queue(node, thread_.queue())),
        server_(mutex_, node_) {
    server_.updateConfig(config_of(begin));
    // The first call comes at once and has what is in force.
    server_.setCallback([this](AskedConfig& config, std::uint32_t) {
      if (!begun_) return;
      take(config);
      wait_for_master();
    });
    begun_ = true;
    thread_.start();
  }
  ~Server() { thread_.stop(); }

 private:
  void take(AskedConfig& config) {
    try {
      check(config, config_of(in_force_));
    } catch (const SceneError& error) {
      ROS_WARN("%s", error.what());
      config = config_of(in_force_);
      return;
    }
    const Adjustable values = values_of(config);
    if (thread_.run_in(loop_, [&] { apply_(values); })) in_force_ = values;
  }

  /// dynamic_reconfigure writes to the parameter server next. Were there no master then, roscpp would wait
  /// for one under a mutex that whoever writes a line to the console needs, too.
  void wait_for_master() const {
    while (!thread_.ends() && !ros::master::check()) ros::WallDuration(0.1).sleep();
  }

  ros::CallbackQueueInterface& loop_;
  std::function<void(const Adjustable&)> apply_;
  Adjustable in_force_;
  bool begun_ = false;
  boost::recursive_mutex mutex_;
  CallbackThread thread_{"a request of dynamic_reconfigure"};
  ros::NodeHandle node_;
  dynamic_reconfigure::Server<AskedConfig> server_;
};

Reconfigure::Reconfigure(const ros::NodeHandle& node, const Adjustable& begin,
                         ros::CallbackQueueInterface& loop, std::function<void(const Adjustable&)> apply)
    : server_(std::make_unique<Server>(node, begin, loop, std::move(apply))) {}

Reconfigure::~Reconfigure() = default;

}  // namespace hybrid_sphere::ros_interface
