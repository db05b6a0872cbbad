#include "ros/node/state_publisher.hpp"

#include <utility>

namespace hybrid_sphere::ros_interface {

template <class Message, class Make>
std::function<const Message*()> StatePublisher::present(const Make& make) {
  return [this, make]() -> const Message* {
    const std::optional<ros::Time> stamp = stands_();
    const State* state = stamp ? plant_.state() : nullptr;
    return state != nullptr ? &make(*state, *stamp) : nullptr;
  };
}

StatePublisher::StatePublisher(ros::NodeHandle& node, const Frames& frames, Plant& plant, ViewPublisher& view,
                               std::function<std::optional<ros::Time>()> stands)
    : plant_(plant),
      view_(view),
      stands_(std::move(stands)),
      messages_(frames, plant.sphere()),
      pose_(node, "pose",
            present<geometry_msgs::PoseStamped>([this](const State& state, const ros::Time& stamp) -> auto& {
              return messages_.pose(state, stamp);
            })),
      twist_(
          node, "twist",
          present<geometry_msgs::TwistStamped>([this](const State& state, const ros::Time& stamp) -> auto& {
            return messages_.twist(state, stamp);
          })),
      odom_(node, "odom",
            present<nav_msgs::Odometry>([this](const State& state, const ros::Time& stamp) -> auto& {
              return messages_.odom(state, stamp);
            })),
      state_(node, "state", present<SphereState>([this](const State& state, const ros::Time& stamp) -> auto& {
               return message(state, stamp);
             })),
      tf_(node, "/tf",
          present<tf2_msgs::TFMessage>([this](const State& state, const ros::Time& stamp) -> auto& {
            return transform(state, stamp);
          })) {}

void StatePublisher::publish(const ros::Time& stamp) {
  if (!pose_.wanted() && !twist_.wanted() && !odom_.wanted() && !state_.wanted() && !tf_.wanted()) {
    pose_.skip();
    twist_.skip();
    odom_.skip();
    state_.skip();
    tf_.skip();
    return;
  }
  const State* state = plant_.state();
  if (state == nullptr) return;
  pose_.publish([&]() -> auto& { return messages_.pose(*state, stamp); });
  twist_.publish([&]() -> auto& { return messages_.twist(*state, stamp); });
  odom_.publish([&]() -> auto& { return messages_.odom(*state, stamp); });
  state_.publish([&]() -> auto& { return message(*state, stamp); });
  tf_.publish([&]() -> auto& { return transform(*state, stamp); });
}

const tf2_msgs::TFMessage& StatePublisher::transform(const State& state, const ros::Time& stamp) {
  const Vector3d& center = view_.follow({state.position.x(), state.position.y(), 0});
  return messages_.transform(state, stamp, center);
}

const SphereState& StatePublisher::message(const State& state, const ros::Time& stamp) {
  return messages_.state(state, plant_.reaction(), stamp);
}

}  // namespace hybrid_sphere::ros_interface
