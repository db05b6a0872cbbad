#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <vector>

#include "hybrid_sphere/numerical_error.hpp"
#include "integration/problem.hpp"

namespace hybrid_sphere::integration {

/// SUNDIALS' CVODE, a linear multistep method of variable order, one accepted step at a time. It uses only
/// derivative() and max_step() of a Problem.
class Cvode {
 public:
  enum class Formula {
    adams,  ///< Adams-Moulton, order 1 to 12, solved by fixed-point iteration
    bdf     ///< backward differentiation, order 1 to 5, by Newton's method: for stiff problems
  };

  /// @param size  of y
  /// Throws NumericalError if SUNDIALS refuses.
  Cvode(Eigen::Index size, Formula formula);
  ~Cvode();
  Cvode(const Cvode&) = delete;
  Cvode& operator=(const Cvode&) = delete;

  /// @param problem     must live as long as steps are taken
  /// @param y           at x = 0
  /// @param first_step  trial length of the first step, > 0; 0: CVODE's guess
  void begin(Problem& problem, const Eigen::Ref<const Eigen::VectorXd>& y, double first_step);

  /// Sets the allowed error per step of each component from now on; > 0, and not below the rounding of y.
  void set_tolerances(const Eigen::Ref<const Eigen::VectorXd>& tolerances);

  /// Takes one step. @param y  out: the state at its end @return x there
  /// Throws what the problem's functions throw, NumericalError if a derivative is not finite, or NoStep.
  double step(Eigen::Ref<Eigen::VectorXd> y);

  /// y', y'', ... of the interpolant of the last step, a polynomial of the method's order, at its beginning.
  void derivatives(std::vector<Eigen::VectorXd>& of_y);

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
