#include <nodelet/nodelet.h>
#include <pluginlib/class_list_macros.hpp>

#include <exception>
#include <memory>
#include <thread>

#include "ros/node/simulator_node.hpp"

namespace hybrid_sphere::ros_interface {

/// The simulator in a nodelet manager: the node's class in a thread of its own.
class SimulatorNodelet : public nodelet::Nodelet {
 public:
  ~SimulatorNodelet() override {
    if (simulator_) simulator_->stop();
    if (thread_.joinable()) thread_.join();
  }

 private:
  /// What is refused is thrown, so that the manager answers that the nodelet is not loaded.
  void onInit() override {
    const ros::NodeHandle& node = getPrivateNodeHandle();
    try {
      simulator_ = std::make_unique<SimulatorNode>(node, configuration_of(node));
    } catch (const scene::SceneError& error) {
      NODELET_FATAL("scene refused: %s", error.what());
      throw;
    }
    thread_ = std::thread([this] { run(); });
  }

  void run() {
    try {
      simulator_->run();
    } catch (const std::exception& error) {
      NODELET_FATAL("the computation cannot continue: %s", error.what());
    }
  }

  std::unique_ptr<SimulatorNode> simulator_;
  std::thread thread_;
};

}  // namespace hybrid_sphere::ros_interface

PLUGINLIB_EXPORT_CLASS(hybrid_sphere::ros_interface::SimulatorNodelet, nodelet::Nodelet)
