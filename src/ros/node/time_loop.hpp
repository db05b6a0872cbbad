#pragma once

#include <hybrid_sphere/Step.h>
#include <ros/ros.h>
#include <std_srvs/SetBool.h>
#include <std_srvs/Trigger.h>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "ros/node/clock_publisher.hpp"
#include "ros/node/driven_node.hpp"
#include "ros/node/driven_plant.hpp"
#include "ros/node/followed_clock.hpp"
#include "ros/node/guarded_queue.hpp"
#include "ros/node/parameters.hpp"
#include "ros/node/status_publisher.hpp"
#include "ros/node/tick_clock.hpp"

namespace hybrid_sphere::ros_interface {

/// The time of a node: the loop that keeps steady wall time, or somebody else's /clock, with ~pause, ~step,
/// ~reset, ~status and /clock. One thread simulates and handles what comes in between ticks, with the state
/// of the last one; a tick that takes long goes on in another one (driven_plant.hpp), and what comes is
/// handled meanwhile. No exception but that of run() leaves it: any other one halts the plant.
class TimeLoop {
 public:
  using Wall = TickClock::Wall;

  /// @param node   whose names are the private ones; has the queue
  /// @param queue, plant, owner  have to live as long as this
  TimeLoop(ros::NodeHandle& node, GuardedQueue& queue, const TimeParameters& parameters,
           const Adjustable& adjustable, DrivenPlant& plant, DrivenNode& owner);

  /// The services, and the clock that is followed.
  void advertise();

  /// Takes each tick at its deadline, the first one at once, until stop() or ROS shuts down.
  /// @throws StampError  past the last time that a stamp can tell
  void run();
  /// Any thread.
  void stop() { stops_ = true; }
  /// Halts the plant for a reason that is none of the computation's.
  void fail(const std::string& what) { plant_.fail("the node failed: " + what); }

  ros::Time present() const { return clock_.stamp(clock_.time()); }
  /// Of the present state while time stands, else none.
  std::optional<ros::Time> standing_stamp() const;
  /// Of a time since the initial state, see TickClock::stamp.
  ros::Time stamp(double time, double rest = 0) const { return clock_.stamp(time, rest); }

  /// Counts a switch that has been reported.
  void add_switch() { ++step_.switches; }

  /// Interrupts what is under way: the system and the clock stand where it has come to.
  void stand();
  /// After a halt: time goes on from where the plant is.
  void resume() { clock_.resume(plant_.time()); }
  /// After a new initial state.
  void start_anew();
  /// After a change of the forces or of the velocities at the present time.
  void act_at_once();
  /// A ~step on its way ends. @param reason  as it is answered: "a new state"
  void end_step(const std::string& reason) { step_.ended_by = reason; }
  void adjust(double rate, double real_time_factor);

 private:
  template <class Function>
  void guarded(const Function& function);
  bool goes_on() const { return !stops_ && ros::ok(); }
  Wall::time_point tick_now() const { return followed_ ? followed_->point() : Wall::now(); }

  void begin();
  void show_initial_state();
  void turn();
  void handle_callbacks_until_due();
  std::chrono::nanoseconds until_due() const;
  void clock_jumped_back(const ros::Time& to);
  void let_time_pass();
  void end_wait(Wall::time_point now);
  double input_clock(Wall::time_point now);
  void keep_time(Wall::time_point now);
  void take_what_has_come(Wall::time_point now);
  bool tick(Wall::time_point now);
  bool go(double from, Wall::time_point now);
  void hold(Wall::time_point now);
  void publish(Wall::time_point now);
  void publish_where_it_stands();

  bool reset(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);
  bool pause(std_srvs::SetBool::Request& request, std_srvs::SetBool::Response& response);
  void change_pause(bool paused);
  void wait_for_input();
  bool step(Step::Request& request, Step::Response& response);
  std::string run_to(double time);
  std::string why_step_ends();
  void serve_during_step();

  struct StepProgress {
    bool is_on_its_way = false;
    std::string ended_by;        // what has ended it, but for its own end
    std::uint64_t switches = 0;  // reported so far, also without a step
  };

  std::atomic<bool> stops_{false};
  TimeParameters parameters_;
  GuardedQueue& queue_;
  ros::NodeHandle node_;
  DrivenPlant& plant_;
  DrivenNode& owner_;
  std::optional<FollowedClock> followed_;
  TickClock clock_;
  ClockPublisher clock_publisher_;
  StatusPublisher status_publisher_;
  bool has_begun_ = false;
  std::optional<Wall::time_point> waits_until_;  // for a viewer: time begins then
  bool holds_ = false;                           // time stands and stamps go on
  // By wall time: how long time has passed, and when that was looked at.
  double passed_ = 0;  // [s]
  Wall::time_point last_passed_;
  std::uint64_t last_starts_ = 0;
  StepProgress step_;
  std::vector<ros::ServiceServer> services_;
};

}  // namespace hybrid_sphere::ros_interface
