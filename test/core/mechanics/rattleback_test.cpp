// A rattleback: its motion multiplies errors while its spin turns into rattling.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "core/mechanics/particle.hpp"

namespace hybrid_sphere::mechanics::rattleback_test {
namespace {

constexpr double gravity = 9.81;
const Eigen::Vector3d half_axes(0.2, 0.03, 0.02);  // of the ellipsoid [m]
constexpr double below = 0.001;                    // its centre to the centre of mass [m]

/// Of unit mass, with axes that are turned against those of the ellipsoid [kg m^2].
Eigen::Matrix3d inertia() {
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  return turn * Eigen::Vector3d(0.0002, 0.0016, 0.0017).asDiagonal() * turn.transpose();
}

template <class Q>
auto rotation(const Q& q) {
  using T = std::decay_t<decltype(q[0] * q[0])>;
  const T &w = q[3], &x = q[4], &y = q[5], &z = q[6];
  Eigen::Matrix<T, 3, 3> R;
  R << 1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y),  //
      2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x),   //
      2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y);
  return R;
}

/// q: place and quaternion, v: velocity in the world and angular velocity in the body.
Model rattleback() {
  const auto rate = [](const auto& q, const auto& v) {
    using T = std::decay_t<decltype(q[0] * v[0])>;
    Eigen::Matrix<T, 7, 1> rate;
    rate << T(v[0]), T(v[1]), T(v[2]), T(-q[4] * v[3] - q[5] * v[4] - q[6] * v[5]) / 2,
        T(q[3] * v[3] + q[5] * v[5] - q[6] * v[4]) / 2, T(q[3] * v[4] + q[6] * v[3] - q[4] * v[5]) / 2,
        T(q[3] * v[5] + q[4] * v[4] - q[5] * v[3]) / 2;
    return rate;
  };
  const Eigen::Matrix3d I = inertia();
  const auto lagrangian = [I](auto, const auto& q, const auto& v) {
    using T = std::decay_t<decltype(q[0] * v[0])>;
    T sum = -gravity * q[2];
    for (int i = 0; i < 3; ++i) {
      sum += v[i] * v[i] / 2;
      for (int j = 0; j < 3; ++j) sum += I(i, j) / 2 * v[3 + i] * v[3 + j];
    }
    return sum;
  };
  const auto rolling = [](auto, const auto& q, const auto& v) {
    using std::sqrt;
    using T = std::decay_t<decltype(q[0] * v[0])>;
    const auto R = rotation(q);
    T size = T(0.0);
    for (int i = 0; i < 3; ++i) size += half_axes[i] * half_axes[i] * R(2, i) * R(2, i);
    const T length = sqrt(size);
    Eigen::Matrix<T, 3, 1> arm;  // to the contact, in the body
    for (int i = 0; i < 3; ++i) arm[i] = -half_axes[i] * half_axes[i] * R(2, i) / length;
    arm[2] += below;
    const Eigen::Matrix<T, 3, 1> turned(v[4] * arm[2] - v[5] * arm[1], v[5] * arm[0] - v[3] * arm[2],
                                        v[3] * arm[1] - v[4] * arm[0]);
    Eigen::Matrix<T, 3, 1> contact;
    for (int i = 0; i < 3; ++i) {
      contact[i] = v[i] + R(i, 0) * turned[0] + R(i, 1) * turned[1] + R(i, 2) * turned[2];
    }
    return contact;
  };
  System<6, 7> system({"x", "y", "z", "qw", "qx", "qy", "qz"}, {"vx", "vy", "vz", "w1", "w2", "w3"}, rate,
                      lagrangian);
  system.constrain("rolling", rolling, always());
  system.normalize = [](Vector& q) { q.tail(4).normalize(); };
  return system;
}

double length(const Model& model, const State& at, const Vector& v) {
  MotionTerms terms;
  model.equations->evaluate(at.time, at.q, at.v, terms);
  return std::sqrt(v.dot(terms.mass * v));
}

TEST(Rattleback, KeepsTheAccuracyInTheMetricOfTheMass) {
  constexpr double duration = 5;
  const Model model = rattleback();
  const Initial start{0, {0, 0, 0.019, 1, 0, 0, 0}, {0, 0, 0, 0.05, 0.02, -5}};
  Options options = testing::accurate(1e-13);
  options.project_initial = true;
  const Solution reference = solve(model, start, duration, options);
  for (const double accuracy : {1e-3, 1e-6, 1e-9}) {
    options.accuracy = accuracy;
    const Solution solution = solve(model, start, duration, options);
    ASSERT_EQ(solution.status().stop, Stop::reached_end) << solution.status().message;
    double speed = 0;
    double error = 0;
    for (int i = 0; i <= 50; ++i) {
      const State expected = reference.at(duration * i / 50);
      speed = std::max(speed, length(model, expected, expected.v));
      error = std::max(error, length(model, expected, solution.at(expected.time).v - expected.v));
    }
    EXPECT_LE(error, accuracy * speed) << "accuracy " << accuracy;
  }
}

}  // namespace
}  // namespace hybrid_sphere::mechanics::rattleback_test
