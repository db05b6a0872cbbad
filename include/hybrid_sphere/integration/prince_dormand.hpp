#pragma once

#include <array>

namespace hybrid_sphere::integration {

/// The explicit Runge-Kutta method RK8(7)13M: order 8, with an error estimate of order 7. That of Fehlberg's
/// pair 7(8) is zero for a quadrature y' = f(x), however long the step; this one is not.
/// Source: P. J. Prince, J. R. Dormand, High order embedded Runge-Kutta formulae, J. Comput. Appl. Math. 7
/// (1981) 67-75.
struct PrinceDormand {
  static constexpr int stages = 13;
  static constexpr int order = 8;
  static constexpr int embedded_order = 7;

  using Row = std::array<double, stages>;

  Row nodes;                       ///< c
  std::array<Row, stages> slopes;  ///< a
  Row weights;                     ///< b, of order 8
  Row embedded;                    ///< b, of order 7
};

extern const PrinceDormand prince_dormand;

}  // namespace hybrid_sphere::integration
