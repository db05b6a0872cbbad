#include "mechanics/movable_part.hpp"

#include <cmath>

namespace hybrid_sphere::mechanics {

Vector movable_part(const Eigen::Matrix2d& effect, const Vector& push) {
  constexpr double none = 1e-12;  // of the squared effect: the sine of an angle between its columns
  const double size = effect.norm();
  if (!(std::abs(effect.determinant()) <= none * size * size) || size == 0) return push;
  const Eigen::Vector2d way = effect.col(effect.col(0).norm() < effect.col(1).norm() ? 1 : 0).normalized();
  const double along = way.dot(push.head<2>());
  return along == 0 ? push : Vector(along * way);
}

}  // namespace hybrid_sphere::mechanics
