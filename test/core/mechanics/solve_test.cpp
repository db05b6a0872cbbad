#include "hybrid_sphere/mechanics/solve.hpp"

#include <gtest/gtest.h>

#include <cfloat>
#include <cmath>

#include "core/mechanics/particle.hpp"
#include "hybrid_sphere/mechanics/system.hpp"

namespace hybrid_sphere::mechanics::solve_test {
namespace {

using testing::accurate, testing::level, testing::particle, testing::vector;

/// Of motions that are polynomials of the time, which the steps follow exactly: each step rounds numbers of
/// at most `size` a few times.
double roundings(const Solution& solution, double size) {
  return 4 * static_cast<double>(solution.steps()) * DBL_EPSILON * size;
}

TEST(Solve, AppliesAndReleasesAConstraintAtGivenInstants) {
  System<2> system = particle(2);
  system.constrain("level", level, between(1, 3));
  const Solution solution = solve(system, {0, vector({0, 0}), vector({1, 0})}, 4);
  ASSERT_EQ(solution.status().stop, Stop::reached_end);
  ASSERT_EQ(solution.switches().size(), 2u);
  const double rounding = roundings(solution, 4);
  const Switch& applied = solution.switches()[0];
  EXPECT_EQ(applied.time, 1);
  EXPECT_EQ(applied.applied, ActiveSet{0});
  // Free fall gives y' = -2 and y = -1 at t = 1; the constraint takes the speed.
  EXPECT_NEAR(applied.v_before[1], -2, rounding);
  EXPECT_NEAR(applied.multipliers[0], 2, rounding);
  EXPECT_EQ(applied.v_after[1], 0);
  EXPECT_NEAR(applied.kinetic_energy_before - applied.kinetic_energy_after, 2, rounding);
  const Switch& released = solution.switches()[1];
  EXPECT_EQ(released.time, 3);
  EXPECT_EQ(released.released, ActiveSet{0});
  EXPECT_EQ(released.impulse.norm(), 0);
  const State held = solution.at(2);
  EXPECT_EQ(held.stage, 3);
  EXPECT_NEAR(held.q[1], -1, rounding);
  EXPECT_NEAR(held.multipliers[0], 2, rounding);  // carries the weight
  const State end = solution.at(4);
  EXPECT_EQ(end.stage, 1);
  EXPECT_NEAR(end.q[0], 4, rounding);
  EXPECT_NEAR(end.q[1], -2, rounding);
  EXPECT_EQ(end.multipliers[0], 0);
}

TEST(Solve, StateAtASwitchIsTheOneAfterIt) {
  System<2> system = particle();
  system.constrain("level", level, from(1));
  const Solution solution = solve(system, {0, vector({0, 0}), vector({1, 1})}, 2);
  EXPECT_EQ(solution.at(1).stage, 3);
  EXPECT_EQ(solution.at(1).v[1], 0);
  EXPECT_EQ(solution.at(std::nextafter(1, 0)).v[1], 1);
}

TEST(Solve, AppliesAConstraintThatBeginsAtTheStart) {
  System<2> system = particle();
  system.constrain("level", level, from(0));
  const Solution solution = solve(system, {0, vector({0, 0}), vector({1, 1})}, 1);
  ASSERT_EQ(solution.switches().size(), 1u);
  EXPECT_EQ(solution.switches()[0].time, 0);
  EXPECT_EQ(solution.at(0).v[1], 0);
}

TEST(Solve, RefusesInitialVelocitiesOffAConstraintThatHoldsAlready) {
  System<2> system = particle();
  system.constrain("level", level, always());
  try {
    solve(system, {0, vector({0, 0}), vector({1, 0.25})}, 1);
    FAIL() << "accepted";
  } catch (const std::invalid_argument& error) {
    const std::string message = error.what();
    EXPECT_NE(message.find("level"), std::string::npos) << message;
    EXPECT_NE(message.find("residual"), std::string::npos) << message;
  }
}

TEST(Solve, ProjectsInitialVelocitiesWhenAsked) {
  System<2> system = particle();
  system.constrain("level", level, always());
  Options options;
  options.project_initial = true;
  const Solution solution = solve(system, {0, vector({0, 0}), vector({1, 0.25})}, 1, options);
  EXPECT_TRUE(solution.switches().empty());
  EXPECT_EQ(solution.at(0).v[1], 0);
  EXPECT_EQ(solution.at(0).v[0], 1);
}

/// A reel of unit mass and radius on a smooth slope (F) that leads down to rough ground, thrown back from its
/// edge at t = 0: each time with the part 2 kappa - 1 of its speed, kappa = k^2/(1 + k^2). A flight from the
/// speed v lasts 2 v/F, so that the instants accumulate at t = (1/F)/(1 - kappa); then it rolls on from rest
/// with F (1 - kappa).
Solution reel_on_a_slope(double square_of_k, double force, double duration, const Options& options = {}) {
  System<2> reel({"x", "angle"}, [=](auto, const auto& q, const auto& v) {
    return (v[0] * v[0] + square_of_k * v[1] * v[1]) / 2 + force * q[0];
  });
  reel.constrain(
      "rolling", [](auto, const auto&, const auto& v) { return v[0] - v[1]; },
      while_positive([](auto, const auto& q) { return q[0]; }));
  return solve(reel, {0, vector({0, 0}), vector({-1, -1})}, duration, options);
}

// What is left of the bounces falls below the rounding of x, and the last one is held.
TEST(Solve, PassesAnAccumulationThatEndsInRolling) {
  const Solution solution = reel_on_a_slope(9, 1, 100);
  ASSERT_EQ(solution.status().stop, Stop::reached_end) << solution.status().message;
  EXPECT_GT(solution.switches().size(), 100u);
  EXPECT_NEAR(solution.switches()[3].time, 2 + 1.6, roundings(solution, 4));
  // A flight of the speed v goes v^2/2 high, and as high as four roundings of 1 it is not seen; all that
  // would come after it last 2 v/(1 - 0.8).
  EXPECT_NEAR(solution.switches().back().time, 10, 10 * std::sqrt(8 * DBL_EPSILON));
  EXPECT_NEAR(solution.at(100).q[0], 0.05 * 90 * 90, Options().accuracy * 405);
}

// Each throw keeps 98 % of the speed: a thousand of them fit into a short time before they become too small
// to tell.
TEST(Solve, StopsWhereSwitchesAccumulate) {
  Options options;
  options.max_switches = 5000;
  const Solution solution = reel_on_a_slope(100, 3.3, 10000, options);
  EXPECT_EQ(solution.status().stop, Stop::accumulation) << solution.status().message;
  // A thousand bounces come within 2 s at the 1,134th; all that come after it last 4e-9 s.
  EXPECT_NEAR(solution.status().time, 101 / 3.3, 1e-7);
}

TEST(Solve, NamesAFunctionThatIsNotFinite) {
  System<1> system({"x"}, [](auto, const auto& q, const auto& v) {
    using std::pow;
    return v[0] * v[0] / 2 - pow(1 - q[0], 2.5);
  });
  const Solution solution = solve(system, {0, vector({0}), vector({1})}, 10);
  EXPECT_EQ(solution.status().stop, Stop::not_finite);
  EXPECT_NE(solution.status().message.find("lagrangian"), std::string::npos) << solution.status().message;
  EXPECT_NE(solution.status().message.find("x = "), std::string::npos) << solution.status().message;
  EXPECT_LT(solution.end(), 10);
  EXPECT_LE(solution.at(solution.end()).q[0], 1);
  EXPECT_GT(solution.at(solution.end()).q[0], 0.9);
}

// The boat that has to head at a point comes to it at t = 1, where every direction does.
TEST(Solve, StopsWhereAConstraintLosesItsDirection) {
  for (const double accuracy : {1e-3, 1e-9}) {
    System<2> boat = particle();
    boat.constrain(
        "heading", [](auto, const auto& q, const auto& v) { return q[1] * v[0] - q[0] * v[1]; }, always());
    const Solution solution =
        solve(boat, {0, vector({-0.6, 0.8}), vector({0.6, -0.8})}, 5, accurate(accuracy));
    EXPECT_EQ(solution.status().stop, Stop::no_direction) << solution.status().message;
    EXPECT_LE(solution.end(), 1);
    EXPECT_NE(solution.status().message.find("heading"), std::string::npos) << solution.status().message;
  }
}

// x y' = 0, on x = cos(t): the direction is lost where x = 0, within a step.
TEST(Solve, StopsBeforeTheInstantAtWhichADirectionIsLost) {
  System<2> system({"x", "y"}, [](auto, const auto& q, const auto& v) {
    return (v[0] * v[0] + v[1] * v[1] - q[0] * q[0]) / 2;
  });
  system.constrain(
      "product", [](auto, const auto& q, const auto& v) { return q[0] * v[1]; }, always());
  for (const double accuracy : {1e-2, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12, 1e-13}) {
    const Solution solution = solve(system, {0, vector({1, 0}), vector({0, 0})}, 3, accurate(accuracy));
    ASSERT_EQ(solution.status().stop, Stop::no_direction) << accuracy << ": " << solution.status().message;
    EXPECT_LE(solution.end(), M_PI / 2) << accuracy;
    EXPECT_NE(solution.status().message.find("near t = 1.57"), std::string::npos)
        << solution.status().message;
  }
}

// The row (1, 0, -R cos(angle)) passes near (1, 0, 0) twice a turn, which is small only in some units.
TEST(Solve, GoesOnWhereOneComponentOfADirectionVanishes) {
  for (const double R : {1e-6, 1.0, 1e6}) {
    System<3> disk({"x", "theta", "phi"}, [=](auto, const auto&, const auto& v) {
      return (v[0] * v[0] + v[1] * v[1] + R * R * v[2] * v[2]) / 2;
    });
    disk.constrain(
        "rolling",
        [=](auto, const auto& q, const auto& v) {
          using std::cos;
          return v[0] - R * cos(q[1]) * v[2];
        },
        always());
    const Solution solution = solve(disk, {0, vector({0, 0, 0}), vector({1, 3, 1 / R})}, 10);
    EXPECT_EQ(solution.status().stop, Stop::reached_end) << "R = " << R << ": " << solution.status().message;
  }
}

// Stiff ground, a force with a kink at y = 0, which a long step of the fall must not pass unseen.
TEST(Solve, DoesNotStepOverAKinkOfTheForce) {
  System<2> ball({"x", "y"}, [](auto, const auto& q, const auto& v) {
    auto potential = 9.81 * q[1];
    if (q[1] < 0) potential += 5000 * q[1] * q[1];
    return v.dot(v) / 2 - potential;
  });
  for (const double accuracy : {1e-3, 1e-6, 1e-9, 1e-12}) {
    for (const double height : {0.3, 0.7, 1.0, 1.3}) {
      const Solution solution = solve(ball, {0, vector({0, height}), vector({1, 0})}, 20, accurate(accuracy));
      ASSERT_EQ(solution.status().stop, Stop::reached_end) << solution.status().message;
      const double energy = 0.5 + 9.81 * height;
      // Errors of the two velocities and coordinates, with momenta and forces that go with all of the energy:
      // at most 4 times the accuracy each. No step is asked for more than 4e-15.
      const double reached = accuracy + 4e-15 * static_cast<double>(solution.steps());
      EXPECT_NEAR(solution.at(20).energy, energy, 2 * 4 * reached * energy)
          << "accuracy " << accuracy << ", height " << height;
    }
  }
}

// Of a force that jumps at an instant of which no event tells, the steps get as short as the clock's
// resolution, r = 16 eps t; they know the instant to within it: velocities to force r, places to force r
// times the rest.
TEST(Solve, PassesAForceThatJumps) {
  constexpr double instant = 1.2345;
  constexpr double force = 100;
  constexpr double rest = 3 - instant;
  System<1> body(
      {"x"}, [](auto, const auto&, const auto& v) { return v[0] * v[0] / 2; },
      [](double t, const auto&, const auto&) { return t >= instant ? force : 0.0; });
  for (const double accuracy : {1e-6, 1e-9, 1e-11, 1e-12, 1e-13}) {
    const Solution solution = solve(body, {0, vector({0}), vector({1})}, 3, accurate(accuracy));
    ASSERT_EQ(solution.status().stop, Stop::reached_end) << solution.status().message;
    const double off = force * 16 * DBL_EPSILON * instant;
    const double speed = 1 + force * rest;
    EXPECT_NEAR(solution.at(3).v[0], speed, off + accuracy * speed);
    EXPECT_NEAR(solution.at(3).q[0], 3 + force * rest * rest / 2, rest * (off + accuracy * speed));
  }
}

/// x'' = 0 up to x = 1/2, where it gives no number any more, and does not say so.
class EndsSilently final : public EquationsOfMotion {
 public:
  Index coordinates() const override { return 1; }
  Index velocities() const override { return 1; }
  void evaluate(double, const Vector& q, const Vector& v, MotionTerms& terms) const override {
    terms.rate = v;
    terms.momentum = v;
    terms.mass = Matrix::Identity(1, 1);
    terms.force = vector({q[0] < 0.5 ? 0.0 : NAN});
  }
  void momentum(double, const Vector&, const Vector& v, Vector& p, Matrix& mass) const override {
    p = v;
    mass = Matrix::Identity(1, 1);
  }
};

TEST(Solve, StopsAtEquationsByHandThatAreNotFinite) {
  const System<1> system({"x"}, {"x_dot"}, std::make_shared<EndsSilently>());
  const Solution solution = solve(system, {0, vector({0}), vector({1})}, 1);
  EXPECT_EQ(solution.status().stop, Stop::not_finite) << solution.status().message;
  EXPECT_LE(solution.end(), 0.5);
  EXPECT_GT(solution.end(), 0.49);
}

// The force 1/(2 sqrt(1 - x)) has no bound near x = 1, nor have its derivatives: steps become too short, or
// one ends at x = 1 to the last figure.
TEST(Solve, StopsBeforeASingularityOfTheForce) {
  System<1> system({"x"}, [](auto, const auto& q, const auto& v) {
    using std::sqrt;
    return v[0] * v[0] / 2 - sqrt(1 - q[0]);
  });
  const Solution solution = solve(system, {0, vector({0}), vector({1})}, 10);
  const Stop stop = solution.status().stop;
  EXPECT_TRUE(stop == Stop::no_step || stop == Stop::not_finite) << solution.status().message;
  // A step is more than a millionth of what is left of the way, and the shortest one 16 roundings of the
  // time.
  EXPECT_NEAR(solution.at(solution.end()).q[0], 1, 1e6 * 16 * DBL_EPSILON);
}

TEST(Solve, NamesAGuardThatIsNotFinite) {
  System<2> system = particle();
  system.constrain("level", level, while_positive([](auto, const auto& q) {
                     using std::pow;
                     return 0.5 + pow(1 - q[0], 2.5);
                   }));
  const Solution solution = solve(system, {0, vector({0.5, 0}), vector({1, 0})}, 10);
  EXPECT_EQ(solution.status().stop, Stop::not_finite);
  EXPECT_NE(solution.status().message.find("guard of constraint level"), std::string::npos)
      << solution.status().message;
}

TEST(Solve, StopsAtALagrangianThatIsNotRegular) {
  System<2> system({"x", "y"}, [](auto, const auto& q, const auto& v) { return v[0] * v[0] / 2 - q[1]; });
  const Solution solution = solve(system, {0, vector({0, 0}), vector({1, 0})}, 1);
  EXPECT_EQ(solution.status().stop, Stop::singular);
  EXPECT_EQ(solution.end(), 0);
  EXPECT_EQ(solution.at(0).v[0], 1);
}

TEST(Solve, TakesAMassMatrixThatTheConstraintsMakeRegular) {
  // y has no mass, but rolls on x.
  System<2> system(
      {"x", "y"}, [](auto, const auto&, const auto& v) { return v[0] * v[0] / 2; },
      [](auto, const auto&, const auto& v) {
        auto force = v;
        force[0] = 0;
        force[1] = 1;
        return force;
      });
  system.constrain(
      "gear", [](auto, const auto&, const auto& v) { return v[1] - 2 * v[0]; }, always());
  const Solution solution = solve(system, {0, vector({0, 0}), vector({0, 0})}, 1);
  ASSERT_EQ(solution.status().stop, Stop::reached_end) << solution.status().message;
  // x'' = lambda_x = -2 lambda, 0 = 1 + lambda
  EXPECT_NEAR(solution.at(1).q[0], 1, roundings(solution, 2));
  EXPECT_NEAR(solution.at(1).q[1], 2, roundings(solution, 2));
  EXPECT_NEAR(solution.at(1).multipliers[0], -1, roundings(solution, 2));
}

TEST(Solve, SaysWhichConstraintsComeToContradictEachOther) {
  System<2> system = particle();
  system.constrain(
      "still", [](auto, const auto&, const auto& v) { return v[0]; }, always());
  system.constrain("level", level, always());
  system.constrain(
      "faster", [](auto t, const auto&, const auto& v) { return v[0] - (t - 1); }, from(1));
  const Solution solution = solve(system, {0, vector({0, 0}), vector({0, 0})}, 2);
  EXPECT_EQ(solution.status().stop, Stop::inconsistent);
  EXPECT_EQ(solution.status().time, 1);
  const std::string& message = solution.status().message;
  EXPECT_NE(message.find("still"), std::string::npos) << message;
  EXPECT_NE(message.find("faster"), std::string::npos) << message;
  EXPECT_EQ(message.find("level"), std::string::npos) << message;
}

TEST(Solve, RefusesWrongSizesAndNumbers) {
  const System<2> system = particle();
  const Initial good{0, vector({0, 0}), vector({1, 0})};
  EXPECT_THROW(solve(system, {0, vector({0}), vector({1, 0})}, 1), std::invalid_argument);
  EXPECT_THROW(solve(system, {0, vector({0, 0}), vector({1, 0, 0})}, 1), std::invalid_argument);
  EXPECT_THROW(solve(system, {0, vector({0, NAN}), vector({1, 0})}, 1), std::invalid_argument);
  EXPECT_THROW(solve(system, {INFINITY, good.q, good.v}, 1), std::invalid_argument);
  EXPECT_THROW(solve(system, good, -1), std::invalid_argument);
  EXPECT_THROW(solve(system, good, NAN), std::invalid_argument);
  EXPECT_THROW(solve(system, good, 1, accurate(0)), std::invalid_argument);
  EXPECT_THROW(solve(system, good, 1, accurate(NAN)), std::invalid_argument);
  EXPECT_THROW(solve(system, good, 1).at(1.5), std::out_of_range);
  EXPECT_THROW(solve(system, good, 1).at(NAN), std::out_of_range);
}

TEST(Solve, TakesNoTimeAtAll) {
  const Solution solution = solve(particle(), {2, vector({3, 4}), vector({1, 0})}, 0);
  EXPECT_EQ(solution.status().stop, Stop::reached_end);
  EXPECT_EQ(solution.begin(), 2);
  EXPECT_EQ(solution.end(), 2);
  EXPECT_EQ(solution.at(2).q[1], 4);
}

TEST(Solve, StopsAtTheNumberOfStepsAndSwitchesAllowed) {
  System<2> system = particle(1);
  system.constrain("level", level, while_positive([](auto, const auto& q) {
                     using std::sin;
                     return sin(q[0]);
                   }));
  const Initial initial{0, vector({-0.5, 0}), vector({1, 1})};
  Options options;
  options.max_switches = 3;
  EXPECT_EQ(solve(system, initial, 100, options).status().stop, Stop::too_many_switches);
  options = {};
  options.max_steps = 5;
  const Solution solution = solve(system, initial, 100, options);
  EXPECT_EQ(solution.status().stop, Stop::too_many_steps);
  EXPECT_LT(solution.end(), 100);
  EXPECT_NEAR(solution.at(solution.end()).time, solution.end(), 0);
}

// The same motion in other units of length, time and mass: the same steps, scaled. Powers of two are exact.
TEST(Solve, DoesNotDependOnUnits) {
  const auto run = [](double length, double time, double mass) {
    const double gravity = length / (time * time);
    System<2> system({"x", "y"}, [=](auto, const auto& q, const auto& v) {
      return mass * v.dot(v) / 2 - mass * gravity * q[1] * (1 + q[0] * q[0] / (length * length));
    });
    system.constrain("level", level, while_positive([=](auto, const auto& q) { return q[0] - length; }));
    return solve(system, {0, vector({0, 0}), vector({length / time, 0})}, 4 * time);
  };
  const Solution one = run(1, 1, 1);
  const double length = 0x1p-60;
  const double time = 0x1p+30;
  const Solution other = run(length, time, 0x1p+40);
  ASSERT_EQ(one.switches().size(), other.switches().size());
  EXPECT_EQ(one.steps(), other.steps());
  EXPECT_EQ(one.switches()[0].time * time, other.switches()[0].time);
  EXPECT_EQ(one.at(4).q[1] * length, other.at(4 * time).q[1]);
}

}  // namespace
}  // namespace hybrid_sphere::mechanics::solve_test
