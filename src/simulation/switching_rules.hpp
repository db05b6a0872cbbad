#pragma once

#include <optional>

#include "hybrid_sphere/sphere/sphere.hpp"
#include "simulation/arrival.hpp"
#include "simulation/constraint.hpp"
#include "simulation/edge_line.hpp"

namespace hybrid_sphere {

/// What holds the sphere before a switch.
struct Before {
  bool has_acted;  ///< whether any ground has acted on the sphere since it was put there
  ContactMode mode;
  const scene::Material& material;  ///< of the segment
  const Constraint& constraint;
};

/// A reset: the impulse of a ground and the contact mode after it.
struct Reset {
  ContactMode mode = ContactMode::free;
  Vector2d slip_before = Vector2d::Zero();      ///< relative to the ground entered [m/s]
  Vector2d impulse = Vector2d::Zero();          ///< of the ground on the sphere [N s]
  Vector3d angular_impulse = Vector3d::Zero();  ///< about the centre [N m s]
  bool jumps() const { return !impulse.isZero(0) || angular_impulse.z() != 0; }
};

/// The rules by which stages switch: what the velocities jump to and which contact mode follows when the
/// sphere reaches a ground or its motion ends. The results depend on the arguments alone. Source:
/// docs/theory.md 4.6, 5.2.
class SwitchingRules {
 public:
  /// @param sphere, dynamics  must outlive this object
  /// @param rounding          bound on the rounding error of what is computed from the speeds so far [m/s]
  SwitchingRules(const Sphere& sphere, const Dynamics& dynamics, double rounding)
      : sphere_(&sphere), dynamics_(&dynamics), rounding_(rounding) {}

  /// What the law of a ground does instantly to a sphere that reaches it, and what it does from then on.
  /// @param arrival  its velocities are set to those after the impulse
  Reset apply_reset(const scene::Material& ground, const Before& before, Arrival& arrival) const;

  /// Sets what holds exactly at the end of a motion, and the next mode if that is known.
  /// @param mode  in which the sphere has been
  void end_motion(MotionEnd reason, ContactMode mode, const scene::Material& ground, Arrival& arrival) const;

  /// Lets the ground hold the sphere where rounding hides whether it does, by raising the limit slightly.
  /// @return false if even that does not hold it
  bool hold(const scene::Material& ground, Arrival& arrival) const;
  /// Sets the remaining velocities relative to the ground to 0.
  void stop(const scene::Material& ground, Arrival& arrival) const;

  /// Keeps the velocities along a straight line: a speed that has become small carries rounding across the
  /// line from when it was large, and would leave the line. What moves exactly with the ground keeps doing
  /// so.
  /// @param line    its direction, 0 for none
  /// @param ground  its velocity [m/s]
  /// @return whether this removes all slip or all turning: then the contact may have another mode
  bool keep_on_line(const Vector2d& line, const Vector2d& ground, Segment::Start& state) const;

  /// Of the centre, in the mode that the ground has then [m/s^2].
  Vector2d acceleration_on(const scene::Material& ground, const Segment::Start& state) const;

  /// A sphere on an edge: whether a ground draws it in once it does not move across the edge and, if it
  /// hardly slips there, not at all, and the state then.
  /// @param edge   at the sphere, seen from that ground
  /// @param small  the greatest speed that may be taken for 0 [m/s]
  std::optional<Segment::Start> drawn_in(const scene::Material& ground, const LocalEdge& edge,
                                         const Segment::Start& state, double small) const;

  /// Sets the velocity across an edge to 0; what rounding leaves of it points into the ground.
  /// @param normal  into it, of length 1
  void stop_across(const Vector2d& normal, Arrival& arrival) const;

 private:
  bool goes_on_over(const scene::Material& ground, const Before& before, const Arrival& arrival) const;
  Reset reset_on_coulomb(const scene::Material& ground, const Vector2d& slip, Arrival& arrival) const;
  Twist stopped(const Segment::Start& state, const Vector2d& slip, const Vector2d& u) const;

  const Sphere* sphere_;
  const Dynamics* dynamics_;
  double rounding_;
};

}  // namespace hybrid_sphere
