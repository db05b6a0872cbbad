#pragma once

#include <hybrid_sphere/Kick.h>
#include <hybrid_sphere/SetInitialState.h>
#include <ros/ros.h>

#include <functional>
#include <string>
#include <vector>

#include "ros/node/callback_thread.hpp"
#include "ros/node/frame_transformer.hpp"
#include "ros/node/plant.hpp"

namespace hybrid_sphere::ros_interface {

/// The services that move the sphere: ~set_initial_state, ~set_state and ~kick. A request may come in a frame
/// whose transform has to be waited for: that happens in a thread of its own, and what is asked for in that
/// of the simulation, between two ticks.
class SphereRequests {
 public:
  /// What is left to the node, in the simulation's thread.
  struct Actions {
    std::function<void(const scene::InitialState&)> start_anew;  ///< with this initial state
    std::function<void(const scene::InitialState&)> put;         ///< time goes on
    /// A change of the velocity [m/s]. @return why it was not done, else an empty text
    std::function<std::string(const Vector2d& change)> kick;
  };

  /// @param node         whose private names the services have
  /// @param loop         queue that the simulation's thread handles between ticks
  /// @param transformer, plant  have to live as long as this
  SphereRequests(const ros::NodeHandle& node, ros::CallbackQueueInterface& loop,
                 FrameTransformer& transformer, Plant& plant, Actions actions);
  /// Ends the thread; a request that waits is answered with a failure.
  ~SphereRequests() { thread_.stop(); }
  SphereRequests(const SphereRequests&) = delete;
  SphereRequests& operator=(const SphereRequests&) = delete;

 private:
  bool set_initial_state(SetInitialState::Request& request, SetInitialState::Response& response);
  bool set_state(SetInitialState::Request& request, SetInitialState::Response& response);
  bool kick(Kick::Request& request, Kick::Response& response);
  template <class Response, class Act>
  bool handle(const std::string& frame, Response& response, const Act& act);

  ros::CallbackQueueInterface& loop_;
  FrameTransformer& transformer_;
  Plant& plant_;
  Actions act_;
  CallbackThread thread_{"a request to move the sphere"};
  std::vector<ros::ServiceServer> services_;
};

}  // namespace hybrid_sphere::ros_interface
