#pragma once

#include <atomic>
#include <stdexcept>

namespace hybrid_sphere::python {

/// What computes with the lock of the interpreter released is one thread's at a time.
class InUse {
 public:
  /// @throws std::runtime_error  if it is in use
  void take() {
    if (taken_.exchange(true, std::memory_order_acquire)) {
      throw std::runtime_error("it is computing in another thread, or further up in this one");
    }
  }
  bool is_taken() const { return taken_.load(std::memory_order_relaxed); }
  void release() { taken_.store(false, std::memory_order_release); }

 private:
  std::atomic<bool> taken_{false};
};

/// While one lives, an object is in use.
class ExclusiveUse {
 public:
  explicit ExclusiveUse(InUse& in_use) : in_use_(in_use) { in_use_.take(); }
  ~ExclusiveUse() { in_use_.release(); }
  ExclusiveUse(const ExclusiveUse&) = delete;
  ExclusiveUse& operator=(const ExclusiveUse&) = delete;

 private:
  InUse& in_use_;
};

}  // namespace hybrid_sphere::python
