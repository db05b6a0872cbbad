// Scenes whose numbers have any size that a scene file may give them, ends of the ranges included: each is
// computed, or halts with a reason, in the time that it is given.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <sstream>
#include <utility>

#include "hybrid_sphere/simulation/simulation.hpp"
#include "interrupt/interrupt.hpp"
#include "scene/read_tree.hpp"
#include "scene/yaml.hpp"
#include "support/case_count.hpp"
#include "support/patience.hpp"

namespace hybrid_sphere::testing::whole_range_test {
namespace {

/// Writes scenes of the whole range of docs/scene_files.md.
class SceneWriter {
 public:
  explicit SceneWriter(unsigned seed) : engine_(seed) {}

  std::string scene() {
    std::ostringstream out;
    out.precision(17);
    mass_ = size(1e-60, 1e60);
    radius_ = size(1e-12, 1e12);
    inertia_ = 0.399999 * mass_ * radius_ * radius_;  // rounded, as the ends of ranges that it makes
    ordinary_ = one_in(3);
    out << "sphere: {mass: " << mass_ << ", radius: " << radius_ << ", body: solid}\n";
    out << "initial_state: {position: " << place() << ", velocity: " << list(2, 1e15)
        << ", angular_velocity: " << list(3, 1e15) << "}\n";
    out << "surface:\n  base: {" << ground() << "}\n  regions:\n";
    const int regions = integer(1, 4);
    for (int i = 0; i < regions; ++i) {
      out << "    - {name: r" << i << ", " << shape() << ", " << ground() << "}\n";
    }
    out << "gravity: [" << number(1e15) << ", " << number(1e15) << ", " << -size(1e-60, 1e15) << "]\n";
    if (one_in(3)) {
      out << "wrench: {force: " << list(2, 0.999999e15 * mass_) << ", torque: " << list(3, 1e15 * inertia_)
          << "}\n";
    }
    if (one_in(3)) {
      out << "drag: {translational: " << positive(0.999999e12 * mass_)
          << ", rotational: " << positive(1e12 * inertia_) << ", quadratic: " << positive(0.999999e15 * mass_)
          << "}\n";
    }
    if (one_in(3)) {
      out << "spring: {center: " << place() << ", stiffness: " << positive(0.999999e15 * mass_) << "}\n";
    }
    if (one_in(4)) out << "solver: {method: " << method() << "}\n";
    return out.str();
  }

  bool one_in(int n) { return integer(1, n) == 1; }
  int integer(int low, int high) { return std::uniform_int_distribution<int>(low, high)(engine_); }
  /// Log-uniform; now and then an end of the range.
  double size(double low, double high) {
    if (one_in(20)) return low;
    if (one_in(20)) return high;
    if (ordinary_ || one_in(2)) {
      const double ordinary = std::exp(std::uniform_real_distribution<double>(-3, 3)(engine_));
      if (low <= ordinary && ordinary <= high) return ordinary;
    }
    const double exponent = std::uniform_real_distribution<double>(std::log(low), std::log(high))(engine_);
    return std::min(std::max(std::exp(exponent), low), high);
  }

 private:
  static constexpr double least = 1e-60;

  double positive(double most) { return one_in(3) ? 0 : size(std::min(least, most), most); }
  double number(double most) {
    if (one_in(8)) return 0;
    if (one_in(12)) return std::min(1e-17, most) * (one_in(2) ? 1 : -1);  // what arithmetic leaves of 0
    return (one_in(2) ? 1 : -1) * size(std::min(least, most), most);
  }
  std::string list(int count, double most) {
    std::ostringstream out;
    out.precision(17);
    for (int i = 0; i < count; ++i) out << (i == 0 ? "[" : ", ") << number(most);
    out << "]";
    return out.str();
  }
  std::string place() { return list(2, 1e15); }

  std::string shape() {
    std::ostringstream out;
    out.precision(17);
    switch (integer(0, 2)) {
      case 0: {
        std::string normal = list(2, 1e15);
        if (normal == "[0, 0]") normal = "[0, 1.0]";
        out << "half_plane: {point: " << place() << ", normal: " << normal << "}";
        break;
      }
      case 1: out << "circle: {center: " << place() << ", radius: " << size(1e-12, 1e15) << "}"; break;
      default: {
        // A rectangle: whatever its numbers, its sides do not cross.
        double x[2] = {number(1e15), number(1e15)};
        double y[2] = {number(1e15), number(1e15)};
        if (x[0] == x[1]) x[1] = x[0] == 1 ? 2 : 1;
        if (y[0] == y[1]) y[1] = y[0] == 1 ? 2 : 1;
        out << "polygon: [[" << x[0] << ", " << y[0] << "], [" << x[1] << ", " << y[0] << "], [" << x[1]
            << ", " << y[1] << "], [" << x[0] << ", " << y[1] << "]]";
      }
    }
    return out.str();
  }

  std::string ground() {
    std::ostringstream out;
    out.precision(17);
    const int law = integer(0, 3);
    if (law == 0) return "law: smooth";
    const double friction = positive(1e9);
    out << "law: " << (law == 1 ? "rough" : law == 2 ? "rubber" : "coulomb");
    if (law == 3) out << ", friction: " << friction;
    const double quarter = friction < 4 * least ? 0 : 0.25 * friction;
    if (one_in(4)) out << ", rolling_resistance: " << (law == 3 ? quarter : positive(1e9));
    if (law != 2 && one_in(4)) out << ", spin_friction: " << positive(1e9);
    if (one_in(3)) {
      out << ", belt: " << list(2, 1e15);
    } else if (one_in(3)) {
      out << ", turntable: {rate: " << number(1e15) << ", center: " << place() << "}";
    }
    return out.str();
  }

  std::string method() {
    const char* const methods[] = {"dopri87",     "dopri5",    "arkode_erk", "arkode_erk5",  "arkode_erk3",
                                   "cvode_adams", "cvode_bdf", "rk4",        "lie_midpoint", "rkmk4"};
    return methods[integer(0, 9)];
  }

  std::mt19937 engine_;
  double mass_ = 1;
  double radius_ = 1;
  double inertia_ = 1;
  bool ordinary_ = false;  // most numbers near 1
};

::testing::AssertionResult is_finite(const State& state) {
  if (state.position.allFinite() && state.twist.velocity.allFinite() &&
      state.twist.angular_velocity.allFinite() && state.slip.allFinite() &&
      std::abs(state.orientation.norm() - 1) < 1e-12) {
    return ::testing::AssertionSuccess();
  }
  return ::testing::AssertionFailure()
         << "position " << state.position.transpose() << ", velocity " << state.twist.velocity.transpose()
         << ", spin " << state.twist.angular_velocity.transpose() << ", slip " << state.slip.transpose()
         << ", orientation " << state.orientation.coeffs().transpose();
}

#if defined(__SANITIZE_ADDRESS__)
const int scenes = case_count(100);
#else
const int scenes = case_count(500);
#endif

// A computation is stopped by a number of questions, so that what becomes of a scene is the same on every
// machine. The work between two questions is counted in evaluations of the right-hand side, and in questions
// to a function other than the simulation's own.
TEST(WholeRange, AreComputedOrHaltWithAReasonWhereTheyAreAskedToStop) {
  const int questions = case_count(50);
  int ended = 0, halted = 0, stopped = 0;
  for (int seed = 0; seed < scenes; ++seed) {
    SceneWriter writer(static_cast<unsigned>(seed));
    const std::string text = writer.scene();
    SCOPED_TRACE(text);
    scene::Scene scene{};
    ASSERT_NO_THROW(scene = scene::read_scene(scene::tree_from_yaml(text)));
    Simulation simulation(scene);
    int asked = 0;
    std::uint64_t evaluations = 0, max_evaluations = 0, unheard = 0, max_unheard = 0;
    const ShouldStop outside = [&] { return ++unheard == 0; };
    const InterruptScope scope(outside);
    const HangGuard guard;
    const auto end_silence = [&] {
      const std::uint64_t before = std::exchange(evaluations, simulation.evaluations());
      max_evaluations = std::max(max_evaluations, evaluations - before);
      max_unheard = std::max(max_unheard, std::exchange(unheard, 0));
    };
    simulation.set_interrupt([&] {
      end_silence();
      return ++asked > questions;
    });
    try {
      double time = writer.size(1e-9, seed % 2 == 0 ? 1e6 : 1);
      for (int i = 0; i < 3; ++i, time *= 10) {
        asked = 0;
        simulation.advance_to(time, {});
        end_silence();
        ASSERT_TRUE(is_finite(simulation.state()));
      }
      ++ended;
    } catch (const HaltedError& error) {
      ASSERT_STRNE(error.what(), "");
      ++halted;
    } catch (const Interrupted&) {
      ++stopped;
    } catch (const std::exception& error) {
      FAIL() << error.what();
    }
    end_silence();
    ASSERT_TRUE(is_finite(simulation.state()));
    // Three times the measured maxima.
    ASSERT_LE(max_evaluations, 30000U);
    ASSERT_LE(max_unheard, 100U);
  }
  EXPECT_GT(ended, scenes / 2);
  RecordProperty("ended", ended);
  RecordProperty("halted", halted);
  RecordProperty("stopped", stopped);
}

}  // namespace
}  // namespace hybrid_sphere::testing::whole_range_test
