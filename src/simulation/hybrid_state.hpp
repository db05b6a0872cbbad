#pragma once

#include <cfloat>
#include <memory>

#include "ground/ground.hpp"
#include "hybrid_sphere/sphere/sphere.hpp"
#include "simulation/constraint.hpp"
#include "simulation/edge_contacts.hpp"
#include "simulation/segment.hpp"
#include "simulation/split_time.hpp"
#include "simulation/switching_rules.hpp"

namespace hybrid_sphere {

/// The constraint in force, and the grounds that impose it.
struct InForce {
  RegionId region = no_region;   ///< no_region until a ground has acted
  RegionId partner = no_region;  ///< the other ground of an edge slide
  SharedEdge edge{};             ///< of an edge slide
  Constraint constraint{};
  ContactMode mode = ContactMode::free;  ///< of the last switch, or of the ground entered without one
  /// sigma over a segment of constant twist: exactly that of the ground if the ground holds the sphere [m/s].
  Vector2d contact_velocity = Vector2d::Zero();
};

/// The state of the hybrid system between two instants: what is in force, and the motion under it.
struct HybridState {
  HybridState(const scene::Scene& scene)
      : sphere(scene.sphere),
        ground(std::make_shared<const Ground>(scene.surface)),
        segment(Dynamics(sphere, scene.forces), scene.solver) {}

  /// Since the beginning of the segment, >= 0 [s].
  double tau_at(double time) const { return std::max(0.0, epoch.until(time)); }

  /// Bound on the rounding error of what is computed from the speeds so far [m/s].
  double rounding_of_speeds() const { return 32 * DBL_EPSILON * fastest; }
  SwitchingRules rules() const { return {sphere, segment.dynamics(), rounding_of_speeds()}; }

  const Sphere sphere;
  std::shared_ptr<const Ground> ground;
  InForce in_force;
  SplitTime epoch;  ///< beginning of the segment
  Segment segment;  ///< since then
  double fastest =
      0;  ///< speed of the centre or of the contact with which a segment began, since time 0 [m/s]
};

}  // namespace hybrid_sphere
