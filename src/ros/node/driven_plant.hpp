#pragma once

#include <chrono>
#include <cstdint>
#include <exception>
#include <functional>
#include <optional>
#include <string>

#include "ros/node/computation.hpp"

namespace hybrid_sphere::ros_interface {

/// What a node drives in time, whatever the system is. All functions return soon: what takes longer than a
/// moment is under way in a thread of its own, and the last state is shown meanwhile. Where the computation
/// cannot go on, whatever it throws, or a number is not finite, it halts: the last state is held until it is
/// told how to go on. Whoever tells it something interrupts what is under way; the next advance_to goes on
/// with it.
class DrivenPlant {
 public:
  using Wall = Computation::Wall;

  /// @param ended    called in another thread when what was under way has ended
  /// @param ways_on  after a halt, for its message: "a reset"
  DrivenPlant(std::function<void()> ended, std::string ways_on);
  virtual ~DrivenPlant() = default;
  DrivenPlant(const DrivenPlant&) = delete;
  DrivenPlant& operator=(const DrivenPlant&) = delete;

  /// Goes on to a time since the initial state [s]; where it has halted nothing happens.
  /// @return false: that is under way, or something else is
  bool advance_to(double time);
  /// What a change brings about at the present time happens now, not at the next tick.
  void act_now() { advance_to(time()); }

  bool under_way() const { return computation_.under_way(); }
  /// Reports the switches of what is under way.
  /// @return whether nothing is under way any more
  bool collect();
  /// Interrupts what is under way: the system stands at the last time that is certain.
  void stand();

  /// Since when it computes towards which time.
  struct Pursuit {
    Wall::time_point since;
    double to;  ///< since the initial state [s]
  };
  /// While something is under way, and until the next advance_to.
  const std::optional<Pursuit>& pursuit() const { return pursuit_; }

  bool halted() const { return !halt_.empty(); }
  /// Why, and when; empty while it runs.
  const std::string& halt() const { return halt_; }
  /// Halts for a reason that is none of the computation's: what has been thrown, and where.
  void fail(const std::string& reason);

  /// Of the state that is known, since the initial state [s].
  virtual double time() const = 0;
  virtual std::uint64_t switches() const = 0;
  /// Of the equations of motion.
  virtual std::uint64_t evaluations() const = 0;
  /// Of the outputs since the initial state, relative to the scale of motion.
  virtual double estimated_error() = 0;
  virtual std::string method() const = 0;
  virtual double accuracy() const = 0;
  /// Messages with an input that were refused, or that were too old.
  virtual std::uint64_t dropped_inputs() const = 0;
  /// How the system moves, as "the sphere moves at 3 m/s"; empty where there is nothing to say.
  virtual std::string motion() = 0;

  /// Back to the initial state.
  virtual void reset() = 0;

 protected:
  /// When the computation has come to its end [s], and why.
  struct Failure {
    double time;
    std::string reason;
  };

  /// Has what is thrown become a halt.
  template <class Function>
  void guarded(const Function& function) {
    try {
      function();
    } catch (const std::exception& error) {
      const Failure failure = failure_of(error);
      halt_at(failure.time, failure.reason, last_state_held);
    }
  }
  /// @param held  what is shown meanwhile: "the last state is held"
  void halt_at(double time, const std::string& reason, const char* held);
  /// It goes on after a halt, as from a new state.
  void forget_halt() { halt_.clear(); }
  void forget_pursuit() { pursuit_.reset(); }

  /// To be asked at the interruption points of the computation.
  bool should_stop() const { return computation_.should_stop(); }
  /// Whether whoever waits in the other thread must not wait any longer.
  bool is_to_stop() const { return computation_.is_to_stop(); }
  /// To be called in the destructor of a derived class: what is under way uses its members.
  void stop_computing() { computation_.stop(); }

  virtual Failure failure_of(const std::exception& error) const;
  /// Goes on to a time, in the thread that calls the functions above; reports each switch at once.
  /// @throws Interrupted  where should_stop() says so
  virtual void compute(double time) = 0;
  /// The same in another thread: switches are kept until report_kept().
  virtual void compute_beside(double time) = 0;
  /// Reports what has been kept.
  virtual void report_kept() = 0;
  /// Keeps what is shown of the present state while another thread computes.
  virtual void keep_present() = 0;

 private:
  static constexpr const char* last_state_held = "the last state is held";

  void go_on_beside(double time);

  std::function<void()> ended_;
  std::string ways_on_;
  std::string halt_;
  std::optional<Pursuit> pursuit_;
  Computation computation_;
};

}  // namespace hybrid_sphere::ros_interface
