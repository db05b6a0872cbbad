#include "ros/node/time_loop.hpp"

#include <algorithm>

#include "ros/node/real_time.hpp"

namespace hybrid_sphere::ros_interface {
namespace {

/// A node that drives /clock begins with the time of the wall, so that a later run never has earlier stamps
/// than this one; with someone else's /clock, the time that it tells.
ros::Time first_stamp(ClockMode clock) {
  if (clock == ClockMode::own && ros::Time::isSimTime() && ros::Time::isValid()) return ros::Time::now();
  const ros::WallTime wall = ros::WallTime::now();
  return {wall.sec, wall.nsec};
}

/// Waits for someone else's /clock, a while.
ros::Time stamp_of_preparation(ClockMode clock) {
  constexpr double patience = 5;  // [s]
  const bool is_told = ros::Time::isSimTime() && clock != ClockMode::lead;
  const bool has_begun = is_told && ros::Time::waitForValid(ros::WallDuration(patience));
  if (clock == ClockMode::follow) return has_begun ? ros::Time::now() : ros::TIME_MIN;
  if (is_told && !has_begun) {
    ROS_WARN(
        "/use_sim_time is set but nobody publishes /clock: stamps start at wall time; set ~clock to `lead` "
        "to "
        "publish it, or to `follow` to wait for it");
  }
  return first_stamp(clock);
}

}  // namespace

TimeLoop::TimeLoop(ros::NodeHandle& node, GuardedQueue& queue, const TimeParameters& parameters,
                   const Adjustable& adjustable, DrivenPlant& plant, DrivenNode& owner)
    : parameters_(parameters),
      queue_(queue),
      node_(node),
      plant_(plant),
      owner_(owner),
      clock_(adjustable.rate, adjustable.real_time_factor, stamp_of_preparation(parameters.clock)),
      clock_publisher_(node_, parameters.clock == ClockMode::lead, parameters.clock_rate),
      status_publisher_(node_, plant, clock_, parameters) {
  if (parameters.catches_up) clock_.catch_up_always();
}

std::optional<ros::Time> TimeLoop::standing_stamp() const {
  const bool has_no_time = followed_ && !followed_->has_begun();
  return clock_.runs() || has_no_time ? std::nullopt : std::optional<ros::Time>(present());
}

/// The one place where what the loop throws becomes a halt.
template <class Function>
void TimeLoop::guarded(const Function& function) {
  try {
    function();
  } catch (const StampError&) {
    throw;
  } catch (const std::exception& error) {
    fail(error.what());
  }
}

void TimeLoop::run() {
  if (parameters_.realtime_priority != 0) {
    const std::string refused = enter_real_time(parameters_.realtime_priority);
    if (!refused.empty()) ROS_WARN("realtime_priority: the system does not permit %s", refused.c_str());
  }
  guarded([this] { begin(); });
  while (goes_on()) {
    guarded([this] { turn(); });
  }
  plant_.stand();
}

/// Time 0. What went before was preparation.
void TimeLoop::begin() {
  while (followed_ && !followed_->has_begun() && goes_on()) {
    ROS_INFO_ONCE("waiting for /clock");
    queue_.callAvailable(ros::WallDuration(0.1));
    if (Wall::now() >= status_publisher_.due()) status_publisher_.publish(Wall::now());
  }
  if (followed_) {
    clock_.rebase(followed_->now(), tick_now());
  } else {
    clock_.set_epoch(first_stamp(parameters_.clock));
  }
  has_begun_ = true;
  const Wall::time_point now = Wall::now();
  if (!parameters_.paused && parameters_.wait_for_viewer > 0) {
    waits_until_ =
        now + std::chrono::round<Wall::duration>(std::chrono::duration<double>(parameters_.wait_for_viewer));
  } else if (!parameters_.paused) {
    clock_.run(tick_now());
  }
  tick(now);
}

/// Lets time pass, with stamps that are those of a clock that is followed.
void TimeLoop::let_time_pass() {
  if (followed_ && !clock_.runs()) clock_.go_to_stamp(followed_->now());
  clock_.run(tick_now());
}

/// Time begins when somebody looks, or when it is too late for that.
void TimeLoop::end_wait(Wall::time_point now) {
  if (!waits_until_ || (!owner_.is_watched() && now < *waits_until_)) return;
  waits_until_.reset();
  let_time_pass();
}

/// As after a reset of whoever tells the time.
void TimeLoop::clock_jumped_back(const ros::Time& to) {
  if (!parameters_.resets_on_jump_back) {
    ROS_WARN("/clock has jumped back to %.9f s: the state is held until it is past %.9f s", to.toSec(),
             present().toSec());
    return;
  }
  ROS_WARN("/clock has jumped back to %.9f s: back to the initial state", to.toSec());
  if (!has_begun_) return;
  stand();
  plant_.reset();
  clock_.rebase(to, tick_now());
  show_initial_state();
}

void TimeLoop::turn() {
  handle_callbacks_until_due();
  const Wall::time_point now = Wall::now();
  end_wait(now);
  if (now >= status_publisher_.due()) status_publisher_.publish(now);
  if (goes_on()) keep_time(now);
  if (!clock_.runs()) owner_.publish_markers(now);
  owner_.show_standing(!clock_.runs());
}

/// How long the loop has nothing to do, as far as is known.
std::chrono::nanoseconds TimeLoop::until_due() const {
  constexpr std::chrono::nanoseconds look =
      std::chrono::milliseconds(5);  // at the switches of what is under way
  constexpr std::chrono::nanoseconds longest = std::chrono::milliseconds(100);
  const std::chrono::nanoseconds of_status = status_publisher_.due() - Wall::now();
  if (plant_.under_way()) return std::min(look, of_status);
  if (!followed_) return std::min<std::chrono::nanoseconds>(clock_.deadline() - Wall::now(), of_status);
  return clock_.deadline() <= tick_now() ? std::chrono::nanoseconds::zero() : std::min(longest, of_status);
}

/// A callback may change what is due; as long as time stands, that it stops is looked at now and then.
void TimeLoop::handle_callbacks_until_due() {
  constexpr std::chrono::nanoseconds longest_wait = std::chrono::milliseconds(100);
  queue_.callAvailable();
  while (goes_on()) {
    const bool was_under_way = plant_.under_way();
    const std::chrono::nanoseconds left = until_due();
    if (left <= std::chrono::nanoseconds::zero()) return;
    ros::WallDuration wait;
    wait.fromNSec(std::min(left, longest_wait).count());
    queue_.callAvailable(wait);
    if (was_under_way || !clock_.runs()) return;
  }
}

/// The tick that is due, or that was under way and is there now. What is under way for too long does not hold
/// up the clock.
void TimeLoop::keep_time(Wall::time_point now) {
  constexpr auto patience =
      std::chrono::duration_cast<Wall::duration>(std::chrono::duration<double>(TickClock::longest_made_up));
  const bool was_under_way = plant_.under_way();
  if (!plant_.collect()) {
    const bool keeps_pace = clock_.runs() && clock_.factor() > 0;
    if (keeps_pace && tick_now() >= clock_.deadline() + (holds_ ? Wall::duration::zero() : patience))
      hold(now);
  } else if (was_under_way) {
    take_what_has_come(now);
  } else if (tick_now() >= clock_.deadline()) {
    tick(now);
  }
}

/// What was under way is there: a tick, or what a change at the present time has brought.
void TimeLoop::take_what_has_come(Wall::time_point now) {
  if (!clock_.runs()) {
    clock_.distinguish();
    publish_where_it_stands();
  } else if (plant_.pursuit() && plant_.pursuit()->to > clock_.time()) {
    if (holds_) clock_.hasten(tick_now());
    const double from = clock_.time();
    clock_.arrive();
    go(from, now);
  }
}

/// @return whether the plant is there; else that is under way
bool TimeLoop::tick(Wall::time_point now) {
  const double from = clock_.time();
  const TickClock::Lateness lateness = followed_ ? clock_.follow(tick_now()) : clock_.advance(now);
  status_publisher_.add_late(lateness.late());
  if (lateness.lost > 0) {
    ROS_WARN(
        "%.3g s of wall time are lost: stamps are %.3g s behind since time began to pass (~catch_up makes up "
        "for it)",
        lateness.lost, clock_.lag());
  }
  return go(from, now);
}

/// Reading of the clock by which an input ages [s]. It stands while time stands.
double TimeLoop::input_clock(Wall::time_point now) {
  if (!parameters_.inputs_age_by_wall) return plant_.time();
  if (clock_.runs() && clock_.starts() == last_starts_)
    passed_ += std::chrono::duration<double>(now - last_passed_).count();
  last_passed_ = now;
  last_starts_ = clock_.starts();
  return passed_;
}

bool TimeLoop::go(double from, Wall::time_point now) {
  const double to = clock_.time();
  if (!plant_.advance_to(to)) {
    clock_.wait_at(std::clamp(plant_.time(), from, to));
    return false;
  }
  holds_ = false;
  status_publisher_.add_tick();
  publish(now);
  owner_.publish_markers(now);
  owner_.apply_input(input_clock(now));
  return true;
}

/// Time stands at the last state, which is shown with stamps that go on.
void TimeLoop::hold(Wall::time_point now) {
  holds_ = true;
  status_publisher_.add_late(clock_.hold(tick_now()));
  publish(now);
  owner_.publish_markers(now);
}

/// Interrupts what is under way: the plant and the clock stand where it has come to.
void TimeLoop::stand() {
  plant_.stand();
  if (plant_.time() > clock_.time()) clock_.move_to(plant_.time());
}

void TimeLoop::publish(Wall::time_point now) {
  const ros::Time stamp = present();
  clock_publisher_.publish(stamp, now);
  owner_.publish_state(stamp);
}

void TimeLoop::publish_where_it_stands() {
  const ros::Time stamp = present();
  clock_publisher_.publish_at_once(stamp);
  owner_.publish_state(stamp);
}

}  // namespace hybrid_sphere::ros_interface
