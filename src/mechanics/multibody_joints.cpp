// Coordinates, drives and limits of the joints of a MultibodySystem.
#include <cmath>

#include "hybrid_sphere/mechanics/multibody_system.hpp"
#include "mechanics/check_body.hpp"
#include "mechanics/joint_axis.hpp"
#include "mechanics/joint_limit.hpp"
#include "text/refusal.hpp"

namespace hybrid_sphere::mechanics {
namespace {

void check_bounds(const std::string& subject, bool is_hinge, double lower, double upper) {
  const auto refuse = [&](const char* name, double value, const std::string& allowed) {
    refuse_part(subject, name + (" = " + text::shortest(value)), allowed);
  };
  if (is_hinge && !(lower > -M_PI)) refuse("lower", lower, "a number > -pi");
  if (is_hinge && !(upper < M_PI)) refuse("upper", upper, "a number < pi");
  if (std::isnan(lower) || !(lower < HUGE_VAL)) refuse("lower", lower, "a number, or -infinity");
  if (!(upper > lower)) refuse("upper", upper, "a number > lower = " + text::shortest(lower));
}

}  // namespace

MultibodySystem& MultibodySystem::add_axis(const std::string& joint, bool is_hinge,
                                           const std::pair<Index, Index>& bodies,
                                           const Eigen::Vector3d& point, const Eigen::Vector3d& axis) {
  const Eigen::Isometry3d one = placement(bodies.first);
  const Eigen::Isometry3d other = placement(bodies.second);
  const Eigen::Vector3d across = axis.unitOrthogonal();
  const auto on = [](const Eigen::Isometry3d& body, const Eigen::Vector3d& direction) {
    return Eigen::Vector3d(body.linear().transpose() * direction);
  };
  axes_.push_back(std::make_shared<JointAxis>(JointAxis{joint,
                                                        is_hinge,
                                                        {bodies.first, bodies.second},
                                                        on(one, axis),
                                                        on(one, across),
                                                        on(other, across),
                                                        on(one, point - one.translation()),
                                                        on(other, point - other.translation())}));
  return *this;
}

std::shared_ptr<const JointAxis> MultibodySystem::axis_of(const std::string& subject,
                                                          const std::string& joint, JointKind kind) const {
  std::string known;
  for (const auto& axis : axes_) {
    if (kind != JointKind::any && axis->is_hinge != (kind == JointKind::hinge)) continue;
    if (axis->joint == joint) return axis;
    known += (known.empty() ? "" : ", ") + axis->joint;
  }
  const std::string name = kind == JointKind::hinge    ? "hinge"
                           : kind == JointKind::slider ? "slider"
                                                       : "joint";
  refuse_part(subject, name + " = \"" + joint + "\"",
              known.empty() ? "none, as there is no " + (name == "joint" ? "hinge or slider" : name) : known);
}

double MultibodySystem::angle(const Vector& q, const std::string& hinge) const {
  const auto axis = axis_of("angle", hinge, JointKind::hinge);
  check_size("q", q, equations->coordinates());
  return axis->motion(axis->at(q)).value;
}

double MultibodySystem::angle_rate(const Vector& q, const Vector& v, const std::string& hinge) const {
  const auto axis = axis_of("angle rate", hinge, JointKind::hinge);
  check_size("q", q, equations->coordinates());
  check_size("v", v, equations->velocities());
  return axis->motion(axis->at(q, v)).rate;
}

double MultibodySystem::displacement(const Vector& q, const std::string& slider) const {
  const auto axis = axis_of("displacement", slider, JointKind::slider);
  check_size("q", q, equations->coordinates());
  return axis->motion(axis->at(q)).value;
}

double MultibodySystem::displacement_rate(const Vector& q, const Vector& v, const std::string& slider) const {
  const auto axis = axis_of("displacement rate", slider, JointKind::slider);
  check_size("q", q, equations->coordinates());
  check_size("v", v, equations->velocities());
  return axis->motion(axis->at(q, v)).rate;
}

MultibodySystem& MultibodySystem::torque(const std::string& hinge, DriveFunction torque) {
  const std::string subject = "torque of joint \"" + hinge + "\"";
  auto axis = axis_of(subject, hinge, JointKind::hinge);
  if (!torque) refuse_part(subject, "no function", "a function");
  return add(
      std::make_shared<DriveInteraction>("torque of joint " + hinge, std::move(axis), std::move(torque)));
}

MultibodySystem& MultibodySystem::force(const std::string& slider, DriveFunction force) {
  const std::string subject = "force of joint \"" + slider + "\"";
  auto axis = axis_of(subject, slider, JointKind::slider);
  if (!force) refuse_part(subject, "no function", "a function");
  return add(
      std::make_shared<DriveInteraction>("force of joint " + slider, std::move(axis), std::move(force)));
}

MultibodySystem& MultibodySystem::limit(const std::string& joint, double lower, double upper,
                                        double restitution) {
  const std::string subject = "limit of joint \"" + joint + "\"";
  const auto axis = axis_of(subject, joint, JointKind::any);
  check_bounds(subject, axis->is_hinge, lower, upper);
  if (!(restitution >= 0 && restitution <= 1)) {
    refuse_part(subject, "restitution = " + text::shortest(restitution), "0 to 1");
  }
  const auto add_bound = [&](const std::string& name, double sign, double bound) {
    if (!std::isfinite(bound)) return;
    const JointBound limit{axis, sign, bound};
    Constraint constraint{name, std::make_shared<LimitConstraint>("constraint " + name, limit), {}};
    constraint.schedule.guard = std::make_shared<LimitGuard>("guard of constraint " + name, limit);
    constraint.unilateral = Unilateral{restitution};
    constraints.push_back(std::move(constraint));
  };
  add_bound(joint + ".lower", 1, lower);
  add_bound(joint + ".upper", -1, upper);
  return *this;
}

}  // namespace hybrid_sphere::mechanics
