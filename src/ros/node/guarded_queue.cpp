#include "ros/node/guarded_queue.hpp"

#include <boost/make_shared.hpp>
#include <exception>

namespace hybrid_sphere::ros_interface {
namespace {

class GuardedCall : public ros::CallbackInterface {
 public:
  GuardedCall(ros::CallbackInterfacePtr callback, const GuardedQueue::Failed& failed)
      : callback_(std::move(callback)), failed_(failed) {}

  bool ready() override { return callback_->ready(); }

  CallResult call() override {
    try {
      return callback_->call();
    } catch (const std::exception& error) {
      failed_(error.what());
    }
    return Invalid;
  }

 private:
  ros::CallbackInterfacePtr callback_;
  const GuardedQueue::Failed& failed_;  // of the queue, which outlives what it holds
};

}  // namespace

void GuardedQueue::addCallback(const ros::CallbackInterfacePtr& callback, uint64_t owner_id) {
  ros::CallbackQueue::addCallback(boost::make_shared<GuardedCall>(callback, failed_), owner_id);
}

}  // namespace hybrid_sphere::ros_interface
