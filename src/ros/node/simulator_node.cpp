#include "ros/node/simulator_node.hpp"

#include <utility>

#include "ros/conversions/conversions.hpp"
#include "ros/node/callback_queue_call.hpp"
#include "ros/node/publish_latched.hpp"
#include "ros/node/queues.hpp"

namespace hybrid_sphere::ros_interface {
namespace {

constexpr std::uint32_t unbounded = 0;  // queue of a publisher: nothing is dropped
constexpr std::uint32_t marker_queue = 10;
constexpr std::chrono::milliseconds marker_period(40);
constexpr std::chrono::seconds ball_period(2);  // for bags, and for displays that were switched off and on

MapSettings map_settings(const Configuration& configuration, double view_distance) {
  const scene::Scene& scene = configuration.scene;
  return {configuration.node.frames.world,
          scene.sphere.radius,
          {view_distance, configuration.node.ground_side},
          configuration.node.grid_threshold,
          scene.forces,
          scene.surface,
          scene.solver,
          Dynamics(Sphere(scene.sphere), scene.forces)};
}

Frames frames_of(const Configuration& configuration, const ros::NodeHandle& node) {
  Frames frames = configuration.node.frames;
  frames.view = view_frame_of(node);
  return frames;
}

FramedBody framed_body(const scene::Scene& scene) {
  const Vector2d& position = scene.initial_state.position;
  const Vector2d& velocity = scene.initial_state.velocity;
  return {{position.x(), position.y(), 0}, {velocity.x(), velocity.y(), 0}, scene.sphere.radius};
}

}  // namespace

SimulatorNode::SimulatorNode(const ros::NodeHandle& node, const Configuration& configuration)
    : frames_(frames_of(configuration, node)),
      body_(configuration.scene.sphere),
      node_(with_queue(node, queue_)),
      transformer_(frames_.world, queue_),
      plant_(
          configuration.scene, configuration.node.command_timeout,
          [this](const Switch& event) { pass(event); }, [this] { post(queue_, [] {}); }),
      time_(node_, queue_, configuration.node, configuration.node.adjustable, plant_, *this),
      view_(node_, frames_.world, frames_.view, bounded_extent(configuration.scene.surface),
            framed_body(configuration.scene)),
      state_publisher_(node_, frames_, plant_, view_, [this] { return time_.standing_stamp(); }),
      markers_(frames_, plant_.sphere(), configuration.node.adjustable.markers),
      reconfigure_(node_, configuration.node.adjustable, queue_,
                   [this](const Adjustable& values) { adjust(values); }),
      map_server_(node_, map_settings(configuration, view_.view().distance()), plant_.ground(),
                  {time_.present(), view_.view().center().head<2>()}, queue_, transformer_,
                  [this](const std::shared_ptr<const Ground>& ground, const ErrorEstimate& estimate) {
                    return put_in_force(ground, estimate);
                  }),
      requests_(node_, queue_, transformer_, plant_,
                {[this](const scene::InitialState& state) { place(state); },
                 [this](const scene::InitialState& state) { put(state); },
                 [this](const Vector2d& change) { return kick(change); }}) {
  if (configuration.node.rviz_tools) {
    rviz_tools_.emplace(node_, frames_, transformer_, configuration.node.kick, plant_,
                        RvizTools::Actions{[this](const scene::InitialState& state) { place(state); },
                                           [this](const Vector2d& change) { return kick(change); }});
  }
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
  state_service_ = node_.advertiseService("get_state", &SimulatorNode::get_state, this);
  time_.advertise();
}

void SimulatorNode::pass(const Switch& event) {
  time_.add_switch();
  switch_message_.header.stamp = time_.stamp(event.time, event.time_remainder);
  fill(event, plant_.sphere().radius(), switch_message_);
  publish_latched(switch_publisher_, switch_message_);
  markers_.add(event, switch_message_.header.stamp);
  switch_log_.add(event);
}

void SimulatorNode::publish_markers(Wall::time_point now) {
  if (now < next_markers_ || markers_publisher_.getNumSubscribers() == 0) return;
  next_markers_ = now + marker_period;
  const bool all = std::exchange(new_marker_listener_, false) || now >= next_ball_;
  if (all) {
    next_ball_ = now + ball_period;
    markers_publisher_.publish(markers_.ball());
  }
  const State* state = plant_.state();
  if (state == nullptr) return;
  const Vector2d center = view_.follow({state->position.x(), state->position.y(), 0}).head<2>();
  const double unit = picture_part::unit * view_.view().distance();
  markers_publisher_.publish(markers_.update(*state, time_.present(), all, unit, *map_server_.names()));
  map_server_.keep_in_view(center);
}

}  // namespace hybrid_sphere::ros_interface
