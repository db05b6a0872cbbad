#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "hybrid_sphere/export.hpp"
#include "hybrid_sphere/mechanics/constraint.hpp"
#include "hybrid_sphere/mechanics/equations_of_motion.hpp"
#include "hybrid_sphere/mechanics/event.hpp"

namespace hybrid_sphere::mechanics {

/// A hybrid system: equations of motion, and constraints that are applied and released. System builds one
/// from formulas.
/// @code
/// mechanics::Model model;
/// model.coordinates = {"x"};
/// model.velocities = {"x_dot"};
/// try {
///   mechanics::check(model);
/// } catch (const std::invalid_argument& error) {
///   // a model needs equations
/// }
/// @endcode
struct HYBRID_SPHERE_EXPORT Model {
  std::vector<std::string> coordinates;  ///< names of q (N)
  std::vector<std::string> velocities;   ///< names of v (n)
  std::shared_ptr<const EquationsOfMotion> equations;
  std::vector<Constraint> constraints;
  std::vector<Event> events;
  /// Puts coordinates that integration has moved off their manifold back onto it: scales a quaternion to unit
  /// length. Empty where q may take any value.
  std::function<void(Vector& q)> normalize;

  /// Number of multipliers: the total size of all constraints. They are in the order of the constraints;
  /// those of constraint i begin at multiplier_of(i).
  Index multipliers() const;
  /// @param constraint  index of a constraint, or their number: then the result is multipliers()
  /// Throws std::out_of_range for other indices, with the allowed range.
  Index multiplier_of(std::size_t constraint) const;

  /// Index of the constraint with a name. Throws std::invalid_argument, with the names that there are.
  std::size_t index_of_constraint(const std::string& name) const;
  /// The multipliers of one constraint, as many as it has functions. @param multipliers  of a State or of a
  /// Switch. Throws std::invalid_argument for a name that no constraint has, and for another number of
  /// multipliers.
  Vector multipliers_of(const std::string& constraint, const Vector& multipliers) const;
};

/// The indices of the constraints of a model that hold, ascending.
using ActiveSet = std::vector<std::size_t>;

/// A constraint with friction that does not hold: it slides.
struct Slide {
  std::size_t constraint = 0;
  int direction = 1;  ///< 1 or -1: the sign of a slip velocity f of one component; 0: f has two
  Eigen::Vector2d heading = {1, 0};  ///< f/abs(f); of one component: its sign and 0
  double slowest = 0;  ///< a slip of two components that is slower is not known from 0: it has this heading

  Slide() = default;
  Slide(std::size_t constraint_, int sign) : constraint(constraint_), direction(sign), heading(sign, 0) {}
  /// @param slip  f, or any vector along it; of 0: as of (1, 0)
  Slide(std::size_t constraint_, const Vector& slip) : Slide(constraint_, slip[0] < 0 ? -1 : 1) {
    if (slip.size() == 1) return;
    direction = 0;
    const double speed = slip.norm();
    heading = speed > 0 ? Eigen::Vector2d(slip / speed) : Eigen::Vector2d(1, 0);
  }
};
/// Whether the same constraint slides, in directions less than a right angle apart.
inline bool operator==(const Slide& a, const Slide& b) {
  return a.constraint == b.constraint && a.heading.dot(b.heading) > 0;
}
/// Ascending by constraint.
using Slides = std::vector<Slide>;

/// The names of constraints, as "rolling, blade". Throws std::out_of_range for an index that the model does
/// not have.
HYBRID_SPHERE_EXPORT std::string names(const Model& model, const ActiveSet& set);

/// Throws std::out_of_range if an index of a set is not that of a constraint of the model, with the allowed
/// range. @param name  what the set is called in the message: "active"
HYBRID_SPHERE_EXPORT void check_constraints(const Model& model, const char* name, const ActiveSet& set);

/// "t = 0.5, x = 1, y = 2, x_dot = 0" @param v  omitted if empty
HYBRID_SPHERE_EXPORT std::string describe(const Model& model, double t, const Vector& q,
                                          const Vector& v = Vector());

/// Refuses an invalid model: no equations, a number of names other than that of coordinates or velocities, an
/// empty or duplicate name, a constraint without function or size, an interval that ends before it begins, a
/// restitution or a friction that makes no sense, an event without function.
/// Throws std::invalid_argument that names the fault.
HYBRID_SPHERE_EXPORT void check(const Model& model);

/// Refuses equations and constraints whose terms at (t, q, v) have other sizes than the model says, and a
/// mass matrix that is not symmetric there. Throws std::invalid_argument that names the term.
HYBRID_SPHERE_EXPORT void check_terms(const Model& model, double t, const Vector& q, const Vector& v);

}  // namespace hybrid_sphere::mechanics
