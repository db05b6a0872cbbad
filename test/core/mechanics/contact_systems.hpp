#pragma once

#include <cmath>

#include "hybrid_sphere/mechanics/system.hpp"

/// Systems with unilateral constraints and friction.
namespace hybrid_sphere::mechanics::testing {

constexpr double gravity = 9.81;  // [m/s^2]

/// A ball of unit mass above a floor.
inline Model bouncing_ball(double restitution, double floor = 0) {
  System<1> ball({"z"}, [](auto, const auto& q, const auto& v) { return v[0] * v[0] / 2 - gravity * q[0]; });
  ball.unilateral(
      "floor", [floor](const auto&, const auto& q) { return q[0] - floor; }, restitution);
  return ball;
}

/// An upright disk of unit mass and radius in a plane: its centre x, z and the angle phi that it has rolled
/// in the direction of x.
inline System<3> disk() {
  return {{"x", "z", "phi"}, [](auto, const auto& q, const auto& v) {
            return (v[0] * v[0] + v[1] * v[1]) / 2 + v[2] * v[2] / 4 - gravity * q[1];
          }};
}

/// It falls on level ground, which its centre is 1 above when it touches.
inline Model disk_on_level_ground(double mu, double restitution = 0) {
  System<3> system = disk();
  system.unilateral(
      "ground", [](const auto&, const auto& q) { return q[1] - 1.0; }, restitution);
  system.friction(
      "rolling", [](auto, const auto&, const auto& v) { return v[0] - v[2]; }, mu, "ground");
  return system;
}

/// It rolls over a cylinder; its centre is then at a distance R from the axis.
inline Model disk_on_a_cylinder(double mu, double R) {
  System<3> system = disk();
  system.unilateral("ground", [R](const auto&, const auto& q) {
    using std::sqrt;
    return sqrt(q[0] * q[0] + q[1] * q[1]) - R;
  });
  const auto slip = [](auto, const auto& q, const auto& v) {
    using std::sqrt;
    return (v[0] * q[1] - v[1] * q[0]) / sqrt(q[0] * q[0] + q[1] * q[1]) - v[2];
  };
  system.friction("rolling", slip, mu, "ground");
  return system;
}

/// A thin rod of unit mass, of half length l, whose ends touch the ground: its centre x, z and its angle.
inline Model rod(double mu, double restitution, double l = 1) {
  System<3> system({"x", "z", "angle"}, [l](auto, const auto& q, const auto& v) {
    return (v[0] * v[0] + v[1] * v[1]) / 2 + l * l / 6 * v[2] * v[2] - gravity * q[1];
  });
  const auto end = [&](const std::string& name, double side) {
    const auto gap = [=](const auto&, const auto& q) {
      using std::sin;
      return q[1] + side * l * sin(q[2]);
    };
    const auto slip = [=](auto, const auto& q, const auto& v) {
      using std::sin;
      return v[0] - side * l * sin(q[2]) * v[2];
    };
    system.unilateral(name, gap, restitution);
    system.friction("grip of " + name, slip, mu, name);
  };
  end("left", -1);
  end("right", 1);
  return system;
}

}  // namespace hybrid_sphere::mechanics::testing
