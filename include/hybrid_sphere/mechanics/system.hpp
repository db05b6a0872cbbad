#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>

#include "hybrid_sphere/mechanics/automatic.hpp"
#include "hybrid_sphere/mechanics/holonomic_constraint.hpp"
#include "hybrid_sphere/mechanics/model.hpp"

namespace hybrid_sphere::mechanics {

/// When a constraint holds: for t in [begin, end).
struct Between {
  double begin;  ///< [s]
  double end;    ///< [s]
};

/// From before the start, permanently: the initial velocities must satisfy it.
inline Between always() {
  return {-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
}
/// Applied at t = begin, permanently. If begin is the start itself, the impulse acts there.
inline Between from(double begin) { return {begin, std::numeric_limits<double>::infinity()}; }
/// Applied at t = begin, released at t = end.
inline Between between(double begin, double end) { return {begin, end}; }

template <class Function>
struct WhilePositive {
  Function guard;
};
/// While g(t, q) > 0: applied and released each time the motion changes the sign of g.
template <class Function>
WhilePositive<Function> while_positive(Function guard) {
  return {std::move(guard)};
}

/// A hybrid system of n velocities, written as formulas:
///
///   System<3> skate({"x", "y", "theta"}, [=](auto t, const auto& q, const auto& v) {
///     return m / 2 * (v[0] * v[0] + v[1] * v[1]) + I / 2 * v[2] * v[2];
///   });
///   skate.constrain("blade", [](auto t, const auto& q, const auto& v) {
///     using std::cos, std::sin;
///     return v[0] * sin(q[2]) - v[1] * cos(q[2]);
///   }, from(0.5));
///
/// Each function is called with a number t and vectors q (N) and v (n) of that number's type (Eigen, fixed
/// size): double, or a differentiating type. Use any consistent units. docs/your_own_system.md leads through
/// an example from the formulas to a plot.
///
/// Usually there are N = n coordinates, and the velocities are their derivatives. With quasi-velocities (15)
/// there may be more coordinates than velocities.
/// @code
/// mechanics::System<2> particle({"x", "y"}, [](auto t, const auto& q, const auto& v) {
///   return (v[0] * v[0] + v[1] * v[1]) / 2 - 9.81 * q[1];
/// });
/// particle.constrain("rail", [](auto t, const auto& q, const auto& v) { return v[1] - v[0]; },
///                    mechanics::from(0.5));
/// @endcode
template <int n, int N = n>
class System : public Model {
 public:
  using CoordinateNames = std::array<std::string, static_cast<std::size_t>(N)>;
  using VelocityNames = std::array<std::string, static_cast<std::size_t>(n)>;

  /// @param names       of the coordinates q (N = n); the velocity of "x" is called "x_dot"
  /// @param lagrangian  L(t, q, v), or with_mass_matrix(M, V)
  template <class Lagrangian>
  System(const CoordinateNames& names, Lagrangian lagrangian)
      : System(names, derivatives(names), automatic_equations<n>(std::move(lagrangian))) {}

  /// @param forces  Q(t, q, v), generalised forces that are not in L, a vector (n)
  template <class Lagrangian, class Forces>
  System(const CoordinateNames& names, Lagrangian lagrangian, Forces forces)
      : System(names, derivatives(names), automatic_equations<n>(std::move(lagrangian), std::move(forces))) {}

  /// In quasi-velocities. @param rate  q' as a function rate(q, v), linear in v, a vector (N); the n
  /// directions that it spans must be closed under brackets, as those of a rotation are.
  template <class Rate, class Lagrangian, class Forces>
  System(const CoordinateNames& coordinates, const VelocityNames& velocities, Rate rate,
         Lagrangian lagrangian, Forces forces)
      : System(coordinates, velocities,
               automatic_equations<n, N>(std::move(rate), std::move(lagrangian), std::move(forces))) {}

  template <class Rate, class Lagrangian>
  System(const CoordinateNames& coordinates, const VelocityNames& velocities, Rate rate,
         Lagrangian lagrangian)
      : System(coordinates, velocities, automatic_equations<n, N>(std::move(rate), std::move(lagrangian))) {}

  /// Equations whose derivatives are supplied by hand.
  System(const CoordinateNames& names, const VelocityNames& velocity_names,
         std::shared_ptr<const EquationsOfMotion> by_hand) {
    coordinates.assign(names.begin(), names.end());
    velocities.assign(velocity_names.begin(), velocity_names.end());
    equations = std::move(by_hand);
  }

  /// @param f     f(t, q, v), one number, or a vector (Eigen, fixed size) of functions that are applied and
  ///              released together
  /// @param when  always(), from(t), between(t1, t2) or while_positive(g)
  template <class Function, class When>
  System& constrain(const std::string& name, Function f, const When& when) {
    return constrain(name, automatic_constraint<n, N>("constraint " + name, std::move(f)), when);
  }

  /// A constraint whose derivatives are supplied by hand.
  System& constrain(const std::string& name, std::shared_ptr<const ConstraintFunction> by_hand,
                    const Between& when) {
    constraints.push_back({name, std::move(by_hand), {when.begin, when.end, nullptr}});
    return *this;
  }
  template <class Function>
  System& constrain(const std::string& name, std::shared_ptr<const ConstraintFunction> by_hand,
                    const WhilePositive<Function>& when) {
    Schedule schedule;
    schedule.guard = automatic_guard<N>("guard of constraint " + name, when.guard);
    constraints.push_back({name, std::move(by_hand), std::move(schedule)});
    return *this;
  }

  /// @param g     g(t, q), one number, or a vector (Eigen, fixed size): lengths of rods, positions of joints
  /// @param when  always(), from(t), between(t1, t2) or while_positive(g)
  template <class Function, class When>
  System& holonomic(const std::string& name, Function g, const When& when) {
    return constrain(name, holonomic_constraint<n, N>("constraint " + name, equations, std::move(g)), when);
  }

  /// A body lands on another one and lifts off: the constraint holds where gap = 0, as long as lambda >= 0.
  /// @param gap          gap(t, q) >= 0, a number
  /// @param restitution  0 to 1
  template <class Function>
  System& unilateral(const std::string& name, Function gap, double restitution = 0) {
    const auto overlap = [gap](const auto& t, const auto& q) { return -gap(t, q); };
    holonomic(name, std::move(gap), while_positive(overlap));
    constraints.back().unilateral = Unilateral{restitution};
    return *this;
  }

  /// Coulomb friction of a unilateral constraint: it holds (no slip) as long as abs(lambda) <= mu N, and
  /// slides against the slip otherwise.
  /// @param slip     f(t, q, v), the slip velocity, a number, or, along a plane, a vector of 2 (Eigen)
  /// @param contact  name of the unilateral constraint, whose multiplier is N; it has no other friction
  /// @param static_coefficient  of what sticks, >= coefficient; none: the same
  template <class Function>
  System& friction(const std::string& name, Function slip, double coefficient, const std::string& contact,
                   std::optional<double> static_coefficient = {}) {
    Friction law;
    law.coefficient = coefficient;
    law.static_coefficient = static_coefficient;
    for (std::size_t i = 0; i < constraints.size(); ++i) {
      if (constraints[i].name == contact) law.contact = i;
    }
    if (!law.contact) throw std::invalid_argument("friction " + name + ": there is no constraint " + contact);
    constrain(name, std::move(slip), always());
    constraints.back().friction = std::move(law);
    return *this;
  }

  /// Coulomb friction under a load that is known. @param load  N(t, q, v) >= 0, a number; called with doubles
  template <class Function, class LoadFunction,
            class = std::enable_if_t<!std::is_convertible_v<LoadFunction, std::string>>>
  System& friction(const std::string& name, Function slip, double coefficient, LoadFunction load,
                   std::optional<double> static_coefficient = {}) {
    constrain(name, std::move(slip), always());
    Friction& friction = constraints.back().friction.emplace();
    friction.coefficient = coefficient;
    friction.static_coefficient = static_coefficient;
    friction.load =
        std::unique_ptr<const Load>(new FunctionLoad<n, N, LoadFunction>("load of " + name, std::move(load)));
    return *this;
  }

  /// Something that is reported, as a Switch, when g changes its sign.
  /// @param g      g(t, q, v), a number; called with doubles only
  /// @param reset  the velocities after it, a function (t, q, v); none: they stay
  System& event(const std::string& name, std::function<double(double, const Vector&, const Vector&)> g,
                Crossing crossing = Crossing::either,
                std::function<Vector(double, const Vector&, const Vector&)> reset = {}) {
    events.push_back({name, std::move(g), crossing, std::move(reset)});
    return *this;
  }

 private:
  static VelocityNames derivatives(const CoordinateNames& names) {
    static_assert(n == N, "quasi-velocities need names of their own and the coordinates' rate");
    VelocityNames result;
    for (std::size_t i = 0; i < result.size(); ++i) result[i] = names[i] + "_dot";
    return result;
  }
};

}  // namespace hybrid_sphere::mechanics
