#include "judge_systems.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "hybrid_sphere/mechanics/plant.hpp"
#include "hybrid_sphere/mechanics/solve.hpp"
#include "support/random_scenes.hpp"

namespace hybrid_sphere::fuzz {
namespace {

using mechanics::Index;
using mechanics::Solution;
using mechanics::State;
using mechanics::Switch;

constexpr int samples = 200;
constexpr double margin = 1e3;  // errors of a motion that its switches have made larger

mechanics::Options options_of(const RandomSystem& random) {
  mechanics::Options options;
  options.accuracy = random.accuracy;
  options.max_steps = 200000;
  options.max_switches = 300;
  return options;
}

/// Collects claims that do not hold, each with its time and numbers.
class Faults {
 public:
  explicit Faults(std::vector<std::string>& all) : all_(&all) {}
  /// Claims that a value is at most this.
  void at_most(const std::string& what, double time, double value, double most) {
    if (value <= most || all_->size() > 20) return;
    std::ostringstream text;
    text.precision(12);
    text << what << " at t = " << time << ": " << value << " > " << most;
    all_->push_back(text.str());
  }

 private:
  std::vector<std::string>* all_;
};

/// Greatest sizes in a motion.
struct Sizes {
  double energy = 0;
  double speed = 0;
  double reaction = 0;
  double way = 0;
};

Sizes sizes_of(const RandomSystem& random, const std::vector<State>& states) {
  Sizes sizes;
  for (const State& state : states) {
    sizes.energy = std::max({sizes.energy, std::abs(state.energy), state.kinetic_energy});
    sizes.speed = std::max(sizes.speed, state.v.norm());
    sizes.way = std::max(sizes.way, state.q.norm());
    if (state.multipliers.size() > 0) {
      sizes.reaction = std::max(sizes.reaction, state.multipliers.cwiseAbs().maxCoeff());
    }
  }
  sizes.way = std::max(sizes.way, 1.0);
  sizes.energy = std::max({sizes.energy, random.weight.norm() * sizes.way, 1.0});
  sizes.reaction = std::max(sizes.reaction, random.weight.norm() + 1);
  return sizes;
}

std::vector<State> states_of(const Solution& motion) {
  std::vector<State> states;
  for (int i = 0; i <= samples; ++i)
    states.push_back(motion.at(std::min(motion.end(), motion.end() * i / samples)));
  return states;
}

void judge_reactions(const RandomSystem& random, const mechanics::Vector& multipliers, double time,
                     double tolerance, bool impulse, Faults& faults) {
  Index at = 0;
  for (const RandomSystem::Contact& contact : random.contacts) {
    const double normal = multipliers[at++];
    faults.at_most("pull of a contact", time, -normal, tolerance);
    if (contact.slip_components == 0) continue;
    const double across = multipliers.segment(at, contact.slip_components).norm();
    at += contact.slip_components;
    const double mu = impulse ? contact.coefficient : contact.static_coefficient;
    faults.at_most("friction beyond its cone", time, across, mu * std::max(0.0, normal) + tolerance);
  }
  if (!random.friction || impulse) return;
  faults.at_most("friction beyond its limit", time, multipliers.segment(at, 2).norm(),
                 random.friction->coefficient * random.friction->load + tolerance);
}

double gap_of(const RandomSystem::Contact& contact, const mechanics::Vector& q) {
  return contact.normal.dot(q) + contact.offset + contact.wave * std::sin(q[0]);
}

void judge_states(const RandomSystem& random, const std::vector<State>& states, const Sizes& sizes,
                  Faults& faults) {
  const double error = margin * random.accuracy;
  for (const State& state : states) {
    judge_reactions(random, state.multipliers, state.time, error * sizes.reaction, false, faults);
    for (const RandomSystem::Contact& contact : random.contacts) {
      faults.at_most("overlap", state.time, -gap_of(contact, state.q), error * sizes.way);
    }
  }
  if (random.is_driven()) return;
  for (std::size_t i = 0; i + 1 < states.size(); ++i) {
    faults.at_most("energy made", states[i + 1].time, states[i + 1].energy - states[i].energy,
                   error * sizes.energy);
  }
}

void judge_switches(const RandomSystem& random, const Solution& motion, const Sizes& sizes, Faults& faults) {
  const double error = margin * random.accuracy;
  double time = 0;
  const std::vector<Switch>& all = motion.switches();
  double energy = !all.empty() && all[0].time == 0 ? all[0].energy_before : motion.at(0).energy;
  for (const Switch& change : all) {
    faults.at_most("switches in a wrong order", change.time, time, change.time);
    time = change.time;
    faults.at_most("energy made by a switch", time, change.energy_after - change.energy_before,
                   1e-9 * sizes.energy);
    if (!random.is_driven()) {
      faults.at_most("energy made before a switch", time, change.energy_before - energy,
                     error * sizes.energy);
    }
    if (random.keeps_energy_between_switches()) {
      faults.at_most("energy lost before a switch", time, energy - change.energy_before,
                     error * sizes.energy);
    }
    energy = change.energy_after;
    if (change.multipliers.size() == 0) continue;
    const double impulse = std::max(1.0, change.multipliers.cwiseAbs().maxCoeff());
    judge_reactions(random, change.multipliers, time, 1e-9 * impulse, true, faults);
  }
}

double value_of(const RandomSystem::Event& event, const mechanics::Vector& q, const mechanics::Vector& v) {
  return event.normal.dot(event.of_velocities ? v : q) + event.offset;
}

bool counts(mechanics::Crossing crossing, bool rises) {
  return crossing == mechanics::Crossing::either || (crossing == mechanics::Crossing::rising) == rises;
}

/// Between two samples without a switch, an event whose function has another sign has occurred.
void judge_event(const RandomSystem& random, std::size_t index, const Solution& motion,
                 const std::vector<State>& states, const Sizes& sizes, Faults& faults) {
  const RandomSystem::Event& event = random.events[index];
  const double size = event.of_velocities ? sizes.speed + std::abs(event.offset) : sizes.way;
  const double unsure = margin * random.accuracy * std::max(size, 1.0);
  for (std::size_t i = 0; i + 1 < states.size(); ++i) {
    const double before = value_of(event, states[i].q, states[i].v);
    const double after = value_of(event, states[i + 1].q, states[i + 1].v);
    int occurred = 0;
    bool jumps = false;  // another switch may change the sign of a function of velocities
    for (const Switch& change : motion.switches()) {
      if (!(change.time > states[i].time && change.time <= states[i + 1].time)) continue;
      const auto& all = change.events;
      if (std::find(all.begin(), all.end(), index) != all.end()) {
        ++occurred;
        faults.at_most("an event off its zero", change.time,
                       event.of_velocities ? 0 : std::abs(value_of(event, change.q, change.v_before)),
                       unsure);
      }
      jumps = true;
    }
    const bool changes = std::abs(before) > unsure && std::abs(after) > unsure && (before > 0) != (after > 0);
    if (changes && counts(event.crossing, after > 0) && !jumps) {
      faults.at_most("an event that is missed", states[i + 1].time, 1, occurred);
    }
    if (!jumps && occurred > 1) faults.at_most("an event twice", states[i + 1].time, occurred, 1);
  }
}

/// Whether the function of an event is on the other side at a sample of a motion between two of its switches.
bool is_on_other_side(const RandomSystem::Event& event, const Solution& motion, double from, double to) {
  for (int i = 1; i <= samples; ++i) {
    const State state = motion.at(std::min(to, from + (to - from) * i / (samples + 1)));
    const double value = value_of(event, state.q, state.v);
    if (event.crossing == mechanics::Crossing::rising ? value < 0 : value > 0) return true;
  }
  return false;
}

/// One and the same event does not occur twice without a change of the sign between.
void judge_repetitions(const RandomSystem& random, const Solution& motion, Faults& faults) {
  constexpr std::uint64_t most_repetitions = 100;
  for (std::size_t index = 0; index < random.events.size(); ++index) {
    const RandomSystem::Event& event = random.events[index];
    if (event.crossing == mechanics::Crossing::either || event.of_velocities) continue;
    double last = -1;    // occurrence
    double before = -1;  // switch
    bool was_on_other_side = false;
    for (const Switch& change : motion.switches()) {
      if (change.index > most_repetitions) break;
      if (last >= 0 && !was_on_other_side)
        was_on_other_side = is_on_other_side(event, motion, before, change.time);
      before = change.time;
      const auto& all = change.events;
      if (std::find(all.begin(), all.end(), index) == all.end()) continue;
      const bool is_long = change.time - last > 1e-4 * random.duration;
      if (last >= 0 && is_long) {
        faults.at_most("an event again without a change of its sign", change.time, 1,
                       was_on_other_side ? 1 : 0);
      }
      last = change.time;
      was_on_other_side = false;
    }
  }
}

}  // namespace

/// Why a motion may end before its end: resets can follow one another ever faster, as bounces do; a
/// constraint can lead out of the region where it holds, and forces back into it; and sliding friction need
/// not leave any reaction.
bool may_stop(const RandomSystem& random, mechanics::Stop stop) {
  const bool has_reset = std::any_of(random.events.begin(), random.events.end(),
                                     [](const RandomSystem::Event& event) { return event.kept.has_value(); });
  const bool has_edge = random.constraint && random.constraint->guard;
  switch (stop) {
    case mechanics::Stop::reached_end:
    case mechanics::Stop::painleve: return true;
    case mechanics::Stop::livelock: return has_edge;
    case mechanics::Stop::accumulation:
    case mechanics::Stop::too_many_switches: return has_reset || has_edge;
    default: return false;
  }
}

SystemVerdict judge_laws(const RandomSystem& random) {
  const mechanics::System<3> system = system_of(random);
  const Solution motion = solve(system, start_of(random), random.duration, options_of(random));
  SystemVerdict verdict{motion.status(), motion.switches().size(), {}};
  Faults faults(verdict.faults);
  if (!may_stop(random, motion.status().stop)) verdict.faults.push_back(motion.status().message);
  const std::vector<State> states = states_of(motion);
  const Sizes sizes = sizes_of(random, states);
  judge_states(random, states, sizes, faults);
  judge_switches(random, motion, sizes, faults);
  for (std::size_t i = 0; i < random.events.size(); ++i) {
    judge_event(random, i, motion, states, sizes, faults);
  }
  judge_repetitions(random, motion, faults);
  return verdict;
}

SystemVerdict judge_plant(const RandomSystem& random) {
  const mechanics::System<3> system = system_of(random);
  const mechanics::Options options = options_of(random);
  const mechanics::Initial start = start_of(random);
  mechanics::Plant whole(system, start, options, random.duration);
  std::vector<Switch> switches;
  SystemVerdict verdict;
  verdict.status = whole.advance(random.duration, [&](const Switch& change) { switches.push_back(change); });
  verdict.switches = switches.size();
  Faults faults(verdict.faults);

  mechanics::Plant pieces(system, start, options, random.duration);
  std::vector<Switch> others;
  const auto keep = [&](const Switch& change) { others.push_back(change); };
  double time = 0;
  while (time < whole.time()) {
    time = std::min(whole.time(), time + random.duration * testing::integer(1, 64) / 256.0);
    pieces.advance(time, keep);
  }
  const auto differ = [](const State& a, const State& b) { return a.q != b.q || a.v != b.v ? 1.0 : 0.0; };
  faults.at_most("another motion in periods", time, differ(whole.state(), pieces.state()), 0);
  faults.at_most("other switches in periods", time, switches.size() != others.size() ? 1 : 0, 0);

  if (verdict.status.stop != mechanics::Stop::reached_end) return verdict;
  mechanics::Plant first(system, start, options, random.duration);
  first.advance(random.duration * testing::integer(1, 255) / 256.0);
  const mechanics::Plant::Snapshot snapshot = first.save();
  first.restore(snapshot);
  first.advance(random.duration);
  mechanics::Plant second(system, start, options, random.duration);
  second.restore(snapshot);
  second.advance(random.duration);
  faults.at_most("another motion of a second plant put back", random.duration,
                 differ(first.state(), second.state()), 0);
  return verdict;
}

SystemVerdict judge_units(const RandomSystem& random) {
  const auto power = [] { return std::pow(4.0, testing::integer(-8, 8)); };
  Units units;
  units.length = power();
  units.time = power();
  units.mass = power();
  const mechanics::Options options = options_of(random);
  const Solution motion = solve(system_of(random), start_of(random), random.duration, options);
  const Solution other =
      solve(system_of(random, units), start_of(random, units), random.duration * units.time, options);
  SystemVerdict verdict{motion.status(), motion.switches().size(), {}};
  Faults faults(verdict.faults);
  faults.at_most("another end in other units", motion.end(),
                 std::abs(other.end() / units.time - motion.end()), 0);
  faults.at_most("other switches in other units", motion.end(),
                 other.switches().size() != motion.switches().size() ? 1 : 0, 0);
  const State a = motion.at(motion.end());
  const State b = other.at(other.end());
  constexpr double rounding = 1e-12;
  const double size = 1 + a.q.norm() + a.v.norm();
  faults.at_most("another motion in other units", motion.end(),
                 (b.q / units.length - a.q).norm() + (b.v * (units.time / units.length) - a.v).norm(),
                 rounding * size);
  return verdict;
}

}  // namespace hybrid_sphere::fuzz
