#include "ros/node/switch_queue.hpp"

#include <chrono>
#include <utility>

namespace hybrid_sphere::ros_interface {
namespace {

constexpr std::size_t most = 10000;
constexpr std::chrono::milliseconds patience(10);  // between two looks whether to give up

}  // namespace

void SwitchQueue::push(const Switch& event, const std::function<bool()>& give_up) {
  std::unique_lock<std::mutex> lock(mutex_);
  while (kept_.size() >= most && !give_up()) emptied_.wait_for(lock, patience);
  kept_.push_back({event, std::string(event.from_region), std::string(event.to_region)});
}

void SwitchQueue::report(const std::function<void(const Switch&)>& sink) {
  std::vector<Kept> taken;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    taken = std::exchange(kept_, {});
  }
  if (taken.empty()) return;
  emptied_.notify_one();
  for (Kept& kept : taken) {
    kept.event.from_region = kept.from;
    kept.event.to_region = kept.to;
    sink(kept.event);
  }
}

}  // namespace hybrid_sphere::ros_interface
