#pragma once

#include <array>
#include <limits>

#include "hybrid_sphere/scene/scene.hpp"

/// The sphere's motion on one ground, written down from Newton's and Euler's equations and integrated in long
/// double: the reference of the campaigns. Shares nothing with the program but the scene's data.
namespace hybrid_sphere::fuzz::own {

using Real = long double;
using Vec2 = Eigen::Matrix<Real, 2, 1>;
using Vec3 = Eigen::Matrix<Real, 3, 1>;
using Vec4 = Eigen::Matrix<Real, 4, 1>;

struct Body {
  Vec2 r = Vec2::Zero();      ///< of the centre [m]
  Vec2 v = Vec2::Zero();      ///< [m/s]
  Vec3 w = Vec3::Zero();      ///< on the fixed axes [rad/s]
  Vec4 q = Vec4(0, 0, 0, 1);  ///< x, y, z, w
};

/// Which of the three relative velocities stay 0.
struct Hold {
  bool slip = false;  ///< of the contact point
  bool roll = false;  ///< the horizontal turning
  bool spin = false;  ///< about the normal
  int spin_sign = 0;  ///< of the spin relative to the ground where it is not held

  bool same_as(const Hold& o) const { return slip == o.slip && roll == o.roll && spin == o.spin; }
};

/// The sphere on one ground under the forces of its scene.
///
/// Friction, rolling resistance and spin friction are the subdifferential of
/// mu N abs(s) + rho N abs(nu) + rho_s R N abs(w3 - W); what sticks is told by the accelerations of least
/// norm.
class Mechanics {
 public:
  Mechanics(const scene::SphereBody& sphere, const scene::Forces& forces);

  void stand_on(const scene::Material& material);
  const scene::Material& ground() const { return material_; }

  bool grips() const { return slip_limit_ > 0; }
  bool is_ideal() const { return slip_limit_ == infinite; }

  /// Of all but the ground [N].
  Vec2 force(const Body& body) const;

  /// Of the contact point relative to the ground.
  Vec2 slip(const Body& body) const;
  /// R (w2, -w1).
  Vec2 nu(const Body& body) const { return {radius_ * body.w.y(), -radius_ * body.w.x()}; }

  /// The complete impulse of rough and rubber ground.
  void strike(Body& body) const;

  /// What sticks at this instant, of that which `may` stick: whose velocity is 0.
  Hold decide(const Body& body, const Hold& may) const;

  /// Whether friction can hold what is held.
  bool can_hold(const Body& body, const Hold& hold) const;
  /// Whether it could not, were it weaker by a hundredth.
  bool hardly_holds(const Body& body, const Hold& hold) const;

  /// One step of the classical method of order 4.
  Body step(const Body& body, const Hold& hold, Real h) const;

  /// One implicit step of order 1 for velocities whose direction turns too fast; tells what sticks after it.
  /// @param none  speed up to which a velocity counts as one that has just begun to grow [m/s]
  Body implicit_step(const Body& body, Real h, Real none, Hold& hold) const;

  /// Whether the spin has come to that of the ground and beyond.
  bool spin_has_passed(const Body& body, const Hold& hold) const;

  /// Time after which friction would have used up a velocity that is neither 0 nor held, at least [s].
  Real time_left(const Body& body, const Hold& hold) const;

  /// Size of the accelerations at a place [m/s^2].
  Real acceleration_scale(const Body& body) const;

 private:
  static constexpr Real infinite = std::numeric_limits<Real>::infinity();

  struct Rates {
    Vec2 v;
    Vec3 w;
  };
  Vec3 torque(const Body& body) const;
  Real spin_rate(const Body& body, const Hold& hold) const;
  int sign_of_spin(const Body& body) const;
  Vec2 ground_velocity(const Vec2& r) const;
  Vec2 turning(const Vec2& v) const;
  Rates rates(const Body& body, const Hold& hold) const;
  Vec2 contact_force(const Body& body, const Hold& hold, const Vec2& resistance) const;
  Body moved(const Body& from, const Body& slope, const Rates& rates, Real h) const;
  /// Minimiser of m/2 abs(s + n - a)^2 + i/2 abs(n - b)^2 + slip_limit abs(s) + roll_limit abs(n).
  void least(const Vec2& a, const Vec2& b, Real factor, Vec2& s, Vec2& n) const;

  Real mass_;
  Real radius_;
  Real inertia_;
  Real rolling_mass_;  // inertia over R^2
  Real normal_force_;
  scene::Forces forces_;
  scene::Material material_;
  Real slip_limit_ = 0;  // mu N
  Real roll_limit_ = 0;  // rho N
  Real spin_limit_ = 0;  // rho_s R N
};

}  // namespace hybrid_sphere::fuzz::own
