#include "ros/node/frame_transformer.hpp"

#include <tf2/buffer_core.h>
#include <tf2_ros/transform_listener.h>

#include <chrono>
#include <utility>

#include "hybrid_sphere/scene/scene_error.hpp"
#include "ros/node/callback_queue_call.hpp"
#include "scene/tree.hpp"

namespace hybrid_sphere::ros_interface {
namespace {

using scene::SceneError;
using scene::Tree;

std::string without_slash(const std::string& frame) {
  return frame.rfind('/', 0) == 0 ? frame.substr(1) : frame;
}

}  // namespace

FrameTransformer::FrameTransformer(std::string world_frame, ros::CallbackQueueInterface& loop)
    : world_(std::move(world_frame)), loop_(loop), buffer_(std::make_unique<tf2::BufferCore>()) {}

FrameTransformer::~FrameTransformer() = default;

void FrameTransformer::start() {
  const std::lock_guard<std::mutex> lock(starting_);
  if (has_started_) return;
  has_started_ = true;
  buffer_->setUsingDedicatedThread(true);
  post(thread_.queue(), [this] { listener_ = std::make_unique<tf2_ros::TransformListener>(*buffer_); });
  thread_.start();
}

/// @return  none where the frame is not connected, or its name is none
std::optional<FrameTransformer::Isometry> FrameTransformer::known(const std::string& frame) {
  const ros::Time latest(0);
  try {
    const auto transform = buffer_->lookupTransform(world_, frame, latest).transform;
    const auto& q = transform.rotation;
    const auto& t = transform.translation;
    Isometry isometry = Isometry::Identity();
    isometry.translation() = Eigen::Vector3d(t.x, t.y, t.z);
    isometry.linear() = Eigen::Quaterniond(q.w, q.x, q.y, q.z).normalized().toRotationMatrix();
    return isometry;
  } catch (const tf2::TransformException&) {
    return std::nullopt;
  }
}

FrameTransformer::Isometry FrameTransformer::wait_until(Wall::time_point end, const std::string& given,
                                                        const std::string& path) {
  const std::string frame = without_slash(given);
  if (frame.empty() || frame == world_) return Isometry::Identity();
  start();
  do {
    if (const auto transform = known(frame)) return *transform;
    ros::WallDuration(0.01).sleep();
  } while (!thread_.ends() && Wall::now() < end);
  throw SceneError(path, Tree(frame).describe(),
                   Tree(world_).describe() + ", empty, or a frame that tf2 connects with it");
}

void FrameTransformer::with_transform(const std::string& given, const std::string& path, Use use,
                                      Refuse refuse) {
  const std::string frame = without_slash(given);
  if (frame.empty() || frame == world_) {
    use(Isometry::Identity());
    return;
  }
  start();
  if (const auto transform = known(frame)) {
    use(*transform);
    return;
  }
  const Wall::time_point end = Wall::now() + patience;
  ++waiting_;
  post(thread_.queue(), [this, end, frame, path, use = std::move(use), refuse = std::move(refuse)] {
    try {
      const Isometry transform = wait_until(end, frame, path);
      post(loop_, [this, use, transform] {
        --waiting_;
        use(transform);
      });
    } catch (const SceneError& error) {
      post(loop_, [this, refuse, reason = std::string(error.what())] {
        --waiting_;
        refuse(reason);
      });
    }
  });
}

}  // namespace hybrid_sphere::ros_interface
