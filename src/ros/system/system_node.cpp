#include "ros/system/system_node.hpp"

#include <chrono>
#include <string>
#include <utility>

#include "ros/markers/picture.hpp"
#include "ros/node/answer.hpp"
#include "ros/node/callback_queue_call.hpp"
#include "ros/node/publish_latched.hpp"
#include "ros/node/queues.hpp"

namespace hybrid_sphere::ros_interface {
namespace {

using mechanics::State;

constexpr std::uint32_t unbounded = 0;  // queue of a publisher: nothing is dropped
constexpr std::uint32_t marker_queue = 10;
constexpr std::chrono::milliseconds marker_period(40);

}  // namespace

template <class Message, class Make>
std::function<const Message*()> SystemNode::present(const Make& make) {
  return [this, make]() -> const Message* {
    const std::optional<ros::Time> stamp = time_.standing_stamp();
    const State* state = stamp ? plant_.state() : nullptr;
    return state != nullptr ? &make(*state, *stamp) : nullptr;
  };
}

SystemNode::SystemNode(const ros::NodeHandle& node, const SystemConfiguration& configuration,
                       std::shared_ptr<const SystemPlugin> system)
    : node_(with_queue(node, queue_)),
      system_(std::move(system)),
      plant_(
          system_, configuration.accuracy, configuration.duration.value_or(system_->duration()),
          configuration.command_timeout, [this](const mechanics::Switch& event) { pass(event); },
          [this] { post(queue_, [] {}); }),
      time_(node_, queue_, configuration.time, configuration.adjustable, plant_, *this),
      messages_(configuration.world_frame, configuration.frame_prefix, view_frame_of(node), plant_, *system_),
      view_(node_, configuration.world_frame,
            messages_.has_bodies() ? view_frame_of(node) : configuration.world_frame, {}, framed_body()),
      joints_(node_, "joint_states",
              present<sensor_msgs::JointState>([this](const State& state, const ros::Time& stamp) -> auto& {
                return messages_.joints(state, stamp);
              })),
      state_(node_, "state",
             present<SystemState>([this](const State& state, const ros::Time& stamp) -> auto& {
               return messages_.state(state, stamp);
             })) {
  switch_publisher_ = node_.advertise<SystemSwitch>("switch", unbounded, true);
  if (messages_.has_bodies()) {
    tf_.emplace(node_, "/tf",
                present<tf2_msgs::TFMessage>([this](const State& state, const ros::Time& stamp) -> auto& {
                  return messages_.transforms(state, stamp, view_);
                }));
    markers_publisher_ = node_.advertise<visualization_msgs::MarkerArray>("markers", marker_queue);
  }
  input_subscriber_ = node_.subscribe("input", newest_only, &SystemNode::take_input, this,
                                      ros::TransportHints().tcpNoDelay());
  get_state_ = node_.advertiseService("get_state", &SystemNode::get_state, this);
  time_.advertise();
}

void SystemNode::pass(const mechanics::Switch& event) {
  time_.add_switch();
  publish_latched(switch_publisher_, messages_.event(event, time_.stamp(event.time - plant_.begin())));
  if (is_watched()) messages_.show(event);
  if (!switch_log_.admits()) return;
  const auto listed = [this](const mechanics::ActiveSet& set) {
    return set.empty() ? std::string("none") : mechanics::names(plant_.model(), set);
  };
  const bool is_impulse = event.applied.empty() && event.released.empty() && event.events.empty();
  if (is_impulse) {
    ROS_INFO("switch %llu at t = %.9g s: impulse of %s", static_cast<unsigned long long>(event.index),
             event.time, listed(struck(event)).c_str());
    return;
  }
  ROS_INFO("switch %llu at t = %.9g s: applied %s, released %s", static_cast<unsigned long long>(event.index),
           event.time, listed(event.applied).c_str(), listed(event.released).c_str());
}

/// The constraints that have given an impulse.
mechanics::ActiveSet SystemNode::struck(const mechanics::Switch& event) const {
  const mechanics::Model& model = plant_.model();
  mechanics::ActiveSet all;
  for (std::size_t i = 0; i < model.constraints.size(); ++i) {
    const auto given =
        event.multipliers.segment(model.multiplier_of(i), model.constraints[i].function->size()).array();
    if ((given != 0).any()) all.push_back(i);
  }
  return all;
}

/// The first body in the present state; a body of 1 m at the origin if there is none.
FramedBody SystemNode::framed_body() {
  const State* state = plant_.state();
  const std::optional<FramedBody> body = state != nullptr ? messages_.framed_body(*state) : std::nullopt;
  return body.value_or(FramedBody{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), 0.5});
}

void SystemNode::has_started_anew() {
  view_.restart(framed_body().position);
  messages_.restart();
}

void SystemNode::take_input(const std_msgs::Float64MultiArray& message) {
  plant_.take_input(
      Eigen::Map<const Eigen::VectorXd>(message.data.data(), static_cast<Eigen::Index>(message.data.size())));
}

bool SystemNode::get_state(GetState::Request&, GetState::Response& response) {
  return answer(plant_, response, [&]() -> std::string {
    const State* state = plant_.state();
    if (state == nullptr) return plant_.halt();
    fill(*state, response);
    return {};
  });
}

void SystemNode::describe(Step::Response& response) {
  if (const State* state = plant_.state()) fill(*state, response);
}

/// What a SphereState says of any system, and all of it.
template <class Response>
void SystemNode::fill(const State& state, Response& response) {
  const SystemState& system = messages_.state(state, time_.present());
  response.system = {system};
  response.state.header = system.header;
  response.state.time = system.time;
  response.state.stage = system.stage;
  response.state.kinetic_energy = system.kinetic_energy;
  response.state.pose.orientation.w = 1;
}

void SystemNode::publish_state(const ros::Time& stamp) {
  if (!joints_.wanted() && !state_.wanted() && !(tf_ && tf_->wanted())) {
    joints_.skip();
    state_.skip();
    if (tf_) tf_->skip();
    return;
  }
  const State* state = plant_.state();
  if (state == nullptr) return;
  joints_.publish([&]() -> auto& { return messages_.joints(*state, stamp); });
  state_.publish([&]() -> auto& { return messages_.state(*state, stamp); });
  if (tf_) tf_->publish([&]() -> auto& { return messages_.transforms(*state, stamp, view_); });
}

void SystemNode::publish_markers(Wall::time_point now) {
  if (!markers_publisher_ || now < next_markers_ || !is_watched()) return;
  next_markers_ = now + marker_period;
  if (const State* state = plant_.state()) {
    markers_publisher_.publish(messages_.markers(*state, picture_part::unit * view_.view().distance()));
  }
}

}  // namespace hybrid_sphere::ros_interface
