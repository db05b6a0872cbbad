#pragma once

#include <ros/ros.h>

#include <functional>
#include <memory>

#include "hybrid_sphere/ros/parameters.hpp"

namespace hybrid_sphere::ros_interface {

/// What may be changed while the node runs, by dynamic_reconfigure under the node's private names. Calls come
/// in the thread of the node's queue.
class Reconfigure {
 public:
  /// @param begin  in force
  /// @param apply  called with each other set of values that is asked for
  Reconfigure(const ros::NodeHandle& node, const Adjustable& begin,
              std::function<void(const Adjustable&)> apply);
  ~Reconfigure();

 private:
  class Server;
  std::unique_ptr<Server> server_;
};

}  // namespace hybrid_sphere::ros_interface
