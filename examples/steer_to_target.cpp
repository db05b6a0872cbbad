// Catches the sphere in a disc with a force on its centre: a proportional-derivative controller in the world
// frame,
//   F = stiffness (target - r) - damping v, made shorter where it would be larger than the strongest force.
// It works on any ground on which a force moves the sphere; where the ground changes, the motion does, too.
// examples/catch_in_disc.py is the same in Python.
//
//   roslaunch hybrid_sphere steer.launch x:=2.0 y:=1.0
// or, beside a node that runs already,
//   rosrun hybrid_sphere steer_to_target _x:=2.0 _y:=1.0
//
// Listens to hybrid_sphere/state, sends hybrid_sphere/cmd_wrench, once for each state: remap both for a node
// of another name. When this program ends, the node drops the force after its ~command_timeout.
//
// Parameters: ~x, ~y         centre of the disc in the world frame [m], 0
//             ~radius        of the disc [m], > 0, default 0.2
//             ~slow          speed below which a sphere in the disc counts as caught [m/s], > 0, default 0.05
//             ~stiffness     [N/m], > 0, default 4
//             ~damping       [N s/m], > 0, default 6: m = 2 kg then comes to the target nearly without
//             overshoot
//             ~strongest     largest force [N], > 0, default 20
#include <geometry_msgs/WrenchStamped.h>
#include <hybrid_sphere/SphereState.h>
#include <ros/ros.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <sstream>
#include <stdexcept>
#include <string_view>

namespace {

constexpr const char* usage = R"(Catches the sphere in a disc with a force on its centre.
Usage: steer_to_target [_x:=M] [_y:=M] [_radius:=M] [_slow:=M_PER_S] [_stiffness:=N_PER_M] [_damping:=N_S_PER_M]
                       [_strongest:=N] [hybrid_sphere/state:=TOPIC] [hybrid_sphere/cmd_wrench:=TOPIC]
       roslaunch hybrid_sphere steer.launch x:=2.0 y:=1.0     with a simulator
)";

/// A private parameter, of which a default is only taken where there is none.
/// @throws std::invalid_argument  for what is no finite number, or not > 0 where it has to be
double read(const ros::NodeHandle& parameters, const char* name, double standard, const char* unit,
            bool positive = true) {
  XmlRpc::XmlRpcValue value;
  if (!parameters.getParam(name, value)) return standard;
  double number = std::nan("");
  if (value.getType() == XmlRpc::XmlRpcValue::TypeInt) number = static_cast<int>(value);
  if (value.getType() == XmlRpc::XmlRpcValue::TypeDouble) number = static_cast<double>(value);
  if (std::isfinite(number) && (number > 0 || !positive)) return number;
  std::ostringstream message;
  message << "~" << name << ": " << std::boolalpha << value
          << " is refused; allowed: " << (positive ? "a number > 0 " : "a finite number ") << unit;
  throw std::invalid_argument(message.str());
}

struct Controller {
  double x;
  double y;
  double radius;
  double slow;
  double stiffness;
  double damping;
  double strongest;
  ros::Publisher commands;
  bool caught = false;

  void steer(const hybrid_sphere::SphereState& state) {
    const auto& position = state.pose.position;
    const auto& velocity = state.twist.linear;
    const double to_x = x - position.x;
    const double to_y = y - position.y;
    const double force_x = stiffness * to_x - damping * velocity.x;
    const double force_y = stiffness * to_y - damping * velocity.y;
    const double shorter = std::min(1.0, strongest / std::hypot(force_x, force_y));  // inf where no force is
    geometry_msgs::WrenchStamped command;
    command.header = state.header;  // the world frame: that of the force
    command.wrench.force.x = shorter * force_x;
    command.wrench.force.y = shorter * force_y;
    commands.publish(command);

    const bool is_caught = std::hypot(to_x, to_y) <= radius && std::hypot(velocity.x, velocity.y) < slow;
    if (is_caught != caught) {
      ROS_INFO("t = %.3f s: %s at x = %.3f m, y = %.3f m", state.time, is_caught ? "caught" : "lost",
               position.x, position.y);
    }
    caught = is_caught;
  }
};

}  // namespace

int main(int argc, char** argv) {
  if (argc > 1 && (std::string_view(argv[1]) == "--help" || std::string_view(argv[1]) == "-h")) {
    std::fputs(usage, stdout);
    return 0;
  }
  ros::init(argc, argv, "steer_to_target");
  ros::NodeHandle node;
  const ros::NodeHandle parameters("~");
  try {
    Controller controller{read(parameters, "x", 0, "[m]", false),
                          read(parameters, "y", 0, "[m]", false),
                          read(parameters, "radius", 0.2, "[m]"),
                          read(parameters, "slow", 0.05, "[m/s]"),
                          read(parameters, "stiffness", 4, "[N/m]"),
                          read(parameters, "damping", 6, "[N s/m]"),
                          read(parameters, "strongest", 20, "[N]"),
                          node.advertise<geometry_msgs::WrenchStamped>("hybrid_sphere/cmd_wrench", 1)};
    const ros::Subscriber states = node.subscribe("hybrid_sphere/state", 1, &Controller::steer, &controller,
                                                  ros::TransportHints().tcpNoDelay());
    ros::spin();
  } catch (const std::invalid_argument& error) {
    ROS_FATAL("%s", error.what());
    return 1;
  }
}
