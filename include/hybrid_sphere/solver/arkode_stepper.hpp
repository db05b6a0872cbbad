#pragma once

#include <cstdint>
#include <memory>

#include "hybrid_sphere/solver/equations.hpp"

namespace hybrid_sphere::solver {

/// SUNDIALS' ARKODE (module ERKStep, Fehlberg's method of order 8 with an error estimate of order 7), one
/// accepted step at a time. Its memory is made once; nothing is allocated afterwards.
class ArkodeStepper {
 public:
  /// Throws std::runtime_error if SUNDIALS refuses.
  ArkodeStepper();
  ~ArkodeStepper();
  ArkodeStepper(const ArkodeStepper&) = delete;
  ArkodeStepper& operator=(const ArkodeStepper&) = delete;

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

  std::uint64_t evaluations() const;

 private:
  struct Memory;
  std::unique_ptr<Memory> memory_;
};

}  // namespace hybrid_sphere::solver
