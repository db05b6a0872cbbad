#pragma once

#include "hybrid_sphere/sphere/sphere.hpp"
#include "simulation/arrival.hpp"
#include "simulation/constraint.hpp"

namespace hybrid_sphere {

/// What holds the sphere before a switch.
struct Before {
  bool has_acted;  ///< whether any ground has acted on the sphere since it was put there
  ContactMode mode;
  const scene::Material& material;  ///< of the segment
  const Constraint& constraint;
};

/// A reset: the impulse of a ground, and the contact mode after it.
struct Reset {
  ContactMode mode = ContactMode::free;
  Vector2d slip_before = Vector2d::Zero();      ///< relative to the ground entered [m/s]
  Vector2d impulse = Vector2d::Zero();          ///< of the ground on the sphere [N s]
  Vector3d angular_impulse = Vector3d::Zero();  ///< about the centre [N m s]
  bool jumps() const { return !impulse.isZero(0) || angular_impulse.z() != 0; }
};

/// Where stages switch: what the velocities jump to, and which contact mode follows, where the sphere comes
/// to a ground and where its motion ends. Depends on nothing but what it is asked about. Source:
/// docs/theory.md 4.6, 5.2.
class SwitchingRules {
 public:
  /// @param sphere, dynamics  have to live as long as this
  /// @param rounding          what is computed from speeds so far may be off by that, at most [m/s]
  SwitchingRules(const Sphere& sphere, const Dynamics& dynamics, double rounding)
      : sphere_(&sphere), dynamics_(&dynamics), rounding_(rounding) {}

  /// What the law of a ground does at once to a sphere that comes to it, and what it does from then on.
  /// @param arrival  its velocities become those after the impulse
  Reset enter(const scene::Material& ground, const Before& before, Arrival& arrival) const;

  /// What is exactly so at the end of a motion, and how it goes on where that is known.
  /// @param mode  in which the sphere has been
  void end_motion(MotionEnd reason, ContactMode mode, const scene::Material& ground, Arrival& arrival) const;

  /// Lets the ground hold the sphere where rounding does not tell whether it does: the limit is raised by a
  /// little. @return  false where even that does not hold it
  bool hold(const scene::Material& ground, Arrival& arrival) const;
  /// What is left of the velocities relative to the ground is none.
  void stop(const scene::Material& ground, Arrival& arrival) const;

  /// On a straight line the velocities lie along it: what has become slow has the rounding of what was fast
  /// across it, and would leave the line. What moves as the ground does goes on doing so exactly.
  /// @param line    its direction, 0 for none
  /// @param ground  its velocity [m/s]
  /// @return whether that takes away all that slips or turns: then the contact may have another mode
  bool keep_on_line(const Vector2d& line, const Vector2d& ground, Segment::Start& state) const;

  /// The velocity across an edge is 0; what rounding leaves of it leads into the ground.
  /// @param normal  into it, of length 1
  void stop_across(const Vector2d& normal, Arrival& arrival) const;

 private:
  bool goes_on_over(const scene::Material& ground, const Before& before, const Arrival& arrival) const;
  Reset enter_coulomb(const scene::Material& ground, const Vector2d& slip, Arrival& arrival) const;
  Twist stopped(const Segment::Start& state, const Vector2d& slip, const Vector2d& u) const;

  const Sphere* sphere_;
  const Dynamics* dynamics_;
  double rounding_;
};

}  // namespace hybrid_sphere
