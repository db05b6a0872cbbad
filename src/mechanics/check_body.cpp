#include "mechanics/check_body.hpp"

#include <Eigen/Eigenvalues>
#include <cfloat>
#include <cmath>
#include <stdexcept>

#include "text/refusal.hpp"

namespace hybrid_sphere::mechanics {
namespace {

std::string text_of(const Eigen::Vector3d& value) {
  return "(" + text::shortest(value[0]) + ", " + text::shortest(value[1]) + ", " + text::shortest(value[2]) +
         ")";
}

}  // namespace

void refuse_part(const std::string& subject, const std::string& what, const std::string& allowed) {
  throw std::invalid_argument(subject + ": " + text::refusal(what, allowed));
}

void check_positive(const std::string& subject, const std::string& what, double value) {
  if (value > 0 && std::isfinite(value)) return;
  refuse_part(subject, what + " = " + text::shortest(value), "a number > 0");
}

void check_finite(const std::string& subject, const std::string& what, const Eigen::Vector3d& value) {
  if (!value.allFinite()) refuse_part(subject, what + " = " + text_of(value), "finite numbers");
}

void check_size(const std::string& name, const Vector& vector, Index size) {
  if (vector.size() == size) return;
  throw std::invalid_argument(text::refusal(name + " of " + std::to_string(vector.size()) + " numbers",
                                            std::to_string(size) + " numbers"));
}

Eigen::Vector3d checked_direction(const std::string& subject, const std::string& what,
                                  const Eigen::Vector3d& value) {
  const double length = value.stableNorm();
  if (!(length > 0 && std::isfinite(length))) {
    refuse_part(subject, what + " = " + text_of(value), "a vector of a length > 0");
  }
  const Eigen::Vector3d direction = value / length;
  return direction.normalized();
}

Eigen::Matrix3d checked_inertia(const std::string& subject, const Inertia& inertia) {
  constexpr double rounding = 64 * DBL_EPSILON;
  const Eigen::Matrix3d& I = inertia.matrix;
  const double size = I.cwiseAbs().maxCoeff();
  if (!(I.allFinite() && size > 0)) refuse_part(subject, "inertia", "finite numbers, not all 0");
  const Eigen::Matrix3d skew = (I - I.transpose()) / 2;
  if (skew.cwiseAbs().maxCoeff() > rounding * size) {
    Eigen::Index row = 0;
    Eigen::Index column = 0;
    skew.cwiseAbs().maxCoeff(&row, &column);
    refuse_part(subject,
                "inertia with (" + std::to_string(row + 1) + ", " + std::to_string(column + 1) +
                    ") = " + text::shortest(I(row, column)) + " and its mirror image " +
                    text::shortest(I(column, row)),
                "a symmetric matrix");
  }
  Eigen::Matrix3d symmetric = (I + I.transpose()) / 2;
  const Eigen::Vector3d moments =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(symmetric, Eigen::EigenvaluesOnly).eigenvalues();
  const std::string which = "inertia with the principal moments " + text_of(moments);
  if (!(moments[0] > rounding * size)) refuse_part(subject, which, "moments > 0");
  if (moments[2] > moments[0] + moments[1] + rounding * size) {
    refuse_part(subject, which, "a largest moment of at most the sum of the others");
  }
  return symmetric;
}

Eigen::Isometry3d checked_placement(const std::string& subject, const Eigen::Isometry3d& placement) {
  constexpr double allowed = 1e-9;
  check_finite(subject, "centre", placement.translation());
  const Eigen::Matrix3d R = placement.linear();
  const double off = (R.transpose() * R - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  if (!R.allFinite()) refuse_part(subject, "placement with axes that are not finite", "a rotation, to 1e-9");
  if (off <= allowed && R.determinant() < 0) {
    refuse_part(subject, "placement with left-handed axes, of determinant -1",
                "a rotation, of determinant 1");
  }
  if (!(off <= allowed)) {
    refuse_part(subject,
                "placement whose axes are off unit length and right angles by " + text::shortest(off),
                "a rotation, to 1e-9");
  }
  Eigen::Isometry3d result = placement;
  result.linear() = Eigen::Quaterniond(R).normalized().toRotationMatrix();
  return result;
}

}  // namespace hybrid_sphere::mechanics
