#pragma once

#include <nvector/nvector_serial.h>

#include <exception>
#include <string>

#include "hybrid_sphere/numerical_error.hpp"
#include "integration/problem.hpp"

namespace hybrid_sphere::integration {

inline void require(bool done, const char* what) {
  if (!done) throw NumericalError(std::string("SUNDIALS: ") + what + " failed");
}

/// SUNDIALS's return flags report what it would print.
inline void ignore_message(int /*code*/, const char* /*module*/, const char* /*function*/, char* /*text*/,
                           void* /*user*/) {}

/// What a SUNDIALS integrator works on and calls back: its user data points to one of these.
struct SundialsProblem {
  explicit SundialsProblem(Eigen::Index n) : size(n), weights(Eigen::VectorXd::Ones(n)) {
    require(SUNContext_Create(nullptr, &context) == 0, "SUNContext_Create");
    y = N_VNew_Serial(size, context);
    require(y != nullptr, "N_VNew_Serial");
    require(N_VEnableFusedOps_Serial(y, SUNTRUE) == 0, "N_VEnableFusedOps_Serial");
    N_VConst(0, y);
    other = N_VClone(y);
    require(other != nullptr, "N_VClone");
  }
  virtual ~SundialsProblem() {
    if (other != nullptr) N_VDestroy(other);
    if (y != nullptr) N_VDestroy(y);
    if (context != nullptr) SUNContext_Free(&context);
  }
  SundialsProblem(const SundialsProblem&) = delete;
  SundialsProblem& operator=(const SundialsProblem&) = delete;

  State state(N_Vector vector) const { return State(N_VGetArrayPointer(vector), size); }
  ConstState const_state(N_Vector vector) const { return ConstState(N_VGetArrayPointer(vector), size); }

  /// Exceptions must not pass through SUNDIALS, so they are held here.
  template <class Function>
  int guarded(const Function& function) {
    try {
      function();
      return 0;
    } catch (...) {
      thrown = std::current_exception();
      return -1;
    }
  }

  static int derivative(realtype x, N_Vector y, N_Vector rate, void* user) {
    auto& self = *static_cast<SundialsProblem*>(user);
    ++self.evaluations;
    return self.guarded([&] {
      State out = self.state(rate);
      self.problem->derivative(x, self.const_state(y), out);
      if (!out.allFinite()) throw NumericalError("the derivative is not finite");
    });
  }

  static int error_weights(N_Vector /*y*/, N_Vector weights, void* user) {
    auto& self = *static_cast<SundialsProblem*>(user);
    self.state(weights) = self.weights;
    return 0;
  }

  Eigen::Index size;
  SUNContext context = nullptr;
  N_Vector y = nullptr;
  N_Vector other = nullptr;
  Problem* problem = nullptr;
  Eigen::VectorXd weights;
  std::uint64_t evaluations = 0;
  std::exception_ptr thrown;
};

}  // namespace hybrid_sphere::integration
