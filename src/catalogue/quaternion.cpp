#include "catalogue/quaternion.hpp"

#include <utility>

#include "catalogue/entry_helpers.hpp"

namespace hybrid_sphere::mechanics::catalogue {
namespace {

constexpr double least_length = 1e-9;  // of a quaternion that is given

}  // namespace

Eigen::Quaterniond orientation(const Vector& q) { return {q[2], q[3], q[4], q[5]}; }

void normalize_orientation(Vector& q) { q.tail<4>().normalize(); }

std::vector<Parameter> with_initial_values(std::vector<Parameter> constants, const Initial& as_a_rule,
                                           const std::array<std::string, 3>& axes) {
  const Vector &q = as_a_rule.q, &v = as_a_rule.v;
  std::vector<Parameter> all = std::move(constants);
  const auto orientation = [&](const char* name, double value) {
    all.push_back({name, value, -1, 1, "orientation at t = 0, of any length from " + shortest(least_length)});
  };
  all.push_back(number("x", q[0], "centre at t = 0 [m]"));
  all.push_back(number("y", q[1], "centre at t = 0 [m]"));
  orientation("qw", q[2]);
  orientation("qx", q[3]);
  orientation("qy", q[4]);
  orientation("qz", q[5]);
  all.push_back(number("x_dot", v[0], "velocity of the centre [m/s]"));
  all.push_back(number("y_dot", v[1], "velocity of the centre [m/s]"));
  all.push_back(number("w1", v[2], "angular velocity about " + axes[0] + " [rad/s]"));
  all.push_back(number("w2", v[3], "angular velocity about " + axes[1] + " [rad/s]"));
  all.push_back(number("w3", v[4], "angular velocity about " + axes[2] + " [rad/s]"));
  return all;
}

Initial initial_state_of_unit_length(const Model& model, const Values& values) {
  Initial initial = initial_state(model, values);
  const double length = initial.q.tail<4>().norm();
  if (!(length >= least_length)) {
    refuse("the length of qw, qx, qy, qz", length, "at least " + shortest(least_length));
  }
  initial.q.tail<4>() /= length;
  return initial;
}

}  // namespace hybrid_sphere::mechanics::catalogue
