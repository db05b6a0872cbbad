#include "hybrid_sphere/simulation/simulation.hpp"

#include <algorithm>
#include <utility>

#include "simulation/event_loop.hpp"

namespace hybrid_sphere {

static_assert(Simulation::max_time == max_time);

std::shared_ptr<const Ground> prepare_ground(const scene::Surface& surface) {
  return std::make_shared<const Ground>(surface);
}

Simulation::Simulation(const scene::Scene& scene) : loop_(std::make_unique<EventLoop>(scene, outlook_)) {}
Simulation::~Simulation() = default;

void Simulation::advance_over_instants(double time, const SwitchSink& on_switch) {
  loop_->advance_to(time, on_switch);
}

const State& Simulation::state() {
  const ConstantTwist* motion = outlook_.motion;
  if (motion == nullptr) return loop_->state();
  const SplitTime epoch{outlook_.epoch, outlook_.epoch_remainder};
  const double tau = std::max(0.0, epoch.until(outlook_.now));
  State& state = outlook_.state;
  state.time = outlook_.now;
  state.position = motion->position(tau);
  state.orientation = motion->orientation(tau);
  return state;
}

void Simulation::states(const std::vector<double>& times, std::vector<State>& out,
                        const SwitchSink& on_switch) {
  out.clear();
  out.reserve(times.size());
  for (const double time : times) {
    advance_to(time, on_switch);
    out.push_back(state());
  }
}

Status Simulation::status() const { return loop_->status(); }
Vector3d Simulation::reaction() { return loop_->reaction(); }
std::uint64_t Simulation::switches() const { return loop_->switches(); }
std::uint64_t Simulation::evaluations() const { return loop_->hybrid().segment.evaluations(); }
double Simulation::estimated_error() const { return loop_->hybrid().segment.estimated_error(); }
void Simulation::set_interrupt(std::function<bool()> should_stop) {
  loop_->set_interrupt(std::move(should_stop));
}
void Simulation::set_region_sink(RegionSink on_region) { loop_->set_region_sink(std::move(on_region)); }
void Simulation::set_initial_state(const scene::InitialState& initial_state) {
  loop_->set_initial_state(initial_state);
}
void Simulation::set_state(const scene::InitialState& state) { loop_->set_state(state); }
void Simulation::reset() { loop_->reset(); }
void Simulation::set_ground(std::shared_ptr<const Ground> ground) { loop_->set_ground(std::move(ground)); }
void Simulation::set_command(const scene::Wrench& command) { loop_->set_command(command); }
void Simulation::set_accuracy(double accuracy) { loop_->set_accuracy(accuracy); }
void Simulation::follow_orientation(bool follow) { loop_->follow_orientation(follow); }
void Simulation::kick(const Vector2d& impulse) { loop_->kick(impulse); }
const scene::Surface& Simulation::surface() const { return loop_->hybrid().ground->surface(); }
std::shared_ptr<const Ground> Simulation::ground() const { return loop_->hybrid().ground; }
const Sphere& Simulation::sphere() const { return loop_->hybrid().sphere; }

}  // namespace hybrid_sphere
