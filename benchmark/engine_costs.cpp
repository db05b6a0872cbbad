// Costs of motions of the engine for any system that are dear by their nature: contacts without a force,
// piles, redundant joints, chains of bodies. Prints a Markdown table of what is measured, beside the limits
// that the project sets to itself.
//
//     engine_costs

#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <functional>
#include <stdexcept>
#include <string>

#include "articulated_chain.hpp"
#include "hybrid_sphere/mechanics/multibody_system.hpp"
#include "hybrid_sphere/mechanics/solve.hpp"
#include "hybrid_sphere/mechanics/system.hpp"

namespace {

using namespace hybrid_sphere::mechanics;
using Eigen::Vector3d;

constexpr double gravity = 9.81;
constexpr int hinges = 10;

struct Cost {
  Solution motion;
  double seconds;
};

/// A motion that has to reach its end, and how long its computation takes.
Cost cost_of(const Model& model, const Initial& start, double duration, double accuracy) {
  Options options;
  options.accuracy = accuracy;
  const auto begin = std::chrono::steady_clock::now();
  Solution motion = solve(model, start, duration, options);
  const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - begin;
  if (motion.status().stop != Stop::reached_end) throw std::runtime_error(motion.status().message);
  return {std::move(motion), passed.count()};
}

Cost cost_of(const Model& model, const Initial& start, double duration) {
  return cost_of(model, start, duration, Options().accuracy);
}

/// Two bodies that touch and go along together: no force presses them.
double evaluations_of_a_closed_contact() {
  System<2> pair({"a", "b"}, [](auto, const auto&, const auto& v) { return v.squaredNorm() / 2; });
  pair.unilateral("contact", [](auto, const auto& q) { return q[1] - q[0]; });
  const Cost cost = cost_of(pair, {0, {0, 0}, {1, 1}}, 100);
  return double(cost.motion.evaluations()) / double(cost.motion.steps());
}

/// Newton's cradle: pendulums of small amplitude whose bobs touch at rest; the first one falls on the others.
double evaluations_of_a_cradle() {
  constexpr int count = 5;
  System<count> bobs({"x0", "x1", "x2", "x3", "x4"}, [](auto, const auto& q, const auto& v) {
    return (v.squaredNorm() - q.squaredNorm()) / 2;
  });
  for (int i = 0; i + 1 < count; ++i) {
    bobs.unilateral(
        "contact" + std::to_string(i), [i](auto, const auto& q) { return q[i + 1] - q[i]; }, 1);
  }
  return double(cost_of(bobs, {0, {-1, 0, 0, 0, 0}, {0, 0, 0, 0, 0}}, 8).motion.evaluations());
}

constexpr int disc_count = 4;
constexpr double radius = 0.5;
constexpr double box_width = 2.6;
using Discs = System<3 * disc_count>;

/// The contact of disc i with a wall, and its friction. @param wall  "floor", "left" or "right"
void add_wall(Discs& discs, const std::string& wall, int i, double restitution, double mu) {
  const std::string name = wall + std::to_string(i);
  const int across = wall == "floor" ? 3 * i + 1 : 3 * i;
  const int along = wall == "floor" ? 3 * i : 3 * i + 1;
  const double sign = wall == "right" ? -1 : 1;
  const double spin = wall == "left" ? -radius : radius;
  const double place = wall == "right" ? -box_width : 0;
  discs
      .unilateral(
          name, [=](auto, const auto& q) { return sign * q[across] - place - radius; }, restitution)
      .friction(
          "friction of " + name,
          [=](auto, const auto&, const auto& v) { return v[along] + spin * v[3 * i + 2]; }, mu, name);
}

void add_pair(Discs& discs, int i, int j, double restitution, double mu) {
  const std::string name = "pair" + std::to_string(i) + std::to_string(j);
  discs
      .unilateral(
          name,
          [=](auto, const auto& q) {
            using std::sqrt;
            const auto x = q[3 * i] - q[3 * j];
            const auto z = q[3 * i + 1] - q[3 * j + 1];
            return sqrt(x * x + z * z) - 2 * radius;
          },
          restitution)
      .friction(
          "friction of " + name,
          [=](auto, const auto& q, const auto& v) {
            using std::sqrt;
            const auto x = q[3 * i] - q[3 * j];
            const auto z = q[3 * i + 1] - q[3 * j + 1];
            const auto slip = (v[3 * i + 1] - v[3 * j + 1]) * x - (v[3 * i] - v[3 * j]) * z;
            return slip / sqrt(x * x + z * z) - radius * (v[3 * i + 2] + v[3 * j + 2]);
          },
          mu, name);
}

/// Four discs of 1 kg that fall into a box and come to rest in it.
double seconds_of_discs() {
  constexpr double restitution = 0.3, mu = 0.3;
  std::array<std::string, std::size_t(3 * disc_count)> names;
  for (std::size_t i = 0; i < names.size(); ++i) names[i] = "q" + std::to_string(i);
  Discs discs(names, [](auto, const auto& q, const auto& v) {
    auto lagrangian = 0 * v[0];
    for (int i = 0; i < disc_count; ++i) {
      const auto& spin = v[3 * i + 2];
      lagrangian +=
          (v[3 * i] * v[3 * i] + v[3 * i + 1] * v[3 * i + 1] + radius * radius / 2 * spin * spin) / 2 -
          gravity * q[3 * i + 1];
    }
    return lagrangian;
  });
  constexpr Index size = Index(3) * disc_count;
  Initial start{0, Vector::Zero(size), Vector::Zero(size)};
  constexpr std::array<double, disc_count> aside = {0.041, 0.067, 0.034, 0.015};  // arbitrary
  for (int i = 0; i < disc_count; ++i) {
    for (const char* wall : {"floor", "left", "right"}) add_wall(discs, wall, i, restitution, mu);
    for (int j = 0; j < i; ++j) add_pair(discs, i, j, restitution, mu);
    const Index x = Index(3) * i;
    const int column = i % 2;
    const int row = i / 2;
    start.q[x] = 0.55 + 1.45 * column + aside[std::size_t(i)];
    start.q[x + 1] = 0.6 + 1.05 * row + 0.01 * i;
  }
  return cost_of(discs, start, 3).seconds;
}

/// Five bars in a closed chain of six hinges, of which one is redundant: benchmark A04 of the IFToMM library.
double seconds_of_bricard() {
  const std::array<Vector3d, 6> places = {Vector3d(0, 0, 0),  Vector3d(1, 0, 0),  Vector3d(1, -1, 0),
                                          Vector3d(1, -1, 1), Vector3d(0, -1, 1), Vector3d(0, 0, 1)};
  const std::array<Vector3d, 6> axes = {Vector3d::UnitY(), Vector3d::UnitZ(), Vector3d::UnitX(),
                                        Vector3d::UnitY(), Vector3d::UnitZ(), Vector3d::UnitX()};
  MultibodySystem system(Vector3d(0, -gravity, 0));
  std::string previous = "world";
  for (std::size_t i = 0; i < 5; ++i) {
    Eigen::Isometry3d placement(
        Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitX(), places[i + 1] - places[i]));
    placement.pretranslate((places[i] + places[i + 1]) / 2);
    const std::string bar = "bar" + std::to_string(i);
    system.body(bar, 1, {0.02 / 12, 1.01 / 12, 1.01 / 12}, placement)
        .hinge("hinge" + std::to_string(i), previous, bar, places[i], axes[i]);
    previous = bar;
  }
  system.hinge("closure", previous, "world", places[5], axes[5]);
  return cost_of(system, system.initial(), 10, 1e-6).seconds;
}

/// Microseconds of an evaluation of a chain of bars that falls from the level, as one of the motion and by
/// the recursive algorithm.
std::array<double, 2> microseconds_of_a_chain() {
  const engine_costs::ArticulatedChain recursive(hinges, gravity);
  const double along = recursive.inertia.x(), across = recursive.inertia.y();
  MultibodySystem system(Vector3d(0, 0, -gravity));
  std::string previous = "world";
  for (int i = 0; i < hinges; ++i) {
    const std::string bar = "bar" + std::to_string(i);
    system.body(bar, recursive.mass, {along, across, across}, Vector3d(i + 0.5, 0, 0))
        .hinge("hinge" + std::to_string(i), previous, bar, Vector3d(i, 0, 0), Vector3d::UnitY());
    previous = bar;
  }
  const Cost cost = cost_of(system, system.initial(), 1, 1e-6);
  return {1e6 * cost.seconds / double(cost.motion.evaluations()), 1e6 * recursive.seconds_of_an_evaluation()};
}

/// The least of a few runs: others use the machine, too.
double least_of(const std::function<double()>& measure) {
  constexpr int runs = 3;
  double least = measure();
  for (int i = 1; i < runs; ++i) least = std::min(least, measure());
  return least;
}

void print(const char* what, double value, const char* limit) {
  std::printf("| %s | %.3g | %s |\n", what, value, limit);
}

}  // namespace

int main() {
  std::printf("| what | measured | limit |\n| --- | --- | --- |\n");
  print("evaluations in a step of two bodies that touch without a force", evaluations_of_a_closed_contact(),
        "30");
  std::printf("| evaluations of Newton's cradle of five, 8 s | %.0f | 2000 |\n", evaluations_of_a_cradle());
  print("four discs in a box with friction, 3 s [s]", least_of(seconds_of_discs), "1");
  print("Bricard's mechanism, 10 s at 1e-6 [s]", least_of(seconds_of_bricard), "0.5");
  std::array<double, 2> chain = microseconds_of_a_chain();
  for (int i = 0; i < 2; ++i) {
    const std::array<double, 2> again = microseconds_of_a_chain();
    for (std::size_t k = 0; k < 2; ++k) chain[k] = std::min(chain[k], again[k]);
  }
  print("an evaluation of a chain of ten hinges [us]", chain[0], "40");
  print("the same, relative to the recursive algorithm", chain[0] / chain[1], "3");
}
