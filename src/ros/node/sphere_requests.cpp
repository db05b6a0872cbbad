#include "ros/node/sphere_requests.hpp"

#include <utility>

#include "ros/conversions/initial_state_message.hpp"
#include "ros/node/answer.hpp"
#include "ros/node/command.hpp"
#include "ros/node/queues.hpp"

namespace hybrid_sphere::ros_interface {

SphereRequests::SphereRequests(const ros::NodeHandle& node, ros::CallbackQueueInterface& loop,
                               FrameTransformer& transformer, Plant& plant, Actions actions)
    : loop_(loop), transformer_(transformer), plant_(plant), act_(std::move(actions)) {
  ros::NodeHandle names = with_queue(node, thread_.queue());
  services_ = {names.advertiseService("set_initial_state", &SphereRequests::set_initial_state, this),
               names.advertiseService("set_state", &SphereRequests::set_state, this),
               names.advertiseService("kick", &SphereRequests::kick, this)};
  thread_.start();
}

bool SphereRequests::set_initial_state(SetInitialState::Request& request,
                                       SetInitialState::Response& response) {
  return handle(request.header.frame_id, response, [&](const Eigen::Isometry3d& to_world) {
    act_.start_anew(initial_state_from_message(request, to_world, plant_.sphere().radius()));
    return std::string();
  });
}

bool SphereRequests::set_state(SetInitialState::Request& request, SetInitialState::Response& response) {
  return handle(request.header.frame_id, response, [&](const Eigen::Isometry3d& to_world) {
    act_.put(initial_state_from_message(request, to_world, plant_.sphere().radius()));
    return std::string();
  });
}

bool SphereRequests::kick(Kick::Request& request, Kick::Response& response) {
  return handle(request.header.frame_id, response, [&](const Eigen::Isometry3d& to_world) {
    return act_.kick(kick_from_message(request, to_world, plant_.sphere().mass()));
  });
}

/// @param act  called in the simulation's thread with the transform from the frame to the world frame;
///             returns why it has not been done, else an empty text
template <class Response, class Act>
bool SphereRequests::handle(const std::string& frame, Response& response, const Act& act) {
  response.success = false;
  response.message = "the node is shutting down";
  Eigen::Isometry3d to_world;
  try {
    to_world = transformer_.wait_for(frame, "header.frame_id");
  } catch (const scene::SceneError& error) {
    response.message = error.what();
    return true;
  }
  thread_.run_in(loop_, [&] { answer(plant_, response, [&] { return act(to_world); }); });
  return true;
}

}  // namespace hybrid_sphere::ros_interface
