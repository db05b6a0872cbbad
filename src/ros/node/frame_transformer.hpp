#pragma once

#include <Eigen/Geometry>
#include <chrono>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "ros/node/callback_thread.hpp"

namespace tf2 {
class BufferCore;
}
namespace tf2_ros {
class TransformListener;
}

namespace hybrid_sphere::ros_interface {

/// Takes what is given in any frame that tf2 connects with the world frame, by the latest transform. /tf is
/// listened to from the first message in another frame on, and not before: it is as busy as the simulator.
/// Where a transform is not known it is waited for, a second at most, in a thread that is not the loop's.
class FrameTransformer {
 public:
  using Isometry = Eigen::Isometry3d;
  using Use = std::function<void(const Isometry&)>;
  using Refuse = std::function<void(const std::string& reason)>;

  /// @param loop  queue of the thread that calls `with_transform`
  FrameTransformer(std::string world_frame, ros::CallbackQueueInterface& loop);
  ~FrameTransformer();
  FrameTransformer(const FrameTransformer&) = delete;
  FrameTransformer& operator=(const FrameTransformer&) = delete;

  /// Calls `use` with the transform from a frame to the world frame, in this thread: now where it is known,
  /// else when it is.
  /// @param frame   empty: the world frame; a leading slash, as ROS's older tf had it, is left out
  /// @param path    of the field that names it
  /// @param refuse  called instead where it stays unknown
  void with_transform(const std::string& frame, const std::string& path, Use use, Refuse refuse);

  /// The transform from a frame to the world frame; waits for it. Not for the loop's thread.
  /// @throws scene::SceneError  where it stays unknown
  Isometry wait_for(const std::string& frame, const std::string& path) {
    return wait_until(Wall::now() + patience, frame, path);
  }

  /// How many calls of with_transform() have neither used a transform nor been refused yet.
  int waiting() const { return waiting_; }

 private:
  using Wall = std::chrono::steady_clock;

  void start();
  Isometry wait_until(Wall::time_point end, const std::string& frame, const std::string& path);
  std::optional<Isometry> known(const std::string& frame);

  static constexpr std::chrono::seconds patience{1};  // of wall time: that of the simulation may stand

  std::string world_;
  ros::CallbackQueueInterface& loop_;
  int waiting_ = 0;  // of the loop's thread
  std::mutex starting_;
  bool has_started_ = false;
  std::unique_ptr<tf2::BufferCore> buffer_;
  std::unique_ptr<tf2_ros::TransformListener> listener_;  // made in the thread: it asks the master
  CallbackThread thread_{"a transform"};                  // last: it uses the others
};

}  // namespace hybrid_sphere::ros_interface
