#pragma once

#include <functional>
#include <initializer_list>
#include <optional>
#include <string>
#include <utility>

#include "catalogue/catalogue.hpp"
#include "text/refusal.hpp"

/// What entries of the catalogue are made of, besides their formulas.
namespace hybrid_sphere::mechanics::catalogue {

/// A number > 0: from 1e-9 to 1e9.
Parameter positive(const std::string& name, double value, const std::string& meaning);

/// A number >= 0, up to 1e9.
Parameter not_negative(const std::string& name, double value, const std::string& meaning);

/// Any number up to 1e9 in size.
Parameter number(const std::string& name, double value, const std::string& meaning);

/// The parameter t_switch: when the constraint is applied.
Parameter switch_time(double value);

/// The fewest digits that give the number back: "1e-09".
using text::shortest;

/// Throws std::invalid_argument: "k = 0.3 is refused; allowed: 0 to 0.25".
[[noreturn]] void refuse(const std::string& name, double value, const std::string& allowed);

/// @param components  its components in their order
Vector vector(std::initializer_list<double> components);

/// The start at t = 0: each coordinate and velocity has the value of its name.
Initial initial_state(const Model& model, const Values& values);

/// Where a motion starts by the guard of the model's first constraint: 1 where it is positive, -1 where it is
/// negative, 0 where it is 0 to rounding, as solve() sees it.
int side_at_start(const Model& model, const Initial& initial);

/// A motion without constraints under a constant acceleration, with zero multipliers.
Known flight(const Initial& initial, const Vector& acceleration, Index multipliers, double t);

/// The energy v.p - L.
Invariant energy();

/// Three stages, of which the constraint is applied at t_switch for good.
/// @param free  Known free(double t): stage 1
/// @param held  std::optional<Known> held(const Known& before, double time): stage 3, `time` after the
/// impulse
///              that meets the state `before`
template <class Free, class Held>
std::function<std::optional<Known>(double)> applied_at(double t_switch, Free free, Held held) {
  return [t_switch, free = std::move(free), held = std::move(held)](double t) -> std::optional<Known> {
    if (t < t_switch) return free(t);
    return held(free(t_switch), t - t_switch);
  };
}

}  // namespace hybrid_sphere::mechanics::catalogue
