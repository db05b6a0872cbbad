#include "hybrid_sphere/mechanics/multibody_system.hpp"

#include <algorithm>
#include <stdexcept>

#include "mechanics/check_body.hpp"
#include "mechanics/consistent_velocities.hpp"
#include "mechanics/rigid_body_equations.hpp"
#include "text/refusal.hpp"

namespace hybrid_sphere::mechanics {
namespace {

constexpr const char* world = "world";

/// Scales the quaternions to unit length. One of length 0 becomes NaN, which is refused or reported.
void normalize_all(Vector& q) {
  for (Index first = 0; first < q.size(); first += body_coordinates) {
    auto quaternion = q.segment<4>(first + 3);
    const double length = quaternion.stableNorm();
    quaternion /= length;
    quaternion /= quaternion.norm();
  }
}

}  // namespace

MultibodySystem::MultibodySystem(const Eigen::Vector3d& gravity) {
  check_finite("multibody system", "gravity", gravity);
  equations = std::make_shared<RigidBodyEquations>(gravity);
  normalize = normalize_all;
}

MultibodySystem& MultibodySystem::body(const std::string& name, double mass, const Inertia& inertia,
                                       const Eigen::Isometry3d& placement) {
  const std::string subject = subject_of_body(name, mass);
  const Eigen::Matrix3d moments = checked_inertia(subject, inertia);
  return add_body(name, mass, moments, Eigen::Vector3d::Zero(), checked_placement(subject, placement));
}

std::string MultibodySystem::subject_of_body(const std::string& name, double mass) const {
  std::string subject = "body \"" + name + "\"";
  if (name.empty() || name == world) refuse_part(subject, "its name", "any but none and \"world\"");
  if (std::find(names_.begin(), names_.end(), name) != names_.end()) {
    refuse_part(subject, "a second one of this name", "a name of its own");
  }
  check_positive(subject, "mass", mass);
  return subject;
}

MultibodySystem& MultibodySystem::add_body(const std::string& name, double mass,
                                           const Eigen::Matrix3d& moments, const Eigen::Vector3d& stand_in,
                                           const Eigen::Isometry3d& placement) {
  auto next = std::make_shared<RigidBodyEquations>(RigidBodyEquations::of(*this));
  next->add({name, mass, moments + Eigen::Matrix3d(stand_in.asDiagonal()), stand_in});
  names_.push_back(name);
  placements_.push_back(placement);
  for (const char* coordinate : {".x", ".y", ".z", ".qw", ".qx", ".qy", ".qz"}) {
    coordinates.push_back(name + coordinate);
  }
  for (const char* velocity : {".vx", ".vy", ".vz", ".w1", ".w2", ".w3"}) {
    velocities.push_back(name + velocity);
  }
  equations = std::move(next);
  return *this;
}

MultibodySystem& MultibodySystem::body(const std::string& name, double mass, const Inertia& inertia,
                                       const Eigen::Vector3d& center) {
  return body(name, mass, inertia, Eigen::Isometry3d(Eigen::Translation3d(center)));
}

MultibodySystem& MultibodySystem::apply(const std::string& body, const Wrench& wrench) {
  const std::string subject = "wrench of body \"" + body + "\"";
  check_finite(subject, "force", wrench.force);
  check_finite(subject, "torque", wrench.torque);
  return apply(body, [wrench](double /*t*/, const BodyState& /*state*/) { return wrench; });
}

MultibodySystem& MultibodySystem::apply(const std::string& body, WrenchFunction wrench) {
  const std::string subject = "wrench of body \"" + body + "\"";
  const Index index = index_of_body(subject, body);
  if (!wrench) refuse_part(subject, "no function", "a function");
  auto next = std::make_shared<RigidBodyEquations>(RigidBodyEquations::of(*this));
  next->apply(index, std::move(wrench));
  equations = std::move(next);
  return *this;
}

MultibodySystem& MultibodySystem::add(std::shared_ptr<const Interaction> interaction) {
  auto next = std::make_shared<RigidBodyEquations>(RigidBodyEquations::of(*this));
  next->add(std::move(interaction));
  equations = std::move(next);
  return *this;
}

Index MultibodySystem::index_of(const std::string& subject, const std::string& body) const {
  if (body == world) return world_body;
  const auto place = std::find(names_.begin(), names_.end(), body);
  if (place != names_.end()) return place - names_.begin();
  std::string known = world;
  for (const std::string& name : names_) known += ", " + name;
  refuse_part(subject, "body = \"" + body + "\"", known);
}

Index MultibodySystem::index_of_body(const std::string& subject, const std::string& body) const {
  const Index index = index_of(subject, body);
  if (index == world_body) refuse_part(subject, "body = \"world\"", "a body");
  return index;
}

Eigen::Isometry3d MultibodySystem::placement(Index body) const {
  return body == world_body ? Eigen::Isometry3d::Identity() : placements_[static_cast<std::size_t>(body)];
}

Initial MultibodySystem::initial(const std::vector<std::pair<std::string, Twist>>& given) const {
  Initial initial;
  initial.q = placed();
  initial.v.setZero(equations->velocities());
  std::vector<bool> is_given(velocities.size(), false);
  for (const auto& [name, twist] : given) {
    const std::string subject = "initial velocity of body \"" + name + "\"";
    const Index body = index_of_body(subject, name);
    const Index first = body_velocities * body;
    const auto flag = is_given.begin() + first;
    if (*flag) refuse_part(subject, "a second one", "one for each body");
    check_finite(subject, "velocity", twist.velocity);
    check_finite(subject, "angular velocity", twist.angular_velocity);
    initial.v.segment<3>(first) = twist.velocity;
    initial.v.segment<3>(first + 3) = BodyMotion::at(body, initial.q).R.transpose() * twist.angular_velocity;
    std::fill(flag, flag + body_velocities, true);
  }
  initial.v = consistent_velocities(*this, initial.time, initial.q, initial.v, is_given);
  stop_unseen_rotations(initial.v);
  return initial;
}

Vector MultibodySystem::placed() const {
  Vector q(equations->coordinates());
  for (std::size_t i = 0; i < placements_.size(); ++i) {
    const Index first = body_coordinates * static_cast<Index>(i);
    const Eigen::Quaterniond turn(placements_[i].linear());
    q.segment<3>(first) = placements_[i].translation();
    q.segment<4>(first + 3) << turn.w(), turn.vec();
  }
  normalize(q);
  return q;
}

Eigen::Isometry3d MultibodySystem::pose(const Vector& q, const std::string& body) const {
  check_size("q", q, equations->coordinates());
  return pose_of_body(index_of_body("pose", body), q);
}

std::vector<Eigen::Isometry3d> MultibodySystem::poses(const Vector& q) const {
  check_size("q", q, equations->coordinates());
  std::vector<Eigen::Isometry3d> all;
  for (std::size_t i = 0; i < names_.size(); ++i) all.push_back(pose_of_body(static_cast<Index>(i), q));
  return all;
}

Twist MultibodySystem::twist(const Vector& q, const Vector& v, const std::string& body) const {
  check_size("q", q, equations->coordinates());
  check_size("v", v, equations->velocities());
  return state_of_body(index_of_body("twist", body), q, v).twist;
}

Eigen::Vector3d MultibodySystem::velocity(const Vector& q, const Vector& v, const std::string& body,
                                          const Eigen::Vector3d& point) const {
  const BodyState state{pose(q, body), twist(q, v, body)};
  return state.twist.velocity + state.twist.angular_velocity.cross(state.pose.linear() * point);
}

}  // namespace hybrid_sphere::mechanics
