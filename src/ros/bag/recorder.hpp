#pragma once

#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <topic_tools/shape_shifter.h>

#include <cstdint>
#include <functional>
#include <list>
#include <string>
#include <vector>

#include "ros/bag/bag_file.hpp"

namespace hybrid_sphere::ros_interface {

/// Writes all that comes on some topics, of whatever type, to a bag, each message at the time at which it was
/// received. What has not been written yet waits in memory, without a limit: nothing that came is lost. While
/// it is written the file has ".active" at the end of its name.
class Recorder {
 public:
  struct Topic {
    std::string name;
    std::uint64_t messages = 0;  ///< written
    ros::Subscriber subscriber{};
  };

  /// @param file    is replaced when the bag is whole
  /// @param topics  resolved as names of this node's namespace
  /// @param hurried  asked before each message; true leaves out what has not been written yet
  /// @throws cli::WriteError
  Recorder(const std::string& file, const std::vector<std::string>& topics, std::function<bool()> hurried);

  /// Writes what has come, and waits for it where nothing has.
  /// @throws cli::WriteError
  void work(ros::WallDuration longest_wait);

  /// Writes what has come and what is still on its way, which is over when nothing has come for a moment, and
  /// the index. Returns whether all that had come is written.
  /// @throws cli::WriteError
  bool finish();

  const std::string& active_file() const { return active_; }
  const std::list<Topic>& topics() const { return topics_; }
  std::uint64_t messages() const;

 private:
  void write(Topic& topic, const ros::MessageEvent<topic_tools::ShapeShifter const>& event);

  std::string file_;
  std::string active_;
  std::function<bool()> hurried_;
  std::string failure_;
  std::uint64_t left_out_ = 0;
  BagFile bag_;
  // Of its own: that of the node drops what it has when the node shuts down.
  ros::CallbackQueue queue_;
  ros::NodeHandle node_;
  std::list<Topic> topics_;
};

}  // namespace hybrid_sphere::ros_interface
