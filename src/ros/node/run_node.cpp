#include "ros/node/run_node.hpp"

#include <cctype>
#include <exception>
#include <iostream>
#include <string>
#include <vector>

#include "cli/exit_code.hpp"
#include "hybrid_sphere/scene/scene_error.hpp"
#include "ros/node/parameters.hpp"

namespace hybrid_sphere::ros_interface {
namespace {

/// Private parameters that are given as arguments, `_rate:=500`: roscpp writes them to the parameter server.
std::vector<std::string> parameters_of(int argc, char** argv) {
  std::vector<std::string> names;
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    const std::size_t end = argument.find(":=");
    const bool is_private = argument.rfind('_', 0) == 0 && end != std::string::npos && end > 1;
    if (is_private && std::isalpha(static_cast<unsigned char>(argument[1])) != 0)
      names.push_back(argument.substr(1, end - 1));
  }
  return names;
}

}  // namespace

scene::Tree private_parameters(const ros::NodeHandle& node) {
  XmlRpc::XmlRpcValue parameters;
  const bool any = ros::param::get(node.getNamespace(), parameters);
  return any ? tree_from_parameters(parameters) : scene::Tree(scene::Tree::Map{});
}

int run_node(int argc, char** argv, const NodeProgram& program) {
  const std::vector<std::string> given = parameters_of(argc, argv);
  try {
    ros::init(argc, argv, program.node);
  } catch (const ros::Exception& error) {  // a name that none can have, as in `_~rate:=0`
    std::cerr << program.program << ": " << error.what() << '\n';
    return cli::usage;
  }
  const ros::NodeHandle node("~");
  try {
    program.run(node);
    return cli::done;
  } catch (const scene::SceneError& error) {
    ROS_FATAL("%s refused: %s%s", program.what, error.what(), program.hint(node).c_str());
    for (const std::string& name : given) node.deleteParam(name);  // they would be refused next time, too
    return cli::refused;
  } catch (const std::exception& error) {
    ROS_FATAL("the computation cannot continue: %s", error.what());
    return cli::could_not_go_on;
  }
}

}  // namespace hybrid_sphere::ros_interface
