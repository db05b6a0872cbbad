#include "ros/node/state_publisher.hpp"

#include <algorithm>
#include <utility>

namespace hybrid_sphere::ros_interface {
namespace {

constexpr std::uint32_t queue_size = 1000;  // a second at 1 kHz for a listener that hangs

}  // namespace

template <class Message>
StatePublisher::Topic StatePublisher::advertise(ros::NodeHandle& node, const std::string& name,
                                                Topic StatePublisher::*topic,
                                                const Message& (StatePublisher::*message)(const State&,
                                                                                          const ros::Time&)) {
  const auto greet = [this, topic, message](const ros::SingleSubscriberPublisher& listener) {
    const std::optional<ros::Time> stamp = stands_();
    Topic& to = this->*topic;
    // Who came before the last message was sent has it.
    if (!stamp || to.served >= to.publisher.getNumSubscribers()) return;
    if (const State* state = plant_.state()) listener.publish((this->*message)(*state, *stamp));
  };
  const auto forget = [this, topic](const ros::SingleSubscriberPublisher&) {
    Topic& from = this->*topic;
    from.served -= std::min(from.served, 1U);
  };
  return {node.advertise<Message>(name, queue_size, greet, forget), 0};
}

StatePublisher::StatePublisher(ros::NodeHandle& node, const Frames& frames, Plant& plant,
                               std::function<std::optional<ros::Time>()> stands)
    : plant_(plant), stands_(std::move(stands)), messages_(frames, plant.sphere()) {
  using Self = StatePublisher;
  pose_topic_ = advertise(node, "pose", &Self::pose_topic_, &Self::pose);
  twist_topic_ = advertise(node, "twist", &Self::twist_topic_, &Self::twist);
  odom_topic_ = advertise(node, "odom", &Self::odom_topic_, &Self::odom);
  state_topic_ = advertise(node, "state", &Self::state_topic_, &Self::message);
  tf_topic_ = advertise(node, "/tf", &Self::tf_topic_, &Self::transform);
}

template <class Message>
void StatePublisher::send(Topic& topic,
                          const Message& (StatePublisher::*message)(const State&, const ros::Time&),
                          const State& state, const ros::Time& stamp) {
  topic.served = topic.publisher.getNumSubscribers();
  if (topic.served != 0) topic.publisher.publish((this->*message)(state, stamp));
}

void StatePublisher::publish(const ros::Time& stamp) {
  if (!pose_topic_.wanted() && !twist_topic_.wanted() && !odom_topic_.wanted() && !state_topic_.wanted() &&
      !tf_topic_.wanted()) {
    for (Topic* topic : {&pose_topic_, &twist_topic_, &odom_topic_, &state_topic_, &tf_topic_}) {
      topic->served = 0;
    }
    return;
  }
  const State* state = plant_.state();
  if (state == nullptr) return;
  send(pose_topic_, &StatePublisher::pose, *state, stamp);
  send(twist_topic_, &StatePublisher::twist, *state, stamp);
  send(odom_topic_, &StatePublisher::odom, *state, stamp);
  send(state_topic_, &StatePublisher::message, *state, stamp);
  send(tf_topic_, &StatePublisher::transform, *state, stamp);
}

const geometry_msgs::PoseStamped& StatePublisher::pose(const State& state, const ros::Time& stamp) {
  return messages_.pose(state, stamp);
}

const geometry_msgs::TwistStamped& StatePublisher::twist(const State& state, const ros::Time& stamp) {
  return messages_.twist(state, stamp);
}

const nav_msgs::Odometry& StatePublisher::odom(const State& state, const ros::Time& stamp) {
  return messages_.odom(state, stamp);
}

const SphereState& StatePublisher::message(const State& state, const ros::Time& stamp) {
  return messages_.state(state, plant_.reaction(), stamp);
}

const tf2_msgs::TFMessage& StatePublisher::transform(const State& state, const ros::Time& stamp) {
  return messages_.transform(state, stamp);
}

}  // namespace hybrid_sphere::ros_interface
