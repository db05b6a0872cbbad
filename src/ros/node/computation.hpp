#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <future>

namespace hybrid_sphere::ros_interface {

/// Work of unknown length for a thread that must go on answering: it is begun there and, where it takes
/// longer than a moment, interrupted and gone on with in a thread of its own. Work passes interruption
/// points, which ask should_stop(), and goes on where it was when it is called again.
class Computation {
 public:
  using Wall = std::chrono::steady_clock;
  using Work = std::function<void()>;

  /// How long the caller's thread works [s].
  static constexpr std::chrono::milliseconds moment{20};

  Computation() = default;
  ~Computation() { stop(); }
  Computation(const Computation&) = delete;
  Computation& operator=(const Computation&) = delete;

  /// Works in this thread for a moment. Nothing may be under way.
  /// @return whether the work is done; else it was interrupted
  /// @throws what the work throws
  template <class Function>
  bool attempt(const Function& work) {
    const Moment of_this_thread(*this);
    return not_interrupted(work);
  }

  /// Has the work done in a thread of its own. Nothing may be under way.
  /// @param ended  called in that thread when it has ended; must not throw
  void go_on(Work work, std::function<void()> ended);

  bool under_way() const { return result_.valid(); }

  /// @return whether the work that was under way has ended: nothing is under way any more then
  /// @throws what the work has thrown
  bool finish();

  /// Interrupts what is under way and waits until it has stopped, or has ended.
  /// @throws what the work has thrown
  void interrupt();

  /// The same where nobody waits for what has been thrown.
  void stop() noexcept;

  /// To be asked at the interruption points of the work.
  bool should_stop() const { return stops_ || (until_ != Wall::time_point::max() && Wall::now() > until_); }
  /// Whether whoever waits in the other thread must not wait any longer.
  bool is_to_stop() const { return stops_; }

 private:
  struct Moment {
    explicit Moment(Computation& owner) : owner_(owner) { owner_.until_ = Wall::now() + moment; }
    ~Moment() { owner_.until_ = Wall::time_point::max(); }
    Moment(const Moment&) = delete;
    Moment& operator=(const Moment&) = delete;
    Computation& owner_;
  };

  static bool not_interrupted(const Work& work);

  std::atomic<bool> stops_{false};
  Wall::time_point until_ = Wall::time_point::max();  // of this thread's part; the other one has no limit
  std::future<void> result_;
};

}  // namespace hybrid_sphere::ros_interface
