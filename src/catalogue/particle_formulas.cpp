#include "catalogue/particle_formulas.hpp"

#include <cmath>

#include "catalogue/entry_helpers.hpp"
#include "hybrid_sphere/mechanics/by_hand.hpp"

namespace hybrid_sphere::mechanics::catalogue::particle {

std::shared_ptr<const EquationsOfMotion> equations_by_hand(double m) {
  return mechanics::equations_by_hand(3, 3, [m](double, const Vector&, const Vector& v, MotionTerms& terms) {
    terms.mass = vector({m, m, m}).asDiagonal();
    terms.momentum = m * v;
    terms.lagrangian = m / 2 * v.squaredNorm();
    terms.rate = v;
    terms.force.setZero();
  });
}

std::shared_ptr<const ConstraintFunction> constraint_by_hand() {
  return mechanics::constraint_by_hand(
      1, [](double, const Vector& q, const Vector& v, const Vector& rate, ConstraintTerms& terms) {
        terms.value << v[2] - q[1] * v[0];
        terms.gradient << -q[1], 0, 1;
        terms.gamma << rate[1] * v[0];
      });
}

Vector after_impulse(const Vector& q, const Vector& v) {
  const double y = q[1];
  const double along = (v[0] + y * v[2]) / (1 + y * y);
  return vector({along, v[1], y * along});
}

Known held(double m, const Known& start, double time) {
  const double y1 = start.q[1], rate = start.v[1], x_rate1 = start.v[0];
  const double y = y1 + rate * time;
  const double root1 = std::hypot(1, y1), root = std::hypot(1, y);
  const double speed = x_rate1 * root1;  // of x' and z' together: constant
  // asinh y - asinh y1 = 2 atanh(half), over y - y1
  const double half = (y - y1) / (root + root1);
  double mean = (half == 0 ? 1 : std::atanh(half) / half) * 2 / (root + root1);
  if (std::abs(half) > 0.5) mean = (std::asinh(y) - std::asinh(y1)) / (y - y1);
  const double x_rate = speed / root;
  return {
      vector({start.q[0] + speed * time * mean, y, start.q[2] + speed * time * ((y + y1) / (root + root1))}),
      vector({x_rate, rate, y * x_rate}), vector({m * (x_rate / root) * (rate / root)})};
}

std::vector<Parameter> parameters(const Parameter& between, const Initial& as_a_rule) {
  const Vector &q = as_a_rule.q, &v = as_a_rule.v;
  return {positive("m", 1.5, "mass [kg]"),         between,
          number("x", q[0], "place [m]"),          number("y", q[1], "place [m]; in the constraint a number"),
          number("z", q[2], "place [m]"),          number("x_dot", v[0], "velocity [m/s]"),
          number("y_dot", v[1], "velocity [m/s]"), number("z_dot", v[2], "velocity [m/s]")};
}

}  // namespace hybrid_sphere::mechanics::catalogue::particle
