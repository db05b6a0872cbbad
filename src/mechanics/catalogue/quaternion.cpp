#include "hybrid_sphere/mechanics/catalogue/quaternion.hpp"

#include <stdexcept>

#include "hybrid_sphere/mechanics/catalogue/ingredients.hpp"

namespace hybrid_sphere::mechanics::catalogue {

Eigen::Quaterniond orientation(const Vector& q) { return {q[2], q[3], q[4], q[5]}; }

void normalize_orientation(Vector& q) { q.tail<4>().normalize(); }

std::vector<Parameter> orientation_parameters(const Eigen::Quaterniond& orientation) {
  const std::string meaning = "orientation at t = 0, of any length but 0";
  const auto component = [&meaning](const char* name, double value) {
    return Parameter{name, value, -1, 1, meaning};
  };
  return {component("qw", orientation.w()), component("qx", orientation.x()),
          component("qy", orientation.y()), component("qz", orientation.z())};
}

Initial initial_state_of_unit_length(const Model& model, const Values& values) {
  Initial initial = initial_state(model, values);
  const double length = initial.q.tail<4>().stableNorm();
  if (!(length > 1e-9)) {
    throw std::invalid_argument("qw, qx, qy, qz = 0: an orientation is a quaternion of any length but 0");
  }
  initial.q.tail<4>() /= length;
  return initial;
}

}  // namespace hybrid_sphere::mechanics::catalogue
