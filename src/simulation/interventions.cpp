// What comes from outside at time(): a state, a ground, a wrench, an accuracy, an impulse
// (docs/theory.md 5.2, rule 9).
#include <cfloat>
#include <cmath>
#include <iomanip>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>

#include "hybrid_sphere/simulation/simulation.hpp"

namespace hybrid_sphere {
namespace {

constexpr double largest_acceleration = 1e15;  // as in a scene [m/s^2, 1/s^2]
constexpr double largest_kick = 1e15;          // [m/s]
constexpr double largest_number = 1e15;        // of an initial state [m, m/s, rad/s]

[[noreturn]] void refuse(const std::string& what, const char* allowed) {
  throw std::invalid_argument(what + " is refused; allowed: " + allowed);
}

}  // namespace

void Simulation::set_initial_state(const scene::InitialState& initial_state) {
  const auto is_within = [](const auto& vector) {
    return (vector.cwiseAbs().array() <= largest_number).all();
  };
  if (!is_within(initial_state.position) || !is_within(initial_state.velocity) ||
      !is_within(initial_state.angular_velocity) || !initial_state.orientation.coeffs().allFinite()) {
    refuse("set_initial_state: a number that no scene can have",
           "up to 1e15 m, m/s and rad/s in each component, and a finite orientation");
  }
  if (initial_state.orientation.coeffs().isZero(0)) {
    refuse("set_initial_state: the orientation (0, 0, 0, 0)", "quaternions other than 0");
  }
  initial_state_ = initial_state;
  Quaterniond& orientation = initial_state_.orientation;
  if (!(std::abs(orientation.squaredNorm() - 1) <= 4 * DBL_EPSILON)) orientation.coeffs().stableNormalize();
  now_ = 0;
  switches_ = 0;
  fastest_ = 0;
  halted_.reset();
  kick_.setZero();
  constraint_ = {};
  region_ = partner_ = no_region;
  ahead_ = Ahead::known;
  state_.region = {};
  mode_ = ContactMode::free;
  const Twist twist{initial_state.velocity, initial_state.angular_velocity};
  segment_.forget_errors();
  place(Cause::placed);
  detach({initial_state.position, orientation, twist, sphere_.contact_velocity(twist)});
  schedule(0);
}

/// The ground under the sphere has yet to act.
void Simulation::place(Cause cause) {
  slow_zeno_.begin(now_);
  standstill_.begin();
  zeno_.clear();
  limit_.reset();
  comes_ = false;
  limit_passed_at_ = -1;
  ended_at_once_ = 0;
  thrown_.reset();
  on_ground_ = false;
  placing_ = cause;
}

void Simulation::set_ground(std::shared_ptr<const Ground> ground) {
  check_method(ground->surface(), command_);
  reserve_contacts(*ground);
  edge_events_.set_ground(ground);
  // The state speaks of the ground that acted last, also when a second map comes before the first one has
  // acted; where none has, a halt has named the one under the sphere.
  if (halted_ && region_ == no_region && named_by_ == ground_) state_.region = {};
  ground_ = std::move(ground);
  halted_.reset();
  state_is_held_ = detached_;
  region_ = partner_ = no_region;
  ahead_ = Ahead::known;
  place(Cause::placed);
  schedule(now_);
}

void Simulation::set_command(const scene::Wrench& command) {
  if (command.force == command_.force && command.torque == command_.torque) return;
  const double inertia = sphere_.mass() * sphere_.gyration_radius() * sphere_.gyration_radius();
  const bool is_allowed = (command.force.cwiseAbs().array() <= largest_acceleration * sphere_.mass()).all() &&
                          (command.torque.cwiseAbs().array() <= largest_acceleration * inertia).all();
  if (!is_allowed) {
    std::ostringstream wrench;
    wrench << std::setprecision(DBL_DECIMAL_DIG) << "set_command: force (" << command.force.x() << ", "
           << command.force.y() << ") N, torque (" << command.torque.x() << ", " << command.torque.y() << ", "
           << command.torque.z() << ") N m";
    refuse(wrench.str(), "up to 1e15 m and 1e15 m k^2 in each component");
  }
  check_method(ground_->surface(), command);
  command_ = command;
  restart();
}

void Simulation::set_accuracy(double accuracy) {
  if (!(accuracy >= 1e-14 && accuracy <= 1)) {
    refuse("set_accuracy: " + std::to_string(accuracy), "numbers from 1e-14 to 1");
  }
  if (accuracy == segment_.solver().accuracy) return;
  segment_.set_accuracy(accuracy);
  if (segment_.integrates()) restart();
}

/// Something in the motion is another from now on.
void Simulation::restart() {
  new_forces_ = true;
  if (on_ground_) {
    if (epoch_.until(now_) > 0) edge_events_.pass_without_crossing();
    place(Cause::grip_lost);
  }
  schedule(now_);
}

void Simulation::kick(const Vector2d& impulse) {
  const Vector2d change = impulse / sphere_.mass();
  if (!(change.norm() <= largest_kick)) {
    std::ostringstream message;
    message << std::setprecision(DBL_DECIMAL_DIG) << "kick: (" << impulse.x() << ", " << impulse.y()
            << ") is refused; allowed: finite impulses that change the velocity by " << largest_kick
            << " m/s at most [N s]";
    throw std::invalid_argument(message.str());
  }
  if (halted_) throw HaltedError(*halted_);
  if (change.isZero(0)) return;
  kick_ += change;
  if (on_ground_) {
    if (epoch_.until(now_) > 0) edge_events_.pass_without_crossing();
    place(Cause::kicked);
  }
  schedule(now_);
}

/// The velocities right after the impulse, before the ground has acted.
void Simulation::strike(Arrival& arrival) {
  arrival.state.twist.velocity += kick_;
  arrival.state.contact_velocity += kick_;
  arrival.struck = arrival.restarts = true;
  kick_.setZero();
}

/// On the ground in force or, where the sphere is on an edge, on the one into which the impulse sends it.
/// @param before  as it was before the impulse
void Simulation::go_on_kicked(Arrival& arrival, const Segment::Start& before, const SwitchSink& on_switch) {
  arrival.cause = Cause::kicked;
  if (partner_ != no_region && stays_on_edge(arrival.state) &&
      slide_along_edge(slid_along_, arrival, on_switch)) {
    return;
  }
  const SplitTime instant = arrival.tau > 0 ? SplitTime{next_instant_, 0} : epoch_;
  begin_free(instant, arrival, before);
}

/// Whether the two grounds of an edge slide throw the sphere at each other still: docs/theory.md 5.4.
bool Simulation::stays_on_edge(const Segment::Start& kicked) const {
  const Vector2d conserved = sphere_.conserved_velocity(kicked.twist);
  const auto across = [&](RegionId region) {
    return (conserved + sphere_.kappa() * ground_->material(region).belt).dot(slid_along_.normal);
  };
  return across(region_) < 0 && across(partner_) > 0;
}

}  // namespace hybrid_sphere
