#include "hybrid_sphere/ros/simulator_node.hpp"

#include <ros/callback_queue.h>

#include <algorithm>
#include <exception>
#include <utility>

#include "hybrid_sphere/ros/initial_state_message.hpp"
#include "hybrid_sphere/ros/record_messages.hpp"
#include "hybrid_sphere/ros/surface_markers.hpp"
#include "hybrid_sphere/ros/surface_message.hpp"

namespace hybrid_sphere::ros_interface {
namespace {

constexpr std::uint32_t unbounded = 0;  // queue of a publisher: nothing is dropped
constexpr std::uint32_t latched_queue = 10;
constexpr std::chrono::milliseconds marker_period(40);
constexpr std::chrono::seconds ball_period(2);  // for bags, and for displays that were switched off and on

}  // namespace

SimulatorNode::SimulatorNode(const Configuration& configuration)
    : rate_(configuration.node.rate),
      frames_(configuration.node.frames),
      simulation_(configuration.scene),
      sink_([this](const Switch& event) { pass(event); }),
      clock_(rate_, ros::Time::now(), Wall::now()),
      state_publisher_(node_, frames_, simulation_.sphere()),
      markers_(frames_, simulation_.sphere()) {
  const Vector2d& start = configuration.scene.initial_state.position;
  markers_.start_at(start);
  view_ = view_around(simulation_.surface(), {start}, simulation_.sphere().radius());
  switch_message_.header.frame_id = frames_.world;
  advertise();
  publish_map();
  publish_surface_markers();
}

void SimulatorNode::advertise() {
  const auto listener_came = [this](const ros::SingleSubscriberPublisher&) { new_marker_listener_ = true; };
  switch_publisher_ = node_.advertise<ConstraintSwitch>("constraint_switch", unbounded, true);
  map_publisher_ = node_.advertise<SurfaceMap>("surface_map", latched_queue, true);
  surface_markers_publisher_ =
      node_.advertise<visualization_msgs::MarkerArray>("surface_markers", latched_queue, true);
  markers_publisher_ =
      node_.advertise<visualization_msgs::MarkerArray>("markers", latched_queue, listener_came);
  services_ = {node_.advertiseService("set_surface_map", &SimulatorNode::set_surface_map, this),
               node_.advertiseService("get_surface_map", &SimulatorNode::get_surface_map, this),
               node_.advertiseService("set_initial_state", &SimulatorNode::set_initial_state, this),
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
  simulation_.advance_to(clock_.time(), sink_);
  if (state_publisher_.has_listeners()) {
    state_publisher_.publish(simulation_.state(), clock_.stamp(simulation_.time()));
  }
  publish_markers(now);
}

void SimulatorNode::pass(const Switch& event) {
  switch_message_.header.stamp = clock_.stamp(event.time);
  fill(event, simulation_.sphere().radius(), switch_message_);
  switch_publisher_.publish(switch_message_);
  markers_.add(event, switch_message_.header.stamp);
  switch_log_.add(event);
}

/// A constraint that came with a new map or a new state is applied now, not at the next tick.
void SimulatorNode::let_ground_act() { simulation_.advance_to(simulation_.time(), sink_); }

void SimulatorNode::publish_map() {
  map_message_ = message_from_surface(simulation_.surface());
  map_message_.header.frame_id = frames_.world;
  map_message_.header.stamp = clock_.stamp(simulation_.time());
  map_publisher_.publish(map_message_);
}

void SimulatorNode::publish_surface_markers() {
  surface_markers_publisher_.publish(
      surface_markers(simulation_.surface(), view_, simulation_.sphere().radius(), frames_.world));
}

void SimulatorNode::publish_markers(Wall::time_point now) {
  if (now < next_markers_ || markers_publisher_.getNumSubscribers() == 0) return;
  next_markers_ = now + marker_period;
  const bool all = std::exchange(new_marker_listener_, false) || now >= next_ball_;
  if (all) {
    next_ball_ = now + ball_period;
    markers_publisher_.publish(markers_.ball());
  }
  const State state = simulation_.state();
  markers_publisher_.publish(markers_.update(state.position, clock_.stamp(state.time), all));
  if (!view_.contains(state.position)) {
    view_ = view_around(simulation_.surface(), {view_.center, state.position}, simulation_.sphere().radius());
    publish_surface_markers();
  }
}

bool SimulatorNode::set_surface_map(SetSurfaceMap::Request& request, SetSurfaceMap::Response& response) {
  try {
    simulation_.set_surface(surface_from_message(request.map, frames_.world));
  } catch (const scene::SceneError& error) {
    response.message = error.what();
    response.success = false;
    return true;
  }
  let_ground_act();
  view_ = view_around(simulation_.surface(), {simulation_.state().position}, simulation_.sphere().radius());
  publish_map();
  publish_surface_markers();
  response.success = true;
  return true;
}

bool SimulatorNode::get_surface_map(GetSurfaceMap::Request&, GetSurfaceMap::Response& response) {
  response.map = map_message_;
  return true;
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
  put_sphere();
  clock_.restart();
  const Vector2d position = simulation_.state().position;
  markers_.start_at(position);
  let_ground_act();
  if (!view_.contains(position)) {
    view_ = view_around(simulation_.surface(), {position}, simulation_.sphere().radius());
    publish_surface_markers();
  }
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
             body.mass, body.radius, body.gyration_radius, scene::to_string(configuration.scene.surface.base),
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
