// Linkages that pass, or end at, positions at which their constraints lose rank: energy is never lost.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "hybrid_sphere/mechanics/solve.hpp"
#include "hybrid_sphere/mechanics/system.hpp"

namespace hybrid_sphere::mechanics::singular_position_test {
namespace {

constexpr double gravity = 9.81;

/// Two cranks with unit masses at their ends, at a distance of `base`, and a rod of this length between the
/// ends. With equal cranks it is a parallelogram, which loses rank when all bars lie on one line.
struct Linkage {
  double first, second, base;

  System<2> system() const {
    const Linkage l = *this;
    return System<2>({"a", "b"},
                     [l](auto, const auto& q, const auto& v) {
                       using std::cos;
                       return (l.first * l.first * v[0] * v[0] + l.second * l.second * v[1] * v[1]) / 2 -
                              gravity * (l.first * cos(q[0]) + l.second * cos(q[1]));
                     })
        .holonomic(
            "rod",
            [l](auto, const auto& q) {
              using std::cos;
              using std::sin;
              const auto x = l.base + l.second * sin(q[1]) - l.first * sin(q[0]);
              const auto y = l.second * cos(q[1]) - l.first * cos(q[0]);
              return x * x + y * y - l.base * l.base;
            },
            always());
  }
};

/// The largest change of the energy, relative to the largest kinetic energy.
double energy_error(const Solution& motion) {
  constexpr int samples = 200;
  double error = 0;
  double kinetic = 0;
  const double start = motion.at(0).energy;
  for (int i = 0; i <= samples; ++i) {
    const State state = motion.at(std::min(motion.end(), motion.end() * i / samples));
    error = std::max(error, std::abs(state.energy - start));
    kinetic = std::max(kinetic, state.kinetic_energy);
  }
  return error / kinetic;
}

class SingularPosition : public ::testing::TestWithParam<double> {
 protected:
  void expect_no_loss(const Linkage& linkage, double angle, double speed) const {
    Options options;
    options.accuracy = GetParam();
    const Solution motion = solve(linkage.system(), {0, {angle, angle}, {speed, speed}}, 3, options);
    constexpr double roundoff = 1e-12;  // of the energy, over some hundred steps
    EXPECT_LE(energy_error(motion), 10 * GetParam() + roundoff)
        << motion.status().message << "; angle " << angle << ", speed " << speed;
    EXPECT_LT(motion.steps(), 2000u);
  }
};

TEST_P(SingularPosition, OfAParallelogramTakesNoEnergy) {
  expect_no_loss({1, 1, 1}, 0, 1);  // the smallest form of benchmark A02 of the IFToMM library
}

TEST_P(SingularPosition, OfRandomParallelogramsTakesNoEnergy) {
  std::mt19937 random(11);
  const auto draw = [&](double least, double most) {
    return std::uniform_real_distribution<>(least, most)(random);
  };
  for (int i = 0; i < 10; ++i) {
    const double crank = draw(0.5, 2);
    expect_no_loss({crank, crank, draw(0.5, 2)}, draw(-1, 1), draw(-5, 5));
  }
}

INSTANTIATE_TEST_SUITE_P(AtEachAccuracy, SingularPosition,
                         ::testing::Values(1e-3, 1e-6, 1e-9, 1e-10, 1e-11, 1e-12, 1e-13));

}  // namespace
}  // namespace hybrid_sphere::mechanics::singular_position_test
