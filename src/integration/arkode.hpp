#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>

#include "hybrid_sphere/numerical_error.hpp"
#include "integration/problem.hpp"
#include "integration/tableau.hpp"

namespace hybrid_sphere::integration {

/// SUNDIALS' ARKODE (module ERKStep), an explicit Runge-Kutta method, one accepted step at a time. Its memory
/// is made once; nothing is allocated afterwards.
class Arkode {
 public:
  /// @param size  of y
  /// Throws NumericalError if SUNDIALS refuses.
  explicit Arkode(Eigen::Index size, const Tableau& tableau = prince_dormand());
  ~Arkode();
  Arkode(const Arkode&) = delete;
  Arkode& operator=(const Arkode&) = delete;

  /// @param problem     must live as long as steps are taken
  /// @param y           at x = 0
  /// @param first_step  trial length of the first step, > 0; 0: ARKODE's guess
  void begin(Problem& problem, const Eigen::Ref<const Eigen::VectorXd>& y, double first_step);

  /// Sets the allowed error per step of each component from now on; > 0, and not below the rounding of y.
  void set_tolerances(const Eigen::Ref<const Eigen::VectorXd>& tolerances);

  /// Takes one step whose estimated error, relative to the tolerances, is at most 1 (root mean square).
  /// @param y  out: at its end
  /// Throws what the problem's functions throw, NumericalError if a derivative is not finite, or NoStep.
  void step(Eigen::Ref<Eigen::VectorXd> y);

  /// Length of the last step.
  double last_step() const;
  /// The greatest estimated error of a component in it, relative to the tolerances.
  double last_error();
  std::uint64_t evaluations() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace hybrid_sphere::integration
