#pragma once

#include <cstddef>
#include <vector>

namespace hybrid_sphere::integration {

/// Coefficients of an explicit Runge-Kutta method of s stages with an error estimate.
struct Tableau {
  int order = 0;
  int embedded_order = 0;        ///< of the estimate
  std::vector<double> nodes;     ///< c (s)
  std::vector<double> slopes;    ///< a (s x s), row by row
  std::vector<double> weights;   ///< b (s)
  std::vector<double> embedded;  ///< b of the estimate (s)

  std::size_t stages() const { return nodes.size(); }
};

/// RK8(7)13M. The estimate of Fehlberg's pair 7(8) is zero for a quadrature y' = f(x), however long the step;
/// this one is not. Source: P. J. Prince, J. R. Dormand, High order embedded Runge-Kutta formulae, J. Comput.
/// Appl. Math. 7 (1981) 67-75.
const Tableau& prince_dormand();

/// Of order 5(4), 7 stages. Source: J. R. Dormand, P. J. Prince, A family of embedded Runge-Kutta formulae,
/// J. Comput. Appl. Math. 6 (1980) 19-26; from ARKODE's tables.
const Tableau& dormand_prince();

/// Of order 3(2), 4 stages. Source: P. Bogacki, L. F. Shampine, A 3(2) pair of Runge-Kutta formulas, Appl.
/// Math. Lett. 2 (1989) 321-325; from ARKODE's tables.
const Tableau& bogacki_shampine();

}  // namespace hybrid_sphere::integration
