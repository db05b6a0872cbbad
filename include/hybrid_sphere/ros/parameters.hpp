#pragma once

#include <XmlRpcValue.h>

#include <string>

#include "hybrid_sphere/scene/scene.hpp"
#include "hybrid_sphere/scene/tree.hpp"

namespace hybrid_sphere::ros_interface {

/// Names of the two coordinate frames that the node speaks of.
struct Frames {
  std::string world = "world";    ///< fixed, z up, the ground is z = 0
  std::string sphere = "sphere";  ///< fixed in the sphere, origin at its centre
};

/// The node's own parameters, without those of the scene.
struct NodeParameters {
  double rate = 100;  ///< outputs per second [Hz]
  Frames frames;
};

struct Configuration {
  NodeParameters node;
  scene::Scene scene;
};

/// A value of the parameter server as a tree. Integers become numbers; dates, binary data and what is nested
/// deeper than a scene file may be are refused.
/// @param path  put before the keys in error messages
/// @throws scene::SceneError
scene::Tree tree_from_parameters(const XmlRpc::XmlRpcValue& value, const std::string& path = "");

/// The node's private parameters: rate, world_frame and sphere_frame are its own, all the others are the
/// scene's.
/// @throws scene::SceneError  with the key's full path, the value and what is allowed
Configuration read_configuration(const scene::Tree& tree);

}  // namespace hybrid_sphere::ros_interface
