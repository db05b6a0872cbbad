#include "hybrid_sphere/simulation/simulation.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

namespace hybrid_sphere {
namespace {

Stage stage_of(scene::Law constraint) {
  return constraint == scene::Law::smooth ? Stage::holonomic : Stage::nonholonomic;
}

}  // namespace

Simulation::Epoch Simulation::Epoch::plus(double tau) const {
  const double sum = value + tau;
  const double back = sum - value;
  const double lost = (value - (sum - back)) + (tau - back);
  const double small = rest + lost;
  const double rounded = sum + small;
  return {rounded, small - (rounded - sum)};
}

Simulation::Simulation(const scene::Scene& scene)
    : sphere_(scene.sphere), ground_(std::make_shared<const Ground>(scene.surface)), itinerary_(ground_) {
  set_initial_state(scene.initial_state);
}

void Simulation::set_initial_state(const scene::InitialState& initial_state) {
  initial_state_ = initial_state;
  now_ = 0;
  switches_ = 0;
  constraint_ = scene::Law::smooth;
  region_ = no_region;
  state_.region = {};
  const Twist twist{initial_state.velocity, initial_state.angular_velocity};
  sigma_ = sphere_.contact_velocity(twist);
  epoch_ = {};
  motion_ = UniformMotion(initial_state.position, initial_state.orientation, twist);
  on_ground_ = false;
  next_instant_ = 0;
  update_state();
}

void Simulation::set_surface(const scene::Surface& surface) {
  auto ground = std::make_shared<const Ground>(surface);
  itinerary_.set_ground(ground);
  // The state speaks of the ground that acted last, also when a second map comes before the first one has
  // acted.
  if (on_ground_) left_ground_ = ground_;
  ground_ = std::move(ground);
  region_ = no_region;
  on_ground_ = false;
  next_instant_ = now_;
}

void Simulation::advance_over_switches(double time, const SwitchSink& on_switch) {
  if (!(time >= now_) || std::isinf(time)) {
    throw std::invalid_argument("advance_to(" + std::to_string(time) +
                                "): allowed is a finite time >= " + std::to_string(now_));
  }
  while (next_instant_ <= time) {
    if (on_ground_) {
      pass_instant(on_switch);
    } else {
      put_on_ground(on_switch);
    }
  }
  now_ = time;
}

void Simulation::update_state() {
  state_.twist = motion_.twist();
  state_.slip = sigma_;
  state_.stage = stage_of(constraint_);
  state_.mode = constraint_ == scene::Law::smooth                                            ? Mode::free
                : state_.twist.velocity.isZero(0) && state_.twist.angular_velocity.isZero(0) ? Mode::resting
                                                                                             : Mode::rolling;
}

void Simulation::begin_stretch(const Epoch& epoch, const UniformMotion& motion, const Contacts& contacts) {
  epoch_ = epoch;
  motion_ = motion;
  itinerary_.begin(motion.start(), motion.twist().velocity, contacts);
}

void Simulation::put_on_ground(const SwitchSink& on_switch) {
  const double tau = std::max(0.0, epoch_.until(next_instant_));
  begin_stretch({next_instant_, 0},
                UniformMotion(motion_.position(tau), motion_.orientation(tau), motion_.twist()), {});
  on_ground_ = true;
  enter(itinerary_.forward_region(no_region), 0, motion_.start(), {}, on_switch);
  left_ground_.reset();
  schedule();
}

void Simulation::pass_instant(const SwitchSink& on_switch) {
  const double tau = itinerary_.next_instant();
  itinerary_.pass_instant();
  const RegionId region = itinerary_.forward_region(region_);
  if (region != region_) {
    enter(region, tau, itinerary_.settle(motion_.position(tau)), itinerary_.contacts(), on_switch);
  }
  schedule();
}

void Simulation::enter(RegionId region, double tau, const Vector2d& position, const Contacts& contacts,
                       const SwitchSink& on_switch) {
  for (;;) {
    const Twist before = motion_.twist();
    const scene::Law law = ground_->law(region);
    const Vector2d slip = law == scene::Law::rough ? sigma_ : Vector2d::Zero();
    const bool stops = slip != Vector2d::Zero();
    const Epoch instant = epoch_.plus(tau);
    if (stops) {
      const Twist after =
          sphere_.rolling_twist(sphere_.conserved_velocity(before), before.angular_velocity.z());
      sigma_ = Vector2d::Zero();
      begin_stretch(instant, UniformMotion(position, motion_.orientation(tau), after), contacts);
      tau = 0;
    }
    const std::string_view from = std::exchange(state_.region, ground_->name(region));
    region_ = region;
    const bool changes_constraint = law != std::exchange(constraint_, law);
    update_state();
    if (changes_constraint) report(instant.value, from, position, before, slip, on_switch);
    if (!stops) return;
    // Thrown back, the sphere is in another region at once: docs/theory.md 5.2, rule 6. It does not slip any
    // more, so that nothing can stop it a second time.
    region = itinerary_.forward_region(region_);
    if (region == region_) return;
  }
}

void Simulation::report(double time, std::string_view from, const Vector2d& position, const Twist& before,
                        const Vector2d& slip, const SwitchSink& on_switch) {
  Switch event;
  event.index = switches_++;
  event.time = time;
  event.to_stage = stage_of(constraint_);
  event.from_stage = event.to_stage == Stage::holonomic ? Stage::nonholonomic : Stage::holonomic;
  event.kind = event.to_stage == Stage::nonholonomic ? SwitchKind::applied : SwitchKind::released;
  event.from_region = from;
  event.to_region = state_.region;
  event.position = position;
  event.slip_before = slip;
  event.impulse = sphere_.stopping_impulse(slip);
  event.angular_impulse = sphere_.angular_impulse(event.impulse);
  event.before = before;
  event.after = motion_.twist();
  event.energy_before = sphere_.kinetic_energy(before);
  event.energy_after = sphere_.kinetic_energy(event.after);
  if (on_switch) on_switch(event);
}

void Simulation::schedule() {
  const double tau = itinerary_.next_instant();
  next_instant_ = std::isinf(tau) ? tau : epoch_.plus(tau).value;
}

}  // namespace hybrid_sphere
