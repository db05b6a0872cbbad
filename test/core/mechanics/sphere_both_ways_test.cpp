// The general engine, given the Lagrangian and the constraints of the sphere, against the closed forms of the
// sphere: across switches, in Euler angles and in quasi-velocities.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/mechanics/sphere_cases.hpp"
#include "core/mechanics/sphere_models.hpp"
#include "support/recorded.hpp"

namespace hybrid_sphere::testing::sphere_both_ways_test {
namespace {

enum class Coordinates { angles, quasi_velocities };

/// Largest errors, each relative to its scale: way, speed of all kinetic energy, angle turned, duration.
struct Errors {
  double position = 0, velocity = 0, spin = 0, orientation = 0, time = 0, impulse = 0;
  double largest() const { return std::max({position, velocity, spin, orientation, time, impulse}); }
};

std::ostream& operator<<(std::ostream& stream, const Errors& e) {
  return stream << "position " << e.position << ", velocity " << e.velocity << ", spin " << e.spin
                << ", orientation " << e.orientation << ", instants " << e.time << ", impulses " << e.impulse;
}

mechanics::Solution solved(const SphereCase& example, Coordinates coordinates, double accuracy) {
  mechanics::Options options;
  options.accuracy = accuracy;
  return coordinates == Coordinates::angles
             ? solve(sphere_in_angles(example.scene, example.grounds), initial_in_angles(example.scene),
                     example.duration, options)
             : solve(sphere_in_quasi_velocities(example.scene, example.grounds),
                     initial_in_quasi_velocities(example.scene), example.duration, options);
}

struct Scales {
  double way = 0, speed = 0, angle = 1;
};

Scales scales_of(const SphereCase& example, const Record& record) {
  Scales scales;
  const double k = example.scene.sphere.gyration_radius;
  double spin = 0;
  for (const RecordedState& state : record.states) {
    scales.way = std::max(scales.way, (state.position - record.states[0].position).norm());
    const double square =
        state.twist.velocity.squaredNorm() + k * k * state.twist.angular_velocity.squaredNorm();
    scales.speed = std::max(scales.speed, std::sqrt(square));
    spin = std::max(spin, state.twist.angular_velocity.norm());
  }
  scales.angle = spin * example.duration;
  return scales;
}

Errors errors_of(const SphereCase& example, Coordinates coordinates, const mechanics::Solution& solution,
                 const Record& record) {
  const auto sphere = coordinates == Coordinates::angles ? sphere_of_angles : sphere_of_quasi_velocities;
  const Scales scales = scales_of(example, record);
  const double m = example.scene.sphere.mass, k = example.scene.sphere.gyration_radius;
  Errors errors;
  const auto keep = [](double& largest, double error) { largest = std::max(largest, error); };
  for (const RecordedState& state : record.states) {
    const mechanics::State general = solution.at(state.time);
    const SphereState there = sphere(general.q, general.v);
    // A switch within the rounding of the instant may be on either side of it.
    const bool at_switch =
        std::any_of(record.switches.begin(), record.switches.end(), [&](const auto& change) {
          return change.time > 0 && std::abs(change.time - state.time) < 1e-6 * example.duration;
        });
    if (at_switch) continue;
    keep(errors.position, (there.position - state.position).norm() / scales.way);
    keep(errors.velocity, (there.velocity - state.twist.velocity).norm() / scales.speed);
    keep(errors.spin, k * (there.spin - state.twist.angular_velocity).norm() / scales.speed);
    keep(errors.orientation,
         2 * (there.orientation * state.orientation.conjugate()).vec().norm() / scales.angle);
  }
  for (std::size_t i = 0; i < std::min(record.switches.size(), solution.switches().size()); ++i) {
    const RecordedSwitch& expected = record.switches[i];
    const mechanics::Switch& found = solution.switches()[i];
    keep(errors.time, std::abs(found.time - expected.time) / example.duration);
    keep(errors.impulse, (found.impulse.head<2>() - expected.impulse).norm() / (m * scales.speed));
    keep(errors.velocity,
         (sphere(found.q, found.v_after).velocity - expected.after.velocity).norm() / scales.speed);
    keep(errors.spin,
         k * (sphere(found.q, found.v_after).spin - expected.after.angular_velocity).norm() / scales.speed);
  }
  return errors;
}

std::string to_string(Coordinates coordinates) {
  return coordinates == Coordinates::angles ? "angles" : "quasi-velocities";
}

class SphereBothWays : public ::testing::TestWithParam<SphereCase> {};

TEST_P(SphereBothWays, AgreesToTheAccuracyAskedFor) {
  const SphereCase& example = GetParam();
  const Record record = testing::record(example.scene, example.duration, 64);
  ASSERT_EQ(record.halt, "");
  ASSERT_EQ(record.switches.size(), example.switches);
  for (const Coordinates coordinates : {Coordinates::angles, Coordinates::quasi_velocities}) {
    for (const double accuracy : {1e-6, 1e-10}) {
      SCOPED_TRACE(::testing::Message() << to_string(coordinates) << ", accuracy " << accuracy);
      const mechanics::Solution solution = solved(example, coordinates, accuracy);
      ASSERT_EQ(solution.status().stop, mechanics::Stop::reached_end) << solution.status().message;
      EXPECT_EQ(solution.switches().size(), record.switches.size());
      const Errors errors = errors_of(example, coordinates, solution, record);
      EXPECT_LE(errors.largest(), accuracy) << errors;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(AllCases, SphereBothWays, ::testing::ValuesIn(sphere_cases()),
                         [](const auto& info) { return info.param.name; });

// A smooth motion takes long steps, with many strips in one of them.
TEST(SphereBothWays, StepsOverNoStrip) {
  for (const double spin : {0.0, 1.0}) {
    for (double period = 0.1; period < 2; period *= 1.7) {
      SphereCase example = sine_strips(period);
      example.duration = 2;
      example.scene.initial_state.angular_velocity *= spin;
      const Record record = testing::record(example.scene, example.duration, 16);
      for (const double accuracy : {1e-3, 1e-6}) {
        SCOPED_TRACE(::testing::Message()
                     << "spin " << spin << ", period " << period << ", accuracy " << accuracy);
        const mechanics::Solution solution = solved(example, Coordinates::quasi_velocities, accuracy);
        EXPECT_EQ(solution.switches().size(), record.switches.size());
        const Errors errors = errors_of(example, Coordinates::quasi_velocities, solution, record);
        EXPECT_LE(errors.largest(), accuracy) << errors;
      }
    }
  }
}

}  // namespace
}  // namespace hybrid_sphere::testing::sphere_both_ways_test
