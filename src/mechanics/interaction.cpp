#include "mechanics/interaction.hpp"

#include <algorithm>
#include <cfloat>

#include "hybrid_sphere/mechanics/equations_of_motion.hpp"

namespace hybrid_sphere::mechanics {
namespace {

// Round-off of a direction beyond which it counts as undefined.
constexpr double max_direction_roundoff = 1e-6;

/// The line from a point of the first body to one of the second.
struct LineMotion {
  PointMotion first;
  PointMotion second;
  Eigen::Vector3d apart;
  Eigen::Vector3d rate;

  LineMotion(const LinePoints& points, const Interaction::Bodies& bodies)
      : first(bodies[0], points.first),
        second(bodies[1], points.second),
        apart(second.place - first.place),
        rate(second.rate - first.rate) {}

  /// Unit vector from the first to the second point. Throws Undefined if they coincide up to round-off.
  Eigen::Vector3d direction(const Interaction::Bodies& bodies, const std::string& label) const {
    const double length = apart.norm();
    double size = 0;
    for (const Eigen::Vector3d& place : {first.place, second.place, bodies[0].x, bodies[1].x}) {
      size = std::max(size, place.cwiseAbs().maxCoeff());
    }
    if (length * max_direction_roundoff <= DBL_EPSILON * size || length == 0) {
      throw Undefined(label, "the points of " + label + " coincide, and its force has no direction there");
    }
    return apart / length;
  }

  /// A force on the second body at its point as a wrench about its centre of mass.
  Wrench wrench(const Eigen::Vector3d& force, const Interaction::Bodies& bodies) const {
    return {force, (second.place - bodies[1].x).cross(force)};
  }
};

}  // namespace

BodyState state_of(const BodyMotion& body) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = body.R;
  pose.translation() = body.x;
  return {pose, {body.v, body.R * body.w}};
}

Wrench SpringInteraction::wrench(double /*t*/, const Bodies& bodies) const {
  const LineMotion line(points_, bodies);
  if (natural_length_ == 0) return line.wrench(-stiffness_ * line.apart, bodies);
  const double tension = stiffness_ * (line.apart.norm() - natural_length_);
  return line.wrench(-tension * line.direction(bodies, label()), bodies);
}

double SpringInteraction::potential(const Bodies& bodies) const {
  const double elongation = LineMotion(points_, bodies).apart.norm() - natural_length_;
  return stiffness_ / 2 * elongation * elongation;
}

Wrench DamperInteraction::wrench(double /*t*/, const Bodies& bodies) const {
  const LineMotion line(points_, bodies);
  const Eigen::Vector3d along = line.direction(bodies, label());
  return line.wrench(-coefficient_ * along.dot(line.rate) * along, bodies);
}

}  // namespace hybrid_sphere::mechanics
