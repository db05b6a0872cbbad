// Initial states, and states at a new input: round-off is accepted, what is really off the constraints is
// refused.
#include <gtest/gtest.h>

#include <cfloat>
#include <cmath>
#include <string>

#include "hybrid_sphere/mechanics/multibody_system.hpp"
#include "hybrid_sphere/mechanics/plant.hpp"
#include "hybrid_sphere/mechanics/solve.hpp"
#include "hybrid_sphere/mechanics/system.hpp"

namespace hybrid_sphere::mechanics::initial_state_test {
namespace {

using Eigen::Vector3d;

template <class Call>
std::string refusal(Call call) {
  try {
    call();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

const auto free_energy = [](auto, const auto&, const auto& v) { return v.squaredNorm() / 2; };
const auto blade = [](auto, const auto& q, const auto& v) {
  using std::cos, std::sin;
  return v[0] * sin(q[2]) - v[1] * cos(q[2]);
};

Model skate() {
  System<3> model({"x", "y", "theta"}, free_energy);
  model.constrain("blade", blade, always());
  return model;
}

std::string refusal_of(const Model& model, const Initial& initial, double accuracy = 1e-9) {
  Options options;
  options.accuracy = accuracy;
  return refusal([&] { solve(model, initial, 1, options); });
}

// cos(pi/2) is 6e-17: the residual is round-off of the speed, whatever the terms that are left of it.
TEST(InitialState, AcceptsRoundOffOfABladeAtEveryHeading) {
  for (int i = 0; i < 64; ++i) {
    const double heading = i * M_PI / 16;
    const Vector q = {0, 0, heading};
    EXPECT_EQ(refusal_of(skate(), {0, q, {std::cos(heading), std::sin(heading), 1}}, 1e-13), "") << i;
    EXPECT_EQ(refusal_of(skate(), {0, q, {std::cos(heading), std::sin(heading), 0}}, 1e-13), "") << i;
  }
  EXPECT_EQ(refusal_of(skate(), {0, {0, 0, M_PI / 2}, {0, 1, 1}}, 1e-13), "");
}

TEST(InitialState, RefusesASlipAboveTheAccuracy) {
  for (const double heading : {0.0, 0.7, M_PI / 2, M_PI, 4.0}) {
    for (const double accuracy : {1e-6, 1e-9, 1e-12}) {
      const auto start = [&](double slip) -> Initial {
        const double c = std::cos(heading), s = std::sin(heading);
        return {0, {0, 0, heading}, {c - slip * s, s + slip * c, 1}};
      };
      // Sizes of the terms: at most 2^1/2 times the speed 2^1/2, at least the speed.
      EXPECT_NE(refusal_of(skate(), start(2.1 * accuracy), accuracy), "") << heading << " " << accuracy;
      EXPECT_EQ(refusal_of(skate(), start(0.5 * accuracy), accuracy), "") << heading << " " << accuracy;
    }
  }
}

TEST(InitialState, ComparesAVelocityThatIsZeroWithTheOthers) {
  System<2> model({"x", "y"}, free_energy);
  model.constrain(
      "still", [](auto, const auto&, const auto& v) { return v[0]; }, always());
  EXPECT_EQ(refusal_of(model, {0, {0, 0}, {1e-17, 1}}), "");
  EXPECT_EQ(refusal_of(model, {0, {0, 0}, {1e-10, 1}}), "");
  EXPECT_NE(refusal_of(model, {0, {0, 0}, {1e-8, 1}}), "");
  EXPECT_NE(refusal_of(model, {0, {0, 0}, {1e-17, 0}}), "");  // it is the whole motion
}

// The speed is measured in the metric of M: units of coordinates do not matter.
TEST(InitialState, IsIndependentOfUnits) {
  for (const double unit : {1e-9, 1e-3, 1e3, 1e9}) {
    System<2> model({"x", "y"}, [unit](auto, const auto&, const auto& v) {
      return (unit * unit * v[0] * v[0] + v[1] * v[1]) / 2;
    });
    model.constrain(
        "still", [](auto, const auto&, const auto& v) { return v[0]; }, always());
    EXPECT_EQ(refusal_of(model, {0, {0, 0}, {0.5e-9 / unit, 1}}), "") << unit;
    EXPECT_NE(refusal_of(model, {0, {0, 0}, {2e-9 / unit, 1}}), "") << unit;
  }
}

// f = x' - cos t at t = pi/2: what cos gives there is the round-off of t.
TEST(InitialState, AcceptsTheRoundOffOfTheTime) {
  System<1> driven({"x"}, free_energy);
  driven.constrain(
      "drive",
      [](auto t, const auto&, const auto& v) {
        using std::cos;
        return v[0] - cos(t);
      },
      always());
  EXPECT_EQ(refusal_of(driven, {M_PI / 2, {0.0}, {0.0}}), "");
  EXPECT_NE(refusal_of(driven, {M_PI / 2, {0.0}, {1e-9}}), "");
  System<1> held({"x"}, free_energy);
  held.holonomic(
      "place",
      [](auto t, const auto& q) {
        using std::cos;
        return q[0] - cos(t);
      },
      always());
  EXPECT_EQ(refusal_of(held, {M_PI / 2, {0.0}, {-1.0}}), "");
  EXPECT_NE(refusal_of(held, {M_PI / 2, {1e-3}, {-1.0}}), "");
}

TEST(InitialState, AcceptsRoundOffOfASystemAtRest) {
  const auto falling = [](auto, const auto& q, const auto& v) { return v.squaredNorm() / 2 - 9.81 * q[1]; };
  System<2> guided({"x", "y"}, falling);
  guided.holonomic(
      "guide", [](auto, const auto& q) { return q[0]; }, always());
  EXPECT_EQ(refusal_of(guided, {0, {std::cos(M_PI / 2), 1}, {0, 0}}), "");
  EXPECT_EQ(refusal_of(guided, {0, {0, 1}, {std::cos(M_PI / 2), 0}}), "");
  EXPECT_NE(refusal_of(guided, {0, {1e-9, 1}, {0, 0}}), "");
  EXPECT_NE(refusal_of(guided, {0, {0, 1}, {1e-9, 0}}), "");
  System<2> resting({"x", "y"}, falling);
  resting.unilateral("floor", [](auto, const auto& q) { return q[1]; });
  EXPECT_EQ(refusal_of(resting, {0, {0, -std::cos(M_PI / 2)}, {0, 0}}), "");
  EXPECT_NE(refusal_of(resting, {0, {0, -1e-9}, {0, 0}}), "");
}

TEST(InitialState, HoldsAContactThatOpensByRoundOff) {
  System<2> model({"x", "z"},
                  [](auto, const auto& q, const auto& v) { return v.squaredNorm() / 2 - 9.81 * q[1]; });
  model.unilateral("floor", [](auto, const auto& q) { return q[1]; });
  const Solution motion = solve(model, {0, {0, 0}, {1, std::cos(M_PI / 2)}}, 1);
  EXPECT_EQ(motion.at(0).active, ActiveSet{0});
  EXPECT_TRUE(motion.switches().empty());
  const Solution flight = solve(model, {0, {0, 0}, {1, 1e-6}}, 1);
  EXPECT_TRUE(flight.at(0).active.empty());
  EXPECT_EQ(flight.switches().size(), 1U);
}

/// A top that spins about its axis, which goes through a ball joint.
Initial start_of_top(double tilt, const Vector3d& off) {
  constexpr double length = 0.3;
  MultibodySystem system;
  Eigen::Isometry3d placement = Eigen::Isometry3d::Identity();
  placement.linear() = Eigen::AngleAxisd(tilt, Vector3d::UnitY()).toRotationMatrix();
  const Vector3d axis(std::sin(tilt), 0, std::cos(tilt));
  placement.translation() = length * axis;
  system.body("top", 1, {0.02, 0.02, 0.01}, placement).ball("joint", "world", "top", {0, 0, 0});
  const Vector3d spin = 40 * axis;
  const Initial initial = system.initial({{"top", {spin.cross(length * axis) + off, spin}}});
  EXPECT_EQ(refusal_of(system, initial, 1e-13), "") << tilt;
  return initial;
}

TEST(InitialState, AcceptsATopOnABallJointAtEveryTilt) {
  for (int i = 1; i <= 60; ++i) {
    EXPECT_EQ(refusal([&] { start_of_top(0.05 * i, {0, 0, 0}); }), "") << i;
  }
  // The speed of the top in the metric of M is 4 m/s.
  EXPECT_EQ(refusal([] { start_of_top(0.5, {1e-12, 0, 0}); }), "");
  EXPECT_NE(refusal([] { start_of_top(0.5, {1e-7, 0, 0}); }), "");
}

/// A ball on a floor whose height is the input, besides a wheel that is held.
Model ball_on_a_floor(const Vector& input) {
  const double height = input[0];
  System<2> model({"x", "z"},
                  [](auto, const auto& q, const auto& v) { return v.squaredNorm() / 2 - 9.81 * q[1]; });
  model.unilateral("floor", [height](auto, const auto& q) { return q[1] - height; });
  return model;
}

TEST(InitialState, OfAPlantIsRefusedForAnInputThatMovesAFloorIntoABody) {
  Plant plant(ball_on_a_floor, {0}, {0, {0, 0}, {1, 0}});
  plant.advance(1);
  for (const double height : {1e-3, 1e-5, 1e-7}) {
    const std::string message = refusal([&] { plant.set_input({height}); });
    EXPECT_NE(message.find("floor"), std::string::npos) << height << message;
    EXPECT_EQ(plant.input()[0], 0) << height;
  }
  EXPECT_EQ(refusal([&] { plant.set_input({DBL_EPSILON}); }), "");
}

TEST(InitialState, OfAPlantThatHasNotMovedIsComparedAsAtTheStart) {
  for (const double unit : {1e-6, 1.0, 1e6}) {  // length of the radius in metres
    const auto model = [unit](const Vector& input) -> Model {
      System<2> bead({"x", "y"}, free_energy);
      const double radius = input[0] * unit;
      bead.holonomic(
          "ring",
          [radius](auto, const auto& q) {
            using std::sqrt;
            return sqrt(q.squaredNorm()) - radius;
          },
          always());
      return bead;
    };
    Plant plant(model, {1}, {0, {unit, 0}, {0, 0}});
    EXPECT_NE(refusal([&] { plant.set_input({1 + 1e-8}); }), "") << unit;
    EXPECT_EQ(refusal([&] { plant.set_input({1 + 1e-12}); }), "") << unit;
  }
}

// With another input the velocities satisfy the constraint up to round-off of the speed: that is no switch.
TEST(InitialState, OfAPlantHasNoSwitchForRoundOff) {
  const auto model = [](const Vector& input) -> Model {
    const double heading = input[0];
    System<2> skate({"x", "y"}, free_energy);
    skate.constrain(
        "blade",
        [heading](auto, const auto&, const auto& v) {
          using std::cos, std::sin;
          return v[0] * sin(heading) - v[1] * cos(heading);
        },
        always());
    return skate;
  };
  Plant plant(model, {M_PI / 2}, {0, {0, 0}, {0, 1}});
  plant.advance(1);
  plant.set_input({std::nextafter(M_PI / 2, 2)});
  plant.advance(2);
  EXPECT_EQ(plant.switches(), 0U);
  plant.set_input({M_PI / 2 + 1e-6});
  plant.advance(3);
  EXPECT_EQ(plant.switches(), 1U);
}

}  // namespace
}  // namespace hybrid_sphere::mechanics::initial_state_test
