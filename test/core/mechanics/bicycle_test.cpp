// Whipple's bicycle: four rigid bodies, two wheels that roll. Parameters and eigenvalues: J. P. Meijaard, J.
// M. Papadopoulos, A. Ruina, A. L. Schwab, Linearized dynamics equations for the balance and steer of a
// bicycle, Proc. R. Soc. A 463 (2007) 1955-1982, tables 1 and 2.
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <vector>

#include "core/mechanics/particle.hpp"
#include "hybrid_sphere/mechanics/linearization.hpp"
#include "mechanics/decompositions/eigenvalues.hpp"

namespace hybrid_sphere::mechanics::bicycle_test {
namespace {

template <class T>
using Vector3 = Eigen::Matrix<T, 3, 1>;

constexpr double gravity = 9.81;
constexpr double tilt = M_PI / 10;  // of the steering axis [rad]
constexpr double rear_radius = 0.3;
constexpr double front_radius = 0.35;

// Places in the upright bicycle from the rear wheel's centre: forward, right, down [m].
const Eigen::Vector3d on_axis(1.02 + 0.08, 0, rear_radius);  // where the steering axis meets the ground
const Eigen::Vector3d body_center(0.3, 0, rear_radius - 0.9);
const Eigen::Vector3d fork_center(0.9, 0, rear_radius - 0.7);
const Eigen::Vector3d front_center(1.02, 0, rear_radius - front_radius);

/// With mass [kg] and principal or mixed moments of inertia [kg m^2].
struct Body {
  double mass, xx, yy, zz, xz;
};
constexpr Body rear_wheel{2, 0.0603, 0.12, 0.0603, 0};
constexpr Body frame{85, 9.2, 11, 2.8, 2.4};
constexpr Body fork{4, 0.05892, 0.06, 0.00708, -0.00756};
constexpr Body front_wheel{3, 0.1405, 0.28, 0.1405, 0};

template <class T>
Vector3<T> cross(const Vector3<T>& a, const Vector3<T>& b) {
  return {T(a[1] * b[2] - a[2] * b[1]), T(a[2] * b[0] - a[0] * b[2]), T(a[0] * b[1] - a[1] * b[0])};
}

template <class T>
T energy_of(const Body& body, const Vector3<T>& v, const Vector3<T>& w) {
  const T turning =
      body.xx * w[0] * w[0] + body.yy * w[1] * w[1] + body.zz * w[2] * w[2] + 2 * body.xz * w[0] * w[2];
  return (body.mass * (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]) + turning) / 2;
}

/// Turned about the steering axis, which points down and forward.
template <class T>
Vector3<T> steered(const Vector3<T>& r, const T& cosine, const T& sine) {
  const Vector3<T> axis(T(std::sin(tilt)), T(0.0), T(std::cos(tilt)));
  const T along = axis[0] * r[0] + axis[2] * r[2];
  return r * cosine + cross(axis, r) * sine + axis * T(along * (1 - cosine));
}

/// All that moves, in the frame of the rear body or of the fork.
/// q: the rear wheel's centre, yaw, roll, pitch, steer, angles of the rear and the front wheel; v = q'.
template <class T>
struct Motion {
  template <class Q, class V>
  Motion(const Q& q, const V& v) {
    using std::cos, std::sin;
    const T cy = cos(q[3]), sy = sin(q[3]), cr = cos(q[4]), sr = sin(q[4]), cp = cos(q[5]), sp = sin(q[5]);
    // rows: forward, right and down of the rear body in the world, Rz(yaw) Rx(roll) Ry(pitch) transposed
    Eigen::Matrix<T, 3, 3> R;
    R << cy * cp - sy * sr * sp, sy * cp + cy * sr * sp, -cr * sp,  //
        -sy * cr, cy * cr, sr,                                      //
        cy * sp + sy * sr * cp, sy * sp - cy * sr * cp, cr * cp;
    for (int i = 0; i < 3; ++i) {
      rear_velocity[i] = R(i, 0) * v[0] + R(i, 1) * v[1] + R(i, 2) * v[2];
      down[i] = R(i, 2);
    }
    const T yaw_down = v[3] * cr;
    spin = {T(v[4] * cp - yaw_down * sp), T(v[5] + v[3] * sr), T(v[4] * sp + yaw_down * cp)};
    const T cs = cos(q[6]), ss = sin(q[6]);
    const auto to_fork = [&](const Vector3<T>& r) { return steered<T>(r, cs, T(-ss)); };
    fork_down = to_fork(down);
    fork_spin = to_fork(spin) + Vector3<T>(T(std::sin(tilt) * v[6]), T(0.0), T(std::cos(tilt) * v[6]));
    const Vector3<T> pivot = to_fork(rear_velocity + cross<T>(spin, on_axis.cast<T>()));
    const Vector3<T> to_fork_center = (fork_center - on_axis).cast<T>();
    const Vector3<T> to_front_center = (front_center - on_axis).cast<T>();
    fork_velocity = pivot + cross(fork_spin, to_fork_center);
    front_velocity = pivot + cross(fork_spin, to_front_center);
    const Vector3<T> center = body_center.cast<T>();
    frame_velocity = rear_velocity + cross(spin, center);
    rear_spin = spin + Vector3<T>(T(0.0), T(v[7]), T(0.0));
    front_spin = fork_spin + Vector3<T>(T(0.0), T(v[8]), T(0.0));
    const auto depth = [](const Vector3<T>& axis, const Vector3<T>& r) {
      return T(axis[0] * r[0] + axis[1] * r[1] + axis[2] * r[2]);
    };
    const T pivot_depth = q[2] + depth(down, on_axis.cast<T>());
    potential = -gravity * (rear_wheel.mass * q[2] + frame.mass * (q[2] + depth(down, center)) +
                            fork.mass * (pivot_depth + depth(fork_down, to_fork_center)) +
                            front_wheel.mass * (pivot_depth + depth(fork_down, to_front_center)));
  }

  Vector3<T> down, rear_velocity, frame_velocity, spin, rear_spin;             // in the rear body
  Vector3<T> fork_down, fork_velocity, front_velocity, fork_spin, front_spin;  // in the fork
  T potential;
};

/// Velocity of the point of a wheel that touches the ground; its axle points to the right.
template <class T>
Vector3<T> contact_velocity(const Vector3<T>& center, const Vector3<T>& spin, const Vector3<T>& down,
                            double radius) {
  using std::sqrt;
  const T length = sqrt(down[0] * down[0] + down[2] * down[2]);
  const Vector3<T> arm(T(radius * down[0] / length), T(0.0), T(radius * down[2] / length));
  return center + cross(spin, arm);
}

Model bicycle() {
  const auto lagrangian = [](auto, const auto& q, const auto& v) {
    using T = std::decay_t<decltype(q[0] * v[0])>;
    const Motion<T> m(q, v);
    return T(energy_of(rear_wheel, m.rear_velocity, m.rear_spin) +
             energy_of(frame, m.frame_velocity, m.spin) + energy_of(fork, m.fork_velocity, m.fork_spin) +
             energy_of(front_wheel, m.front_velocity, m.front_spin) - m.potential);
  };
  System<9> system({"x", "y", "z", "yaw", "roll", "pitch", "steer", "rear", "front"}, lagrangian);
  system.constrain(
      "rear",
      [](auto, const auto& q, const auto& v) {
        using T = std::decay_t<decltype(q[0] * v[0])>;
        const Motion<T> m(q, v);
        return contact_velocity(m.rear_velocity, m.rear_spin, m.down, rear_radius);
      },
      always());
  system.constrain(
      "front",
      [](auto, const auto& q, const auto& v) {
        using T = std::decay_t<decltype(q[0] * v[0])>;
        const Motion<T> m(q, v);
        return contact_velocity(m.front_velocity, m.front_spin, m.fork_down, front_radius);
      },
      always());
  return system;
}

Initial straight(double speed) {
  return {0,
          {0, 0, -rear_radius, 0, 0, 0, 0, 0, 0},
          {speed, 0, 0, 0, 0, 0, 0, -speed / rear_radius, -speed / front_radius}};
}

TEST(Bicycle, HasThePublishedEigenvalues) {
  using Eigenvalues = std::vector<std::complex<double>>;
  const std::pair<double, Eigenvalues> cases[] = {
      {0, {3.131643247906560, -3.131643247906560, 5.530943717653927, -5.530943717653927}},
      {5,
       {{-0.775341882195845, 4.464867713788229},
        {-0.775341882195845, -4.464867713788229},
        -0.322866429004087,
        -14.078389692798220}}};
  const Model model = bicycle();
  for (const auto& [speed, expected] : cases) {
    const State state = solve(model, straight(speed), 0).at(0);
    const Eigen::VectorXcd found = eigenvalues(linearize(model, state).A);
    for (const std::complex<double>& eigenvalue : expected) {
      const double nearest = (found.array() - eigenvalue).abs().minCoeff();
      EXPECT_LE(nearest, 1e-8 * std::abs(eigenvalue)) << "speed " << speed << ", " << eigenvalue;
    }
  }
}

// A push at 5 m/s dies away, as the eigenvalues say; energy and contacts stay.
TEST(Bicycle, KeepsItsEnergyAndItsContacts) {
  const Model model = bicycle();
  Initial start = straight(5);
  start.v[4] = 0.05;
  for (const double accuracy : {1e-6, 1e-9, 1e-12}) {
    Options options = testing::accurate(accuracy);
    options.project_initial = true;
    const Solution solution = solve(model, start, 2, options);
    ASSERT_EQ(solution.status().stop, Stop::reached_end) << solution.status().message;
    const State first = solution.at(0);
    const State last = solution.at(2);
    EXPECT_NEAR(last.energy, first.energy, 4 * accuracy * first.kinetic_energy);
    EXPECT_LT(last.residual, 1e-12);
    EXPECT_LT(std::abs(last.v[4]), 0.05);
  }
}

}  // namespace
}  // namespace hybrid_sphere::mechanics::bicycle_test
