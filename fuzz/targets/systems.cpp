// Small Lagrangian systems whose coefficients are made of the bytes: solve() ends with a status, finite.

#include <cmath>

#include "draw_bytes.hpp"
#include "hybrid_sphere/mechanics/solve.hpp"
#include "hybrid_sphere/mechanics/system.hpp"
#include "support/random_scenes.hpp"
#include "target.hpp"

namespace {

using namespace hybrid_sphere;
using namespace hybrid_sphere::mechanics;
using testing::integer;

double coefficient() { return integer(-16, 16) / 8.0; }

/// Of what the functions are made.
struct Coefficients {
  double c[12];
  Coefficients() {
    for (double& x : c) x = coefficient();
  }
};

System<2> draw_system() {
  const Coefficients k;
  const auto lagrangian = [k](auto t, const auto& q, const auto& v) {
    using std::cos;
    const auto mass = 1.5 + std::abs(k.c[0]) + k.c[1] * cos(q[0]) / 4;
    return mass * v[0] * v[0] / 2 + (1 + k.c[2] * k.c[2]) * v[1] * v[1] / 2 + k.c[3] * v[0] * v[1] / 4 -
           k.c[4] * q[0] * q[0] / 2 - k.c[5] * cos(q[1]) - k.c[6] * q[0] * q[1] + k.c[7] * q[1] * cos(t);
  };
  const auto forces = [k](auto, const auto&, const auto& v) {
    return (-std::abs(k.c[8]) * v - k.c[9] * v * v.squaredNorm() / 8).eval();
  };
  return System<2>({"x", "y"}, lagrangian, forces);
}

void draw_constraint(System<2>& system, int number) {
  const Coefficients k;
  const auto function = [k](auto t, const auto& q, const auto& v) {
    using std::cos;
    return (k.c[0] + q[0] * k.c[1]) * v[0] + (k.c[2] + k.c[3] * cos(q[1])) * v[1] + k.c[4] * cos(t) +
           k.c[5] * (v[0] * v[0] + v[1] * v[1] - 1) / 4;
  };
  const std::string name = "constraint_" + std::to_string(number);
  const double begin = integer(0, 8) / 8.0;
  switch (integer(0, 3)) {
    case 0: system.constrain(name, function, always()); break;
    case 1: system.constrain(name, function, from(begin)); break;
    case 2: system.constrain(name, function, between(begin, begin + integer(0, 8) / 8.0)); break;
    default:
      system.constrain(name, function, while_positive([k](auto t, const auto& q) {
                         return k.c[6] * q[0] + k.c[7] * q[1] + k.c[8] + k.c[9] * t;
                       }));
  }
}

bool is_finite(const mechanics::State& state) {
  return std::isfinite(state.time) && state.q.allFinite() && state.v.allFinite() &&
         state.multipliers.allFinite();
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::draw_from(data, size);
  System<2> system = draw_system();
  for (int i = integer(0, 2); i > 0; --i) draw_constraint(system, i);
  Initial initial;
  initial.q = Eigen::Vector2d(coefficient(), coefficient());
  initial.v = Eigen::Vector2d(coefficient(), coefficient());
  Options options;
  options.project_initial = integer(0, 1) == 1;
  options.accuracy = std::pow(10.0, -integer(2, 10));
  options.max_steps = 300;
  options.max_switches = 50;
  const double duration = integer(0, 8) / 8.0;
  try {
    const Solution motion = solve(system, initial, duration, options);
    const double end = motion.end();
    if (!(end >= 0 && end <= duration)) fuzz::found("a motion ends within its duration");
    for (int i = 0; i <= 8; ++i)
      if (!is_finite(motion.at(end * i / 8))) fuzz::found("every state is finite");
    double time = 0;
    for (const mechanics::Switch& event : motion.switches()) {
      if (!(event.time >= time)) fuzz::found("switches come in the order of time");
      time = event.time;
    }
  } catch (const std::invalid_argument&) {
  }
  return 0;
}
