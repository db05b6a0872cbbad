// Steers the sphere to a place with a force on its centre: a proportional-derivative controller in the world
// frame,
//   F = stiffness (target - r) - damping v.
// It works on any ground on which a force moves the sphere; where the ground changes, the motion does, too.
//
//   roslaunch hybrid_sphere steer.launch x:=2.0 y:=1.0
// or, beside a node that runs already,
//   rosrun hybrid_sphere steer_to_target _x:=2.0 _y:=1.0
//
// Listens to hybrid_sphere/state, sends hybrid_sphere/cmd_wrench, once for each state: remap both for a node
// of another name. When this program ends, the node drops the force after its ~command_timeout.
//
// Parameters: ~x, ~y         target of the centre in the world frame [m], 0
//             ~stiffness     [N/m], > 0, default 4
//             ~damping       [N s/m], > 0, default 6: m = 2 kg then comes to the target nearly without
//             overshoot
#include <geometry_msgs/WrenchStamped.h>
#include <hybrid_sphere/SphereState.h>
#include <ros/ros.h>

#include <cmath>

namespace {

struct Controller {
  double x;
  double y;
  double stiffness;
  double damping;
  ros::Publisher commands;

  void steer(const hybrid_sphere::SphereState& state) const {
    const auto& position = state.pose.position;
    const auto& velocity = state.twist.linear;
    geometry_msgs::WrenchStamped command;
    command.header = state.header;  // the world frame: that of the force
    command.wrench.force.x = stiffness * (x - position.x) - damping * velocity.x;
    command.wrench.force.y = stiffness * (y - position.y) - damping * velocity.y;
    commands.publish(command);
  }
};

}  // namespace

int main(int argc, char** argv) {
  ros::init(argc, argv, "steer_to_target");
  ros::NodeHandle node;
  const ros::NodeHandle parameters("~");
  Controller controller{parameters.param("x", 0.0), parameters.param("y", 0.0),
                        parameters.param("stiffness", 4.0), parameters.param("damping", 6.0),
                        node.advertise<geometry_msgs::WrenchStamped>("hybrid_sphere/cmd_wrench", 1)};
  const bool usable = std::isfinite(controller.x) && std::isfinite(controller.y) &&
                      controller.stiffness > 0 && controller.damping > 0;
  if (!usable) {
    ROS_FATAL("x, y: finite numbers [m]; stiffness [N/m], damping [N s/m]: numbers > 0");
    return 1;
  }
  const ros::Subscriber states = node.subscribe("hybrid_sphere/state", 1, &Controller::steer, &controller,
                                                ros::TransportHints().tcpNoDelay());
  ros::spin();
}
