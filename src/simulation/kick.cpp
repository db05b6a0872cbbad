// An impulse from outside: docs/theory.md 5.2, rule 9.
#include <cfloat>
#include <iomanip>
#include <sstream>
#include <stdexcept>

#include "hybrid_sphere/simulation/simulation.hpp"

namespace hybrid_sphere {

void Simulation::kick(const Vector2d& impulse) {
  const Vector2d change = impulse / sphere_.mass();
  if (!(change.norm() <= largest_speed)) {
    std::ostringstream message;
    message << std::setprecision(DBL_DECIMAL_DIG) << "kick: (" << impulse.x() << ", " << impulse.y()
            << ") is refused; allowed: finite impulses that change the velocity by " << largest_speed
            << " m/s at most [N s]";
    throw std::invalid_argument(message.str());
  }
  if (halted_) throw HaltedError(*halted_);
  if (change.isZero(0)) return;
  kick_ += change;
  if (on_ground_) {
    if (epoch_.until(now_) > 0) itinerary_.stand();
    place(Cause::kicked);
  }
  expect(now_);
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
void Simulation::go_on_kicked(Arrival& arrival, const Stretch::Start& before, const SwitchSink& on_switch) {
  arrival.cause = Cause::kicked;
  if (partner_ != no_region && stays_on_edge(arrival.state) &&
      slide_along_edge(slid_along_, arrival, on_switch)) {
    return;
  }
  const Epoch instant = arrival.tau > 0 ? Epoch{next_instant_, 0} : epoch_;
  begin_free(instant, arrival, before);
}

/// Whether the two grounds of an edge slide throw the sphere at each other still: docs/theory.md 5.4.
bool Simulation::stays_on_edge(const Stretch::Start& kicked) const {
  const Vector2d conserved = sphere_.conserved_velocity(kicked.twist);
  const auto across = [&](RegionId region) {
    return (conserved + sphere_.kappa() * ground_->material(region).belt).dot(slid_along_.normal);
  };
  return across(region_) < 0 && across(partner_) > 0;
}

}  // namespace hybrid_sphere
