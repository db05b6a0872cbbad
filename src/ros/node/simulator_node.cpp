#include "ros/node/simulator_node.hpp"

#include <algorithm>
#include <utility>

#include "ros/conversions/conversions.hpp"
#include "ros/node/callback_queue_call.hpp"
#include "ros/node/real_time.hpp"

namespace hybrid_sphere::ros_interface {
namespace {

constexpr std::uint32_t unbounded = 0;  // queue of a publisher: nothing is dropped
constexpr std::uint32_t marker_queue = 10;
constexpr std::uint32_t newest_only = 1;
constexpr std::chrono::milliseconds marker_period(40);
constexpr std::chrono::seconds ball_period(2);  // for bags, and for displays that were switched off and on

MapSettings map_settings(const Configuration& configuration) {
  const scene::Scene& scene = configuration.scene;
  return {configuration.node.frames.world,
          scene.sphere.radius,
          configuration.node.grid_threshold,
          scene.forces,
          scene.surface,
          scene.solver,
          Dynamics(Sphere(scene.sphere), scene.forces)};
}

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

ros::NodeHandle with_queue(ros::NodeHandle node, ros::CallbackQueue& queue) {
  node.setCallbackQueue(&queue);
  return node;
}

}  // namespace

SimulatorNode::SimulatorNode(const ros::NodeHandle& node, const Configuration& configuration)
    : paused_(configuration.node.paused),
      clock_mode_(configuration.node.clock),
      resets_on_jump_back_(configuration.node.resets_on_jump_back),
      wait_for_viewer_(std::chrono::round<Wall::duration>(
          std::chrono::duration<double>(configuration.node.wait_for_viewer))),
      realtime_priority_(configuration.node.realtime_priority),
      frames_(configuration.node.frames),
      body_(configuration.scene.sphere),
      node_(with_queue(node, queue_)),
      transformer_(frames_.world, queue_),
      plant_(
          configuration.scene, configuration.node.command_timeout,
          [this](const Switch& event) { pass(event); }, [this] { post(queue_, [] {}); }),
      clock_(configuration.node.adjustable.rate, configuration.node.adjustable.real_time_factor,
             stamp_of_preparation(clock_mode_)),
      clock_publisher_(node_, clock_mode_ == ClockMode::lead, configuration.node.clock_rate),
      state_publisher_(node_, frames_, plant_,
                       [this] {
                         const bool has_no_time = followed_ && !followed_->has_begun();
                         return clock_.runs() || has_no_time ? std::nullopt
                                                             : std::optional<ros::Time>(present());
                       }),
      status_publisher_(node_, plant_, clock_, configuration.node.diagnostics,
                        clock_mode_ == ClockMode::follow),
      markers_(frames_, plant_.sphere(), configuration.node.adjustable.markers),
      reconfigure_(node_, configuration.node.adjustable, queue_,
                   [this](const Adjustable& values) { adjust(values); }),
      rviz_tools_(node_, frames_, transformer_, configuration.node.kick, plant_,
                  {[this](const scene::InitialState& state) { place(state); }, [this] { act_at_once(); }}),
      map_server_(
          node_, map_settings(configuration), plant_.ground(),
          {present(), configuration.scene.initial_state.position, configuration.scene.initial_state.velocity},
          queue_, transformer_,
          [this](const std::shared_ptr<const Ground>& ground, const ErrorEstimate& estimate) {
            return put_in_force(ground, estimate);
          }) {
  markers_.start_at(configuration.scene.initial_state.position);
  switch_message_.header.frame_id = frames_.world;
  advertise();
}

void SimulatorNode::advertise() {
  const auto listener_came = [this](const ros::SingleSubscriberPublisher&) { new_marker_listener_ = true; };
  switch_publisher_ = node_.advertise<ConstraintSwitch>("constraint_switch", unbounded, true);
  markers_publisher_ =
      node_.advertise<visualization_msgs::MarkerArray>("markers", marker_queue, listener_came);
  command_subscriber_ = node_.subscribe("cmd_wrench", newest_only, &SimulatorNode::take_command, this,
                                        ros::TransportHints().tcpNoDelay());
  if (clock_mode_ == ClockMode::follow)
    followed_.emplace(node_, [this](const ros::Time& to) { clock_jumped_back(to); });
  services_ = {node_.advertiseService("set_initial_state", &SimulatorNode::set_initial_state, this),
               node_.advertiseService("set_state", &SimulatorNode::set_state, this),
               node_.advertiseService("get_state", &SimulatorNode::get_state, this),
               node_.advertiseService("kick", &SimulatorNode::kick, this),
               node_.advertiseService("reset", &SimulatorNode::reset, this),
               node_.advertiseService("pause", &SimulatorNode::pause, this),
               node_.advertiseService("step", &SimulatorNode::step, this)};
}

/// The one place where what the loop throws becomes a halt.
template <class Function>
void SimulatorNode::guarded(const Function& function) {
  try {
    function();
  } catch (const StampError&) {
    throw;
  } catch (const std::exception& error) {
    fail(error.what());
  }
}

void SimulatorNode::fail(const std::string& what) { plant_.fail("the node failed: " + what); }

void SimulatorNode::run() {
  if (realtime_priority_ != 0) {
    const std::string refused = enter_real_time(realtime_priority_);
    if (!refused.empty()) ROS_WARN("realtime_priority: the system does not permit %s", refused.c_str());
  }
  guarded([this] { begin(); });
  while (goes_on()) {
    guarded([this] { turn(); });
  }
  plant_.stand();
}

/// Time 0. What went before was preparation.
void SimulatorNode::begin() {
  while (followed_ && !followed_->has_begun() && goes_on()) {
    ROS_INFO_ONCE("waiting for /clock");
    queue_.callAvailable(ros::WallDuration(0.1));
    if (Wall::now() >= status_publisher_.due()) status_publisher_.publish(Wall::now());
  }
  if (followed_) {
    clock_.rebase(followed_->now(), tick_now());
  } else {
    clock_.set_epoch(first_stamp(clock_mode_));
  }
  has_begun_ = true;
  const Wall::time_point now = Wall::now();
  if (!paused_ && wait_for_viewer_ > Wall::duration::zero()) {
    waits_until_ = now + wait_for_viewer_;
  } else if (!paused_) {
    clock_.run(tick_now());
  }
  tick(now);
}

/// Lets time pass, with stamps that are those of a clock that is followed.
void SimulatorNode::let_time_pass() {
  if (followed_ && !clock_.runs()) clock_.go_to_stamp(followed_->now());
  clock_.run(tick_now());
}

/// Time begins when somebody looks, or when it is too late for that.
void SimulatorNode::end_wait(Wall::time_point now) {
  if (!waits_until_ || (markers_publisher_.getNumSubscribers() == 0 && now < *waits_until_)) return;
  waits_until_.reset();
  let_time_pass();
}

/// As after a reset of whoever tells the time.
void SimulatorNode::clock_jumped_back(const ros::Time& to) {
  if (!resets_on_jump_back_) {
    ROS_WARN("/clock has jumped back to %.9f s: the state is held until it is past %.9f s", to.toSec(),
             present().toSec());
    return;
  }
  ROS_WARN("/clock has jumped back to %.9f s: back to the initial state", to.toSec());
  if (!has_begun_) return;
  stand();
  plant_.reset();
  clock_.rebase(to, tick_now());
  start_anew();
}

void SimulatorNode::turn() {
  handle_callbacks_until_due();
  const Wall::time_point now = Wall::now();
  end_wait(now);
  if (now >= status_publisher_.due()) status_publisher_.publish(now);
  if (goes_on()) keep_time(now);
  if (!clock_.runs()) publish_markers(now);
  rviz_tools_.show_handle(!clock_.runs());
}

/// How long the loop has nothing to do, as far as is known.
std::chrono::nanoseconds SimulatorNode::until_due() const {
  constexpr std::chrono::nanoseconds look =
      std::chrono::milliseconds(5);  // at the switches of what is under way
  constexpr std::chrono::nanoseconds longest = std::chrono::milliseconds(100);
  const std::chrono::nanoseconds of_status = status_publisher_.due() - Wall::now();
  if (plant_.under_way()) return std::min(look, of_status);
  if (!followed_) return std::min<std::chrono::nanoseconds>(clock_.deadline() - Wall::now(), of_status);
  return clock_.deadline() <= tick_now() ? std::chrono::nanoseconds::zero() : std::min(longest, of_status);
}

/// A callback may change what is due; as long as time stands, that it stops is looked at now and then.
void SimulatorNode::handle_callbacks_until_due() {
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
void SimulatorNode::keep_time(Wall::time_point now) {
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
void SimulatorNode::take_what_has_come(Wall::time_point now) {
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

/// @return whether the sphere is there; else that is under way
bool SimulatorNode::tick(Wall::time_point now) {
  const double from = clock_.time();
  status_publisher_.add_late((followed_ ? clock_.follow(tick_now()) : clock_.advance(now)).late());
  return go(from, now);
}

bool SimulatorNode::go(double from, Wall::time_point now) {
  const double to = clock_.time();
  if (!plant_.advance_to(to)) {
    clock_.wait_at(std::clamp(plant_.time(), from, to));
    return false;
  }
  holds_ = false;
  status_publisher_.add_tick();
  publish(now);
  publish_markers(now);
  plant_.apply_command(now);
  return true;
}

/// Time stands at the last state, which is shown with stamps that go on.
void SimulatorNode::hold(Wall::time_point now) {
  holds_ = true;
  status_publisher_.add_late(clock_.hold(tick_now()));
  publish(now);
  publish_markers(now);
}

/// Interrupts what is under way: the sphere and the clock stand where it has come to.
void SimulatorNode::stand() {
  plant_.stand();
  if (plant_.time() > clock_.time()) clock_.move_to(plant_.time());
}

void SimulatorNode::publish(Wall::time_point now) {
  const ros::Time stamp = present();
  clock_publisher_.publish(stamp, now);
  state_publisher_.publish(stamp);
}

void SimulatorNode::pass(const Switch& event) {
  ++passed_;
  switch_message_.header.stamp = clock_.stamp(event.time, event.time_remainder);
  fill(event, plant_.sphere().radius(), switch_message_);
  switch_publisher_.publish(switch_message_);
  markers_.add(event, switch_message_.header.stamp);
  switch_log_.add(event);
}

void SimulatorNode::publish_markers(Wall::time_point now) {
  if (now < next_markers_ || markers_publisher_.getNumSubscribers() == 0) return;
  next_markers_ = now + marker_period;
  const bool all = std::exchange(new_marker_listener_, false) || now >= next_ball_;
  if (all) {
    next_ball_ = now + ball_period;
    markers_publisher_.publish(markers_.ball());
  }
  const State* state = plant_.state();
  if (state == nullptr) return;
  markers_publisher_.publish(markers_.update(*state, present(), all, map_server_.view_half()));
  map_server_.keep_in_view(state->position);
}

}  // namespace hybrid_sphere::ros_interface
