#pragma once

#include <exception>

#include "hybrid_sphere/scene/scene_error.hpp"
#include "ros/node/driven_plant.hpp"

namespace hybrid_sphere::ros_interface {

/// The one place where what a service's handler throws becomes an answer: what the caller has asked for is
/// refused, and whatever else goes wrong halts the plant, too.
/// @param function  returns why it has not been done, else an empty text
/// @return          true: there is an answer
template <class Response, class Function>
bool answer(DrivenPlant& plant, Response& response, const Function& function) {
  try {
    response.message = function();
  } catch (const scene::SceneError& error) {
    response.message = error.what();
  } catch (const std::exception& error) {
    plant.fail(std::string("the node failed: ") + error.what());
    response.message = plant.halt();
  }
  response.success = response.message.empty();
  return true;
}

}  // namespace hybrid_sphere::ros_interface
