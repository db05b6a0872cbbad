#include <array>
#include <cmath>

#include "catalogue/entry_helpers.hpp"
#include "catalogue/quaternion.hpp"
#include "catalogue/sphere_formulas.hpp"
#include "catalogue/sphere_systems.hpp"
#include "hybrid_sphere/mechanics/by_hand.hpp"
#include "hybrid_sphere/mechanics/system.hpp"

namespace hybrid_sphere::mechanics::catalogue {
namespace chaplygin_ball_parts {
namespace {

constexpr const char* description =
    R"(Chaplygin's ball: mass centre in the middle, three moments of inertia; its ground suddenly grips it.

coordinates  x, y            centre of the ball [m]
             qw, qx, qy, qz  unit quaternion, from the body's axes to the fixed ones; of matrix S
velocities   x', y', and w1, w2, w3: angular velocity on the body's principal axes [rad/s]
             q' = q (0, w1, w2, w3) / 2
L            m (x'^2 + y'^2)/2 + (A w1^2 + B w2^2 + C w3^2)/2
Q            none
constraint   rolling, from t_switch on: the point of contact is at rest, with the angular velocity S w on the
             fixed axes two functions,
               f = (x' - R (S w)_2, y' + R (S w)_1)

Watch that stage 1 is Euler's top, which conserves its angular momentum S (A w1, B w2, C w3) about the centre, and
stage 3 conserves another one, about the point of contact:
               K = S (A w1, B w2, C w3) + m R^2 e_z x (S w x e_z)
The impulse leaves K as it is. The ball runs along a crooked path, of a mean direction across the level part of K.

known        K on the fixed axes and the energy: with them Chaplygin (1903) solved stage 3 by hyperelliptic
             functions. Known here where it is elementary:
             A = B = C: the sphere of paper_sphere_quasi, with k^2 = A/m;
             spinning in place about a principal axis that is vertical: for ever, whether stable or not.
source       S. A. Chaplygin, Mat. Sb. 24 (1903) 139; quasi-velocities: Mei (2005), (15).
limits       none; the quaternion is kept at unit length.
)";

void check_body(double m, double R, const Vector3d& moments) {
  Index i = 0;
  const double largest = moments.maxCoeff(&i);
  const double others = moments[(i + 1) % 3] + moments[(i + 2) % 3];
  constexpr std::array<const char*, 3> names = {"A", "B", "C"};
  if (largest > others) {
    refuse(names[static_cast<std::size_t>(i)], largest,
           "at most the sum of the other two moments of inertia, " + shortest(others));
  }
  const double most = 2 * m * R * R;  // all mass is within R
  if (moments.sum() > most) refuse("A + B + C", moments.sum(), "at most 2 m R^2 = " + shortest(most));
}

std::shared_ptr<const EquationsOfMotion> equations(double m, const Vector3d& moments) {
  return equations_by_hand(6, 5, [=](double /*t*/, const Vector& q, const Vector& v, MotionTerms& terms) {
    const Vector3d w = v.tail<3>();
    const Vector3d spin = moments.cwiseProduct(w);
    terms.rate << v.head<2>(), body_rate(q.tail<4>(), w);
    terms.mass.setZero();
    terms.mass.diagonal() << m, m, moments;
    terms.momentum << m * v.head<2>(), spin;
    terms.lagrangian = v.dot(terms.momentum) / 2;
    terms.force << 0, 0, spin.cross(w);
  });
}

// d(S w)/dt at constant w is S (w x w) = 0: no gamma.
std::shared_ptr<const ConstraintFunction> rolling(double R) {
  return constraint_by_hand(
      2, [R](double /*t*/, const Vector& q, const Vector& v, const Vector& /*rate*/, ConstraintTerms& terms) {
        terms.gradient.leftCols<2>().setIdentity();
        for (Index i = 0; i < 3; ++i) {
          const Vector3d axis = to_space(q.tail<4>(), Vector3d::Unit(i));
          terms.gradient.col(2 + i) << -R * axis.y(), R * axis.x();
        }
        terms.value = terms.gradient * v;
        terms.gamma.setZero();
      });
}

// With a constant angular velocity before the switch and another after it.
std::function<std::optional<Known>(double)> known(double R, double k, double t_switch,
                                                  const Initial& initial) {
  const Quaterniond start = orientation(initial.q);
  const Velocities free = {initial.v.head<2>(), start * Vector3d(initial.v.tail<3>())};
  const Velocities gripped = after_impulse(R, k, free, Vector2d::Zero());
  return [=](double t) -> std::optional<Known> {
    const double first = std::min(t, t_switch);
    const double second = t - first;
    const Velocities& now = t < t_switch ? free : gripped;
    const Quaterniond q = turn(second * gripped.spin) * turn(first * free.spin) * start;
    Known result{Vector(6), Vector(5), Vector::Zero(2)};
    result.q << initial.q.head<2>() + first * free.center + second * gripped.center, q.w(), q.vec();
    result.v << now.center, q.conjugate() * now.spin;
    return result;
  };
}

bool spins_upright(const Initial& initial) {
  const Vector3d w = initial.v.tail<3>();
  const Vector3d space = to_space(initial.q.tail<4>(), w);
  return initial.v.head<2>().isZero(0) && (w.array() != 0).count() == 1 && space.head<2>().isZero(0);
}

std::vector<Invariant> invariants(double m, double R, const Vector3d& moments) {
  std::vector<Invariant> result = {energy(), {"abs(q)", [](const State& s) { return s.q.tail<4>().norm(); }}};
  const std::array<const char*, 3> names = {"K1", "K2", "K3"};
  for (Index i = 0; i < 3; ++i) {
    result.push_back({names[static_cast<std::size_t>(i)], [=](const State& s) {
                        const Vector3d w = s.v.tail<3>();
                        const Vector3d about_center = to_space(s.q.tail<4>(), moments.cwiseProduct(w));
                        const Vector3d space = to_space(s.q.tail<4>(), w);
                        return about_center[i] + (i < 2 ? m * R * R * space[i] : 0);
                      }});
  }
  return result;
}

Example build(const Values& p) {
  const double m = p["m"], R = p["R"], A = p["A"], B = p["B"], C = p["C"];
  const Vector3d moments(A, B, C);
  check_body(m, R, moments);
  using Ball = System<5, 6>;
  const Ball::CoordinateNames coordinates = {"x", "y", "qw", "qx", "qy", "qz"};
  const Ball::VelocityNames velocities = {"x_dot", "y_dot", "w1", "w2", "w3"};

  Ball ball(
      coordinates, velocities,
      [](const auto& q, const auto& v) {
        Eigen::Matrix<typename std::decay_t<decltype(q)>::Scalar, 6, 1> rate;
        rate << v[0], v[1], body_rate(q.template tail<4>(), v.template tail<3>());
        return rate;
      },
      [=](auto /*t*/, const auto& /*q*/, const auto& v) {
        return m / 2 * (v[0] * v[0] + v[1] * v[1]) +
               (A * v[2] * v[2] + B * v[3] * v[3] + C * v[4] * v[4]) / 2;
      },
      NoForces());
  ball.constrain(
      "rolling",
      [=](auto /*t*/, const auto& q, const auto& v) {
        const auto w = to_space(q.template tail<4>(), v.template tail<3>());
        Eigen::Matrix<typename std::decay_t<decltype(v)>::Scalar, 2, 1> f;
        f << v[0] - R * w[1], v[1] + R * w[0];
        return f;
      },
      from(p["t_switch"]));
  ball.normalize = normalize_orientation;

  Ball by_hand(coordinates, velocities, equations(m, moments));
  by_hand.constrain("rolling", rolling(R), from(p["t_switch"]));
  by_hand.normalize = normalize_orientation;

  const Initial initial = initial_state_of_unit_length(ball, p);
  const bool elementary = (A == B && B == C) || spins_upright(initial);
  Example example{ball, by_hand, initial, {}, invariants(m, R, moments)};
  if (elementary) example.known = known(R, std::sqrt(A / m), p["t_switch"], initial);
  return example;
}

}  // namespace
}  // namespace chaplygin_ball_parts

Entry chaplygin_ball() {
  using namespace chaplygin_ball_parts;
  const Initial as_a_rule{0, vector({0.2, -0.1, 0.8, 0, 0.6, 0}), vector({0.6, -0.4, 1, 2.5, -1.5})};
  return {"chaplygin_ball",
          "Chaplygin's ball: three moments of inertia, no singular orientation",
          description,
          with_initial_values({positive("m", 1.5, "mass [kg]"), positive("R", 0.5, "radius [m]"),
                               positive("A", 0.08, "moment of inertia about the first body axis [kg m^2]"),
                               positive("B", 0.14, "about the second one [kg m^2]"),
                               positive("C", 0.17, "about the third one [kg m^2]"), switch_time(0.5)},
                              as_a_rule, {"the first body axis", "the second one", "the third one"}),
          6,
          0.5,
          build};
}

}  // namespace hybrid_sphere::mechanics::catalogue
