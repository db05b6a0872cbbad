#include <algorithm>
#include <cmath>

#include "catalogue/classical.hpp"
#include "catalogue/entry_helpers.hpp"
#include "catalogue/particle_formulas.hpp"
#include "hybrid_sphere/mechanics/system.hpp"

namespace hybrid_sphere::mechanics::catalogue {
namespace visiting_particle_parts {
namespace {

constexpr const char* description =
    R"(The nonholonomic particle whose constraint comes and goes: it holds on every other strip of y that the particle
crosses.

coordinates  x, y, z       place of the particle [m]
L            m (x'^2 + y'^2 + z'^2)/2
Q            none
constraint   "slope", linear: f = z' - y x' = 0, while g = sin(2 pi y/period) > 0

Watch each strip take its toll: while the particle is free its velocity no longer turns with y, so that the next strip
meets it off the constraint again. The impulses get smaller and smaller; a release has none.

known        all of it: y' never changes, so that every switch has its time, and each strip is the motion of
             nonholonomic_particle. Switches at y = j period/2: applied where g rises, released where it falls.
             Not known where it starts on a strip that it does not satisfy, where y' = 0, behind 100,000 strips,
             and where rounding of y is felt, 1e9 strips away from 0.
source       elementary, from the solution of nonholonomic_particle
)";

Model automatic(const Values& values) {
  const double m = values["m"], period = values["period"];
  System<3> particle({"x", "y", "z"}, [m](auto /*t*/, const auto& /*q*/, const auto& v) {
    return m / 2 * (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
  });
  const auto strips = [=](auto /*t*/, const auto& q) {
    using std::sin;
    return sin(2 * M_PI / period * q[1]);
  };
  const auto slope = [](auto /*t*/, const auto& q, const auto& v) { return v[2] - q[1] * v[0]; };
  return particle.constrain("slope", slope, while_positive(strips));
}

Model by_hand(const Values& values) {
  Model model = automatic(values);
  model.equations = particle::equations_by_hand(values["m"]);
  model.constraints[0].function = particle::constraint_by_hand();
  return model;
}

// The strips of y in the order in which the particle meets them. Strip j is j < 2 y/period < j + 1; the
// constraint holds where j is even.
struct Strips {
  double half;       // of the period [m]
  double direction;  // of y', 1 or -1

  double first_from(double y, bool on_border) const {
    if (on_border) return std::round(y / half) - (direction > 0 ? 0 : 1);
    return direction > 0 ? std::floor(y / half) : std::ceil(y / half) - 1;
  }
  double far_border(double strip) const { return half * (direction > 0 ? strip + 1 : strip); }
  static bool holds(double strip) { return std::fmod(strip, 2) == 0; }
};

std::optional<Known> known(double m, double period, bool on_border, const Initial& initial, double t) {
  constexpr double max_strips = 1e5, farthest = 1e9;
  const double rate = initial.v[1];
  if (rate == 0 || t < 0) return std::nullopt;
  const Strips strips{period / 2, std::copysign(1, rate)};
  double strip = strips.first_from(initial.q[1], on_border);
  const double end = initial.q[1] + rate * t;
  // A start on a border may be behind it, by rounding.
  const double ahead = std::max(0.0, strips.direction * (strips.first_from(end, false) - strip));
  const double last = strip + strips.direction * ahead;
  if (ahead > max_strips || std::max(std::abs(strip), std::abs(last)) > farthest) return std::nullopt;
  const double carried = initial.q[1] * initial.v[0];
  const double off = std::abs(initial.v[2] - carried);
  const bool satisfied = off <= 1e-12 * (std::abs(initial.v[2]) + std::abs(carried));
  if (strips.holds(strip) && !on_border && !satisfied) return std::nullopt;
  Known state{initial.q, initial.v, vector({0})};
  for (;; strip += strips.direction) {
    if (strips.holds(strip)) state.v = particle::after_impulse(state.q, state.v);
    const double border = strips.far_border(strip);
    const double time = ((strip == last ? end : border) - state.q[1]) / rate;
    state = strips.holds(strip) ? particle::held(m, state, time)
                                : flight({0, state.q, state.v}, Vector::Zero(3), 1, time);
    if (strip == last) return state;
    state.q[1] = border;
  }
}

Example build(const Values& values) {
  const double m = values["m"], period = values["period"];
  Example example{automatic(values), by_hand(values), {}, {}, {}};
  example.initial = initial_state(example.model, values);
  const bool on_border = side_at_start(example.model, example.initial) == 0;
  example.known = [m, period, on_border, initial = example.initial](double t) {
    return known(m, period, on_border, initial, t);
  };
  example.invariants = {{"y_dot", [](const State& s) { return s.v[1]; }}};
  return example;
}

}  // namespace
}  // namespace visiting_particle_parts

Entry visiting_particle() {
  using namespace visiting_particle_parts;
  const Initial as_a_rule{0, vector({0, -0.4, 0.25}), vector({1, 0.75, 0.5})};
  return {
      "visiting_particle",
      "a particle whose constraint comes and goes with its place",
      description,
      particle::parameters(positive("period", 1, "length of a strip and the gap after it [m]"), as_a_rule),
      6,
      1 / 0.75,
      build};
}

}  // namespace hybrid_sphere::mechanics::catalogue
