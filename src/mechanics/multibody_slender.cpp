// Point masses and thin rods of a MultibodySystem: bodies without all moments of inertia.
#include <algorithm>
#include <cfloat>
#include <cmath>
#include <string>

#include "hybrid_sphere/mechanics/multibody_system.hpp"
#include "mechanics/check_body.hpp"
#include "mechanics/rigid_body_equations.hpp"

namespace hybrid_sphere::mechanics {
namespace {

// Operations whose round-off may be in a lever arm that is meant to be 0.
constexpr double arm_operations = 1000;

/// Coordinates at which no body is aligned with another one by chance.
Vector turned(const Vector& q) {
  Vector result = q;
  double number = 0;
  for (Index first = 0; first < q.size(); first += body_coordinates) {
    number += 1;
    result.segment<3>(first) += Eigen::Vector3d(0.31, -0.17, 0.23) * number;
    result.segment<4>(first + 3) += Eigen::Vector4d(0.21, 0.13 + 0.07 * number, -0.37, 0.29 - 0.05 * number);
  }
  return result;
}

/// Whether a constraint acts on the rotation of a body about the axes that have no moment of inertia.
bool acts_on_rotation(const ConstraintFunction& function, const Vector& q, Index body,
                      const Eigen::Vector3d& stand_in) {
  Vector value;
  Matrix gradient;
  try {
    function.evaluate(0, q, Vector::Zero(q.size() / body_coordinates * body_velocities), value, gradient);
  } catch (const NumericalError&) {
    return true;
  }
  const double size = gradient.cwiseAbs().maxCoeff() + q.cwiseAbs().maxCoeff();
  for (Index i = 0; i < 3; ++i) {
    const double arm = gradient.col(body_velocities * body + 3 + i).cwiseAbs().maxCoeff();
    if (stand_in[i] > 0 && arm > arm_operations * DBL_EPSILON * size) return true;
  }
  return false;
}

/// Returns the rotation of least angle that takes the z axis to the direction of `line`: that of
/// Quaterniond::FromTwoVectors, which decomposes a matrix for a line along -z and takes two seconds to
/// compile.
Eigen::Quaterniond turn_of_z_to(const Eigen::Vector3d& line) {
  constexpr double max_cosine_of_opposite = -1 + 1e-12;  // the sum 1 + cosine loses all its digits below
  const Eigen::Vector3d z = Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d unit = line.normalized();
  const double cosine = unit.dot(z);
  const Eigen::Vector3d axis = z.cross(unit);
  Eigen::Quaterniond turn(0, -1, 0, 0);
  if (!(cosine < max_cosine_of_opposite)) {
    const double length = std::sqrt((1 + cosine) * 2);
    turn.vec() = axis * (1 / length);
    turn.w() = 0.5 * length;
  } else if (axis.norm() > DBL_EPSILON) {
    const double square = 0.5 * (1 + std::max(cosine, -1.0));
    turn.vec() = axis.normalized() * std::sqrt(1 - square);
    turn.w() = std::sqrt(square);
  }
  return turn;
}

}  // namespace

MultibodySystem& MultibodySystem::point_mass(const std::string& name, double mass,
                                             const Eigen::Vector3d& position) {
  check_finite(subject_of_body(name, mass), "position", position);
  constexpr double length = 1;  // [m] arbitrary: nothing turns it
  return add_body(name, mass, Eigen::Matrix3d::Zero(), Eigen::Vector3d::Constant(mass * length * length),
                  Eigen::Isometry3d(Eigen::Translation3d(position)));
}

MultibodySystem& MultibodySystem::thin_rod(const std::string& name, double mass,
                                           const Eigen::Vector3d& first_end,
                                           const Eigen::Vector3d& second_end) {
  const std::string subject = subject_of_body(name, mass);
  check_finite(subject, "first end", first_end);
  check_finite(subject, "second end", second_end);
  const Eigen::Vector3d line = second_end - first_end;
  const double length = line.stableNorm();
  check_positive(subject, "length", length);
  const double moment = mass * length * length / 12;
  check_positive(subject, "moment of inertia", moment);
  Eigen::Isometry3d placement(turn_of_z_to(line));
  placement.pretranslate(first_end + line / 2);
  // With the same moment about all axes a rotation about its line stays as it is.
  return add_body(name, mass, Eigen::Vector3d(moment, moment, 0).asDiagonal(), {0, 0, moment}, placement);
}

void MultibodySystem::refuse_unseen_rotations(const std::string& subject,
                                              const ConstraintFunction& function) const {
  const RigidBodyEquations& bodies = RigidBodyEquations::of(*this);
  for (Index i = 0; i < bodies.count(); ++i) {
    const RigidBodyEquations::Body& body = bodies.body(i);
    if (body.stand_in.isZero(0)) continue;
    const Vector q = placed();
    if (!acts_on_rotation(function, q, i, body.stand_in) &&
        !acts_on_rotation(function, turned(q), i, body.stand_in)) {
      continue;
    }
    const bool is_rod = body.stand_in[0] == 0;
    refuse_part(
        subject,
        std::string("a part that acts on the rotation of ") +
            (is_rod ? "thin rod \"" + body.name + "\" about its line" : "point mass \"" + body.name + "\""),
        is_rod ? "parts that act at points of its line, or a body() with moments of inertia"
               : "parts that act at its position, or a body() with moments of inertia");
  }
}

void MultibodySystem::stop_unseen_rotations(Vector& v) const {
  const RigidBodyEquations& bodies = RigidBodyEquations::of(*this);
  for (Index i = 0; i < bodies.count(); ++i) {
    const RigidBodyEquations::Body& body = bodies.body(i);
    for (Index k = 0; k < 3; ++k) {
      if (body.stand_in[k] > 0) v[body_velocities * i + 3 + k] = 0;
    }
  }
}

}  // namespace hybrid_sphere::mechanics
