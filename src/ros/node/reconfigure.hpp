#pragma once

#include <ros/callback_queue_interface.h>
#include <ros/ros.h>

#include <functional>
#include <memory>

#include "ros/node/parameters.hpp"

namespace hybrid_sphere::ros_interface {

/// What may be changed while the node runs, by dynamic_reconfigure under the node's private names. It writes
/// each set of values to the parameter server, which may take as long as there is no master: in a thread of
/// its own. Only putting the values in force is left to the simulation's thread.
class Reconfigure {
 public:
  /// @param begin  in force
  /// @param loop   queue that the simulation's thread handles between ticks
  /// @param apply  called there with each set of values that is asked for
  Reconfigure(const ros::NodeHandle& node, const Adjustable& begin, ros::CallbackQueueInterface& loop,
              std::function<void(const Adjustable&)> apply);

  /// Ends the thread; a request that waits is given up.
  ~Reconfigure();

 private:
  class Server;
  std::unique_ptr<Server> server_;
};

}  // namespace hybrid_sphere::ros_interface
