// Listens to topics of /hybrid_sphere and does nothing with them; prints how many messages came when it ends.
// For benchmark/node_cpu.
//
//     bare_listener [TOPIC...]     of pose, twist, odom, state, tf and markers; without any the first five

#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/TwistStamped.h>
#include <hybrid_sphere/SphereState.h>
#include <nav_msgs/Odometry.h>
#include <ros/ros.h>
#include <tf2_msgs/TFMessage.h>
#include <visualization_msgs/MarkerArray.h>

#include <cstdio>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace {

std::uint64_t received = 0;

template <class Message>
void count(const boost::shared_ptr<const Message>&) {
  ++received;
}

template <class Message>
std::function<ros::Subscriber(ros::NodeHandle&)> on(const std::string& topic) {
  return [topic](ros::NodeHandle& node) { return node.subscribe(topic, 1000, count<Message>); };
}

}  // namespace

int main(int argc, char** argv) {
  ros::init(argc, argv, "bare_listener");
  ros::NodeHandle node("/hybrid_sphere");
  const std::map<std::string, std::function<ros::Subscriber(ros::NodeHandle&)>> topics{
      {"pose", on<geometry_msgs::PoseStamped>("pose")},
      {"twist", on<geometry_msgs::TwistStamped>("twist")},
      {"odom", on<nav_msgs::Odometry>("odom")},
      {"state", on<hybrid_sphere::SphereState>("state")},
      {"tf", on<tf2_msgs::TFMessage>("/tf")},
      {"markers", on<visualization_msgs::MarkerArray>("markers")}};
  std::vector<std::string> wanted(argv + 1, argv + argc);
  if (wanted.empty()) wanted = {"pose", "twist", "odom", "state", "tf"};
  std::vector<ros::Subscriber> subscribers;
  for (const std::string& topic : wanted) {
    const auto found = topics.find(topic);
    if (found == topics.end()) {
      std::fprintf(stderr, "bare_listener: no topic \"%s\"\n", topic.c_str());
      return 1;
    }
    subscribers.push_back(found->second(node));
  }
  ros::spin();
  std::printf("%llu\n", static_cast<unsigned long long>(received));
  return 0;
}
