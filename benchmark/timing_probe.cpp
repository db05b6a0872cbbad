// What a listener sees of the node's time. For benchmark/node_timing.
//
//     timing_probe lateness SECONDS   lateness of the states' arrival beside the earliest one, in us:
//                                     median, 99 %, worst
//     timing_probe delay COUNT        from sending a command to the first state that shows it, in us: the
//     same

#include <geometry_msgs/WrenchStamped.h>
#include <hybrid_sphere/SphereState.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

namespace {

using Wall = std::chrono::steady_clock;

double microseconds(Wall::duration duration) {
  return std::chrono::duration<double, std::micro>(duration).count();
}

void print(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  if (n == 0) std::exit(1);
  std::printf("%.1f %.1f %.1f\n", values[n / 2], values[n - 1 - n / 100], values[n - 1]);
}

/// Arrivals less the times that the stamps are apart; the earliest counts as in time.
void measure_lateness(ros::NodeHandle& node, double seconds) {
  std::vector<double> arrivals;
  Wall::time_point first;
  ros::Time stamp;
  const ros::Subscriber states = node.subscribe<hybrid_sphere::SphereState>(
      "state", 10000,
      [&](const hybrid_sphere::SphereStateConstPtr& state) {
        const Wall::time_point now = Wall::now();
        if (stamp.isZero()) {
          first = now;
          stamp = state->header.stamp;
        }
        arrivals.push_back(microseconds(now - first) - 1e6 * (state->header.stamp - stamp).toSec());
      },
      ros::VoidConstPtr(), ros::TransportHints().tcpNoDelay());
  const Wall::time_point end =
      Wall::now() + std::chrono::duration_cast<Wall::duration>(std::chrono::duration<double>(seconds));
  while (ros::ok() && Wall::now() < end)
    ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(0.01));
  if (arrivals.empty()) std::exit(1);
  const double earliest = *std::min_element(arrivals.begin(), arrivals.end());
  for (double& arrival : arrivals) arrival -= earliest;
  print(std::move(arrivals));
}

/// A force comes and goes; the first state whose velocity is another one than in the state before shows it.
void measure_delay(ros::NodeHandle& node, int count) {
  std::vector<double> delays;
  double last = 0;
  bool known = false;
  bool waits = false;
  Wall::time_point sent;
  const ros::Subscriber states = node.subscribe<hybrid_sphere::SphereState>(
      "state", 10000,
      [&](const hybrid_sphere::SphereStateConstPtr& state) {
        const double velocity = state->twist.linear.y;
        if (waits && known && velocity != last) {
          delays.push_back(microseconds(Wall::now() - sent));
          waits = false;
        }
        last = velocity;
        known = true;
      },
      ros::VoidConstPtr(), ros::TransportHints().tcpNoDelay());
  const ros::Publisher commands = node.advertise<geometry_msgs::WrenchStamped>("cmd_wrench", 1);
  geometry_msgs::WrenchStamped wrench;
  while (ros::ok() && static_cast<int>(delays.size()) < count) {
    for (const double force : {1.0, 0.0}) {
      wrench.wrench.force.y = force;
      ros::WallDuration(0.02 + 0.0013 * (std::rand() % 16)).sleep();  // at any time within a tick
      ros::getGlobalCallbackQueue()->callAvailable();
      sent = Wall::now();
      waits = force != 0 && commands.getNumSubscribers() != 0 && known;
      commands.publish(wrench);
      while (ros::ok() && waits) ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(0.01));
    }
  }
  print(std::move(delays));
}

}  // namespace

int main(int argc, char** argv) {
  ros::init(argc, argv, "timing_probe");
  ros::NodeHandle node("/hybrid_sphere");
  const std::string what = argc > 2 ? argv[1] : "";
  if (what == "lateness") {
    measure_lateness(node, std::atof(argv[2]));
  } else if (what == "delay") {
    measure_delay(node, std::atoi(argv[2]));
  } else {
    std::fprintf(stderr, "timing_probe lateness SECONDS | delay COUNT\n");
    return 2;
  }
  return 0;
}
