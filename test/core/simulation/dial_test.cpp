// The dial: at every output the error is at most the accuracy asked for, relative to the scale of motion, for
// every scene with a solution in high precision.

#include <gtest/gtest.h>

#include <cfloat>
#include <cmath>

#include "hybrid_sphere/simulation/simulation.hpp"
#include "scene/read_tree.hpp"
#include "scene/yaml.hpp"
#include "support/dial.hpp"

namespace hybrid_sphere::testing::dial_test {
namespace {

using Method = scene::Solver::Method;

struct Promise {
  Method method;
  double accuracy;
  std::size_t stride;  // of the scenes: all for the method that is taken as a rule
};

std::ostream& operator<<(std::ostream& out, const Promise& promise) {
  return out << to_string(promise.method) << " at " << promise.accuracy;
}

const std::vector<SolvedScene>& all_scenes() {
  static const std::vector<SolvedScene> scenes = solved_scenes();
  return scenes;
}

// The estimate is the sum of what the steps err; how such errors grow or cancel along the way it does not
// know.
double largest_error(const Delivered& delivered) {
  constexpr double growth = 25;
  return growth * delivered.estimate + 16 * DBL_EPSILON;
}

/// A method of third order takes some 1e5 steps at 1e-9 for each revolution on a turntable. The scene of a
/// hundred revolutions is left to its looser accuracies and to the methods of higher order.
bool takes_millions_of_steps(const SolvedScene& solved, const Promise& promise) {
  return promise.method == Method::arkode_erk3 && promise.accuracy < 1e-8 &&
         solved.name == "e21_revolutions_100";
}

class Dial : public ::testing::TestWithParam<Promise> {};

TEST_P(Dial, DeliversTheAccuracyAskedFor) {
  const Promise promise = GetParam();
  std::size_t seen = 0;
  for (std::size_t i = 0; i < all_scenes().size(); i += promise.stride) {
    const SolvedScene& solved = all_scenes()[i];
    if (takes_millions_of_steps(solved, promise)) continue;
    const Delivered delivered = deliver(solved, {promise.method, promise.accuracy, 1e-3});
    // An integrated path may graze an edge that it misses by less than its error.
    if (promise.method != Method::automatic && delivered.hangs_on_less) continue;
    EXPECT_EQ(delivered.halt, "") << solved.name;
    EXPECT_FALSE(delivered.other_switches) << solved.name;
    EXPECT_LE(delivered.worst, 1) << solved.name << ": " << delivered.where;
    EXPECT_LE(delivered.error, largest_error(delivered)) << solved.name << ": " << delivered.where;
    if (promise.method == Method::automatic) {
      EXPECT_LE(delivered.estimate, promise.accuracy) << solved.name;
    }
    ++seen;
  }
  EXPECT_GT(seen, 50u);
}

// The test skips runs whose switches differ from the true ones: their error is not that of the steps. It also
// skips edge slides with Euler's method, which leaves and enters them millions of times before it halts.
TEST(Accuracy, AFixedStepTellsItsError) {
  for (const Method method : {Method::euler, Method::rk4, Method::lie_midpoint, Method::rkmk4}) {
    std::size_t seen = 0;
    for (std::size_t i = 0; i < all_scenes().size(); i += 5) {
      const SolvedScene& solved = all_scenes()[i];
      if (solved.expected.states.empty() || solved.expected.states.back().time > 20) continue;
      if (method == Method::euler && solved.name.rfind("edge_slide", 0) == 0) continue;
      const Delivered delivered = deliver(solved, {method, 1e-3, 1e-3});
      if (!delivered.halt.empty() || delivered.other_switches) continue;
      EXPECT_LE(delivered.error, largest_error(delivered))
          << to_string(method) << ", " << solved.name << ": " << delivered.where;
      ++seen;
    }
    EXPECT_GT(seen, 50u) << to_string(method);
  }
}

// A slip of 82 s beside a drag of 1e6 1/s: an explicit method would take 2e5 steps for each second.
TEST(Accuracy, AStiffSlideIsGoneOnWithByAnImplicitMethod) {
  const std::string path = std::string(TEST_DATA_DIR) + "/extremes/slow_drag_1e6_sliding_100s";
  const SolvedScene solved{"stiff", scene::read_scene(scene::tree_from_yaml_file(path + ".yaml")),
                           read_expected(path + ".expected.yaml")};
  for (const double accuracy : {1e-3, 1e-6, 1e-9}) {
    const Delivered delivered = deliver(solved, {Method::automatic, accuracy, 1e-3});
    EXPECT_EQ(delivered.halt, "") << accuracy;
    EXPECT_LE(delivered.worst, 1) << accuracy << ": " << delivered.where;
    EXPECT_LE(delivered.error, largest_error(delivered)) << accuracy;
    EXPECT_LT(delivered.evaluations, 100'000U) << accuracy;
  }
}

scene::Scene sphere_with_velocity(double speed) {
  scene::Scene scene{};
  scene.sphere = {1, 0.1, 0.1 * std::sqrt(2. / 3)};
  scene.initial_state.velocity = {speed, 0};
  return scene;
}

// Nothing but the sphere has a length there, and a first step of first order is a straight line.
TEST(Accuracy, AMotionFromRestIsAsAccurateAsAskedForWhateverTheTimeItTakes) {
  for (const Method method : {Method::cvode_adams, Method::cvode_bdf, Method::dopri5, Method::arkode_erk3}) {
    for (const double time : {1e-6, 1e-3, 1.0, 1e3, 1e6}) {
      scene::Scene scene = sphere_with_velocity(0);
      scene.forces.wrench.force = {1 / time / time, 0};
      scene.solver.method = method;
      scene.solver.accuracy = 1e-9;
      Simulation simulation(scene);
      simulation.advance_to(time, [](const Switch&) {});
      const State state = simulation.state();
      EXPECT_NEAR(state.position.x(), 0.5, 1e-9) << to_string(method) << ", " << time;
      EXPECT_NEAR(state.twist.velocity.x() * time, 1, 1e-9) << to_string(method) << ", " << time;
    }
  }
}

// On a belt p_c stays as large as the belt is fast, while drag makes v small: its rounding must be allowed.
TEST(Accuracy, AStiffSlideOnABeltIsFollowedAtEveryAccuracy) {
  scene::Scene scene = sphere_with_velocity(1);
  scene.surface.base.law = scene::Law::coulomb;
  scene.surface.base.friction = 0.1;
  scene.surface.base.belt = {1, 0};
  scene.forces.gravity.z() = -9.81;
  const double kappa = 2. / 5;  // of a shell
  for (const double drag : {1e3, 1e4, 1e5, 1e6}) {
    scene.forces.drag.translational = drag;
    // v' = mu g - drag v; the slip sigma = v - nu - u has nu' = (1 - 1/kappa) mu g, and dies where nu = v -
    // u.
    const double pull = 0.1 * 9.81;
    const double drop = pull * (1 / kappa - 1);
    for (const double accuracy : {1e-3, 1e-6, 1e-8, 1e-9}) {
      scene.solver.accuracy = accuracy;
      Simulation simulation(scene);
      simulation.advance_to(0.5, [](const Switch&) {});
      const State state = simulation.state();
      ASSERT_EQ(state.mode, Mode::sliding) << drag << ", " << accuracy;
      const double nu = scene.sphere.radius * state.twist.angular_velocity.y();
      EXPECT_NEAR(std::abs(nu), drop * 0.5, accuracy) << drag << ", " << accuracy;
      EXPECT_NEAR(state.twist.velocity.x(), pull / drag, accuracy) << drag << ", " << accuracy;
    }
  }
}

// x = ln(1 + c t)/c: the speed dies by a power of the time, and the way goes on.
TEST(Accuracy, AQuadraticDragLeavesAWayThatIsAsAccurateAsAskedForAfterLong) {
  scene::Scene scene = sphere_with_velocity(1);
  scene.forces.drag.quadratic = 100;
  for (const double accuracy : {1e-2, 1e-3, 1e-6, 1e-9}) {
    scene.solver.accuracy = accuracy;
    Simulation simulation(scene);
    for (const double time : {1.0, 1e4, 1e6, 1e8}) {
      simulation.advance_to(time, [](const Switch&) {});
      const double x = std::log1p(100 * time) / 100;
      EXPECT_LE(std::abs(simulation.state().position.x() - x), accuracy * x) << accuracy << ", t = " << time;
      if (accuracy == 1e-2) continue;  // steps so long have orders that tell little
      EXPECT_LE(std::abs(simulation.state().position.x() - x), 25 * simulation.estimated_error() * x)
          << accuracy << ", t = " << time;
    }
  }
}

std::vector<Promise> promises() {
  std::vector<Promise> all;
  for (const double accuracy : {1e-3, 1e-6, 1e-9, 1e-12}) {
    all.push_back({Method::automatic, accuracy, 1});
    for (const Method method : {Method::arkode_erk, Method::arkode_erk5, Method::dopri5, Method::dopri87}) {
      all.push_back({method, accuracy, 5});
    }
    for (const Method method : {Method::arkode_erk3, Method::cvode_adams, Method::cvode_bdf}) {
      if (accuracy > 1e-11) all.push_back({method, accuracy, 5});
    }
  }
  return all;
}

INSTANTIATE_TEST_SUITE_P(Methods, Dial, ::testing::ValuesIn(promises()), [](const auto& info) {
  return std::string(to_string(info.param.method)) + "_" +
         std::to_string(static_cast<int>(-std::log10(info.param.accuracy)));
});

}  // namespace
}  // namespace hybrid_sphere::testing::dial_test
