#pragma once

#include <cstdint>

#include "hybrid_sphere/integration/arkode.hpp"
#include "hybrid_sphere/solver/equations.hpp"

namespace hybrid_sphere::solver {

/// Steps of a solution of Equations.
class Stepper {
 public:
  Stepper() : arkode_(State::RowsAtCompileTime) {}

  /// @param equations   have to live as long as steps are taken
  /// @param scale       size of each component to which the tolerance is relative, > 0
  /// @param first_step  trial length of the first step, > 0
  void begin(const Equations& equations, const State& y, const State& scale, double first_step,
             double tolerance);

  /// Takes one step whose estimated error is not larger than tolerance times scale (root mean square).
  /// @param scale  for this step
  /// @param y      in: the state before the step; out: the one after it
  /// @return       length of the step
  /// Throws std::runtime_error with the time and the reason if there is none.
  double advance(const State& scale, State& y);

  std::uint64_t evaluations() const { return arkode_.evaluations(); }

 private:
  class Problem final : public integration::Problem {
   public:
    void derivative(double x, const integration::ConstState& y, integration::State& rate) override;
    double longest_step(const integration::ConstState& y) override;

    const Equations* equations = nullptr;
    double allowed_speed_error = 0;  ///< [m/s]
  };

  Problem problem_;
  double tolerance_ = 1;
  integration::Arkode arkode_;
};

}  // namespace hybrid_sphere::solver
