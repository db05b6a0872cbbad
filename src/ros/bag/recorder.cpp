#include "ros/bag/recorder.hpp"

#include <algorithm>
#include <filesystem>
#include <set>
#include <system_error>
#include <utility>

namespace hybrid_sphere::ros_interface {
namespace {

constexpr double moment = 0.1;        // without a message, after which none is on its way [s]
constexpr double longest_finish = 1;  // for what goes on coming [s]

}  // namespace

Recorder::Recorder(const std::string& file, const std::vector<std::string>& topics,
                   std::function<bool()> hurried)
    : file_(file), active_(file + ".active"), hurried_(std::move(hurried)), bag_(active_) {
  node_.setCallbackQueue(&queue_);
  std::set<std::string> seen;
  for (const std::string& given : topics) {
    const std::string name = node_.resolveName(given);
    if (!seen.insert(name).second) continue;
    Topic& topic = topics_.emplace_back(Topic{name});
    const boost::function<void(const ros::MessageEvent<topic_tools::ShapeShifter const>&)> take =
        [this, &topic](const ros::MessageEvent<topic_tools::ShapeShifter const>& event) {
          write(topic, event);
        };
    constexpr std::uint32_t unlimited = 0;
    topic.subscriber = node_.subscribe<topic_tools::ShapeShifter>(name, unlimited, take, ros::VoidConstPtr(),
                                                                  ros::TransportHints().tcpNoDelay());
  }
}

void Recorder::write(Topic& topic, const ros::MessageEvent<topic_tools::ShapeShifter const>& event) {
  if (!failure_.empty()) return;
  if (hurried_()) {
    ++left_out_;
    return;
  }
  try {
    // The first /clock is received before there is a time. No bag takes the time 0.
    ros::Time received = event.getReceiptTime();
    if (received.isZero()) received = ros::Time::now();
    received = std::max(received, ros::TIME_MIN);
    bag_.write(topic.name, received, *event.getMessage(), event.getConnectionHeaderPtr());
    ++topic.messages;
  } catch (const cli::WriteError& error) {
    failure_ = error.what();  // roscpp's queue does not stand an exception
  }
}

void Recorder::work(ros::WallDuration longest_wait) {
  queue_.callAvailable(longest_wait);
  if (!failure_.empty()) throw cli::WriteError(failure_);
}

bool Recorder::finish() {
  const ros::WallTime end = ros::WallTime::now() + ros::WallDuration(longest_finish);
  std::uint64_t before = 0;
  do {
    before = messages();
    work(ros::WallDuration(moment));
  } while (messages() != before && ros::WallTime::now() < end);
  bag_.close();
  std::error_code error;
  std::filesystem::rename(active_, file_, error);
  if (error) throw cli::WriteError("\"" + file_ + "\" cannot be written: " + error.message());
  return left_out_ == 0;
}

std::uint64_t Recorder::messages() const {
  std::uint64_t sum = 0;
  for (const Topic& topic : topics_) sum += topic.messages;
  return sum;
}

}  // namespace hybrid_sphere::ros_interface
