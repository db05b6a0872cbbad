#include "ros/node/computation.hpp"

#include <utility>

#include "interrupt/interrupt.hpp"
#include "ros/node/real_time.hpp"

namespace hybrid_sphere::ros_interface {

bool Computation::not_interrupted(const Work& work) {
  try {
    work();
    return true;
  } catch (const Interrupted&) {
    return false;
  }
}

void Computation::go_on(Work work, std::function<void()> ended) {
  result_ = std::async(std::launch::async, [work = std::move(work), ended = std::move(ended)] {
    leave_real_time();
    struct AtEnd {
      const std::function<void()>& call;
      ~AtEnd() { call(); }
    } at_end{ended};
    not_interrupted(work);
  });
}

bool Computation::finish() {
  if (!under_way() || result_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return false;
  result_.get();
  return true;
}

void Computation::interrupt() {
  if (!under_way()) return;
  stops_ = true;
  result_.wait();
  stops_ = false;
  result_.get();
}

void Computation::stop() noexcept {
  try {
    interrupt();
  } catch (...) {  // nobody waits for it any more
  }
}

}  // namespace hybrid_sphere::ros_interface
