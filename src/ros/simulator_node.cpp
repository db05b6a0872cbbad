#include "hybrid_sphere/ros/simulator_node.hpp"

#include <ros/callback_queue.h>

#include <algorithm>
#include <exception>
#include <utility>

#include "hybrid_sphere/ros/initial_state_message.hpp"
#include "hybrid_sphere/ros/record_messages.hpp"

namespace hybrid_sphere::ros_interface {
namespace {

constexpr std::uint32_t unbounded = 0;  // queue of a publisher: nothing is dropped
constexpr std::uint32_t marker_queue = 10;
constexpr std::uint32_t newest_only = 1;
constexpr std::chrono::milliseconds marker_period(40);
constexpr std::chrono::seconds ball_period(2);  // for bags, and for displays that were switched off and on

MapSettings map_settings(const Configuration& configuration) {
  const scene::Scene& scene = configuration.scene;
  return {configuration.node.frames.world,
          scene.sphere.radius,
          configuration.node.grid_threshold,
          scene.forces,
          scene.surface,
          scene.solver,
          Dynamics(Sphere(scene.sphere), scene.forces)};
}

}  // namespace

SimulatorNode::SimulatorNode(const Configuration& configuration)
    : rate_(configuration.node.rate),
      frames_(configuration.node.frames),
      body_(configuration.scene.sphere),
      simulation_(configuration.scene),
      sink_([this](const Switch& event) { pass(event); }),
      clock_(rate_, ros::Time::now(), Wall::now()),
      state_publisher_(node_, frames_, simulation_.sphere()),
      markers_(frames_, simulation_.sphere()),
      command_(configuration.node.command_timeout),
      map_server_(map_settings(configuration), simulation_.ground(),
                  {clock_.stamp(0), configuration.scene.initial_state.position},
                  *ros::getGlobalCallbackQueue(),
                  [this](const std::shared_ptr<const Ground>& ground) { return put_in_force(ground); }) {
  markers_.start_at(configuration.scene.initial_state.position);
  switch_message_.header.frame_id = frames_.world;
  advertise();
}

void SimulatorNode::advertise() {
  const auto listener_came = [this](const ros::SingleSubscriberPublisher&) { new_marker_listener_ = true; };
  switch_publisher_ = node_.advertise<ConstraintSwitch>("constraint_switch", unbounded, true);
  markers_publisher_ =
      node_.advertise<visualization_msgs::MarkerArray>("markers", marker_queue, listener_came);
  command_subscriber_ = node_.subscribe("cmd_wrench", newest_only, &SimulatorNode::take_command, this,
                                        ros::TransportHints().tcpNoDelay());
  services_ = {node_.advertiseService("set_initial_state", &SimulatorNode::set_initial_state, this),
               node_.advertiseService("reset", &SimulatorNode::reset, this)};
}

void SimulatorNode::run() {
  clock_ = TickClock(rate_, ros::Time::now(), Wall::now());  // what went before was preparation
  while (ros::ok()) {
    handle_callbacks_until(clock_.deadline());
    if (ros::ok()) tick();
  }
}

void SimulatorNode::handle_callbacks_until(Wall::time_point deadline) {
  constexpr std::chrono::nanoseconds longest_wait = std::chrono::seconds(1);  // then whether ROS shuts down
  ros::CallbackQueue& queue = *ros::getGlobalCallbackQueue();
  std::chrono::nanoseconds left = deadline - Wall::now();
  if (left <= std::chrono::nanoseconds::zero()) queue.callAvailable();
  while (ros::ok() && left > std::chrono::nanoseconds::zero()) {
    ros::WallDuration wait;
    wait.fromNSec(std::min(left, longest_wait).count());
    queue.callAvailable(wait);
    left = deadline - Wall::now();
  }
}

void SimulatorNode::tick() {
  const Wall::time_point now = Wall::now();
  clock_.advance(now);
  advance_to(clock_.time());
  if (state_publisher_.has_listeners()) {
    state_publisher_.publish(simulation_, clock_.stamp(clock_.time()));
  }
  publish_markers(now);
  if (!halted_) set_command(now);
}

/// A command that the method cannot follow is dropped.
void SimulatorNode::set_command(Wall::time_point now) {
  try {
    simulation_.set_command(command_.at(now));
  } catch (const std::invalid_argument& error) {
    command_drops_.add(error.what());
    command_.drop();
  }
}

void SimulatorNode::advance_to(double time) {
  if (halted_) return;
  try {
    simulation_.advance_to(time, sink_);
  } catch (const HaltedError& error) {
    halted_ = true;
    ROS_ERROR(
        "halted at t = %.9g s: %s; the last state is held until a reset, a new initial state or a new map",
        error.time(), error.what());
  }
}

void SimulatorNode::pass(const Switch& event) {
  switch_message_.header.stamp = clock_.stamp(event.time, event.time_rest);
  fill(event, simulation_.sphere().radius(), switch_message_);
  switch_publisher_.publish(switch_message_);
  markers_.add(event, switch_message_.header.stamp);
  switch_log_.add(event);
}

/// A constraint that came with a new map or a new state is applied now, not at the next tick.
void SimulatorNode::let_ground_act() { advance_to(simulation_.time()); }

void SimulatorNode::publish_markers(Wall::time_point now) {
  if (now < next_markers_ || markers_publisher_.getNumSubscribers() == 0) return;
  next_markers_ = now + marker_period;
  const bool all = std::exchange(new_marker_listener_, false) || now >= next_ball_;
  if (all) {
    next_ball_ = now + ball_period;
    markers_publisher_.publish(markers_.ball());
  }
  const Vector2d position = simulation_.state().position;
  markers_publisher_.publish(markers_.update(position, clock_.stamp(clock_.time()), all));
  map_server_.keep_in_view(position);
}

MapServer::Exchange SimulatorNode::put_in_force(const std::shared_ptr<const Ground>& ground) {
  try {
    simulation_.set_ground(ground);
  } catch (const std::invalid_argument& error) {  // the map was checked without a command
    command_drops_.add(error.what());
    command_.drop();
    simulation_.set_command({});
    simulation_.set_ground(ground);
  }
  if (std::exchange(halted_, false)) clock_.resume(simulation_.time());
  let_ground_act();
  return {clock_.stamp(simulation_.time()), simulation_.state().position};
}

void SimulatorNode::take_command(const geometry_msgs::WrenchStamped& message) {
  try {
    command_.take(wrench_from_message(message, frames_.world, body_), Wall::now());
  } catch (const scene::SceneError& error) {
    command_drops_.add(error.what());
  }
}

bool SimulatorNode::set_initial_state(SetInitialState::Request& request,
                                      SetInitialState::Response& response) {
  try {
    const scene::InitialState state = initial_state_from_message(request, simulation_.sphere().radius());
    restart([&] { simulation_.set_initial_state(state); });
  } catch (const scene::SceneError& error) {
    response.message = error.what();
    response.success = false;
    return true;
  }
  response.success = true;
  return true;
}

bool SimulatorNode::reset(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
  restart([&] { simulation_.reset(); });
  response.success = true;
  return true;
}

void SimulatorNode::restart(const std::function<void()>& put_sphere) {
  command_.drop();
  simulation_.set_command({});
  put_sphere();
  halted_ = false;
  clock_.restart();
  const Vector2d position = simulation_.state().position;
  markers_.start_at(position);
  let_ground_act();
  map_server_.keep_in_view(position);
}

int run_simulator(int argc, char** argv) {
  ros::init(argc, argv, "hybrid_sphere");
  const ros::NodeHandle node("~");
  try {
    XmlRpc::XmlRpcValue parameters;
    const bool any = ros::param::get(node.getNamespace(), parameters);
    const Configuration configuration =
        read_configuration(any ? tree_from_parameters(parameters) : scene::Tree(scene::Tree::Map{}));
    SimulatorNode simulator(configuration);
    const scene::SphereBody& body = configuration.scene.sphere;
    ROS_INFO("scene: sphere of %g kg, R = %g m, k = %g m; base %s, regions %zu; %g Hz; frames %s -> %s",
             body.mass, body.radius, body.gyration_radius,
             scene::to_string(configuration.scene.surface.base.law),
             configuration.scene.surface.regions.size(), configuration.node.rate,
             configuration.node.frames.world.c_str(), configuration.node.frames.sphere.c_str());
    simulator.run();
    return 0;
  } catch (const scene::SceneError& error) {
    ROS_FATAL("scene refused: %s", error.what());
    return 3;
  } catch (const std::exception& error) {
    ROS_FATAL("the computation could not go on: %s", error.what());
    return 4;
  }
}

}  // namespace hybrid_sphere::ros_interface
