#pragma once

#include <array>
#include <cstddef>

#include "integration/integrator.hpp"

namespace hybrid_sphere::integration {

/// A step as a polynomial through its two ends and some places between them, with their slopes, in Newton's
/// form from its beginning, so that little precision is lost near the beginning however long the step.
class DenseOutput {
 public:
  static constexpr std::size_t max_places = 5;

  /// Number of places for which the error is of the order of that of a step.
  /// @param order  of the method
  static constexpr std::size_t places(int order) { return static_cast<std::size_t>(order) / 2 + 1; }

  /// Number of states in a shape.
  /// @param order  of the method
  static constexpr std::size_t length(int order) { return 2 * places(order) - 1; }

  /// Fills the shape of `from`, whose step and state are set.
  /// @param places      2, 3 or 5
  /// @param slope       at `from`
  /// @param end_slope   at `to`
  /// @param derivative  FlowState(const FlowState& y)
  /// @param reach       FlowState(double x): the state a length x after `from`
  template <class Derivative, class Reach>
  static void fit(std::size_t places, Node& from, const Node& to, const FlowState& slope,
                  const FlowState& end_slope, const Derivative& derivative, const Reach& reach) {
    std::array<FlowState, max_places> increments;
    std::array<FlowState, max_places> slopes;
    for (std::size_t i = 0; i < places; ++i) {
      const FlowState y = i == 0 ? from.y : i == 1 ? to.y : reach(where[i] * from.step);
      increments[i] = y - from.y;
      slopes[i] = from.step * (i == 0 ? slope : i == 1 ? end_slope : derivative(y));
    }
    set_shape(places, increments, slopes, from);
  }

  /// The state at x, 0 <= x <= from.step, after fit.
  static FlowState at(const Node& from, double x);

 private:
  static constexpr std::array<double, max_places> where{0, 1, 0.5, 0.25, 0.75};  // in a step

  static void set_shape(std::size_t places, const std::array<FlowState, max_places>& increments,
                        const std::array<FlowState, max_places>& slopes, Node& from);
};

}  // namespace hybrid_sphere::integration
