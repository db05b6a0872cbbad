#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <memory>
#include <stdexcept>

namespace hybrid_sphere::integration {

using State = Eigen::Map<Eigen::VectorXd>;
using ConstState = Eigen::Map<const Eigen::VectorXd>;

/// An initial value problem y' = derivative(x, y). What its functions throw ends the step that called them
/// and leaves Arkode::advance.
class Problem {
 public:
  virtual ~Problem() = default;

  virtual void derivative(double x, const ConstState& y, State& rate) = 0;

  /// No step from y is longer.
  virtual double longest_step(const ConstState& /*y*/) { return std::numeric_limits<double>::max(); }

  /// Called with y at the end of each accepted step: puts it back onto what the motion has to keep.
  virtual void finish_step(double /*x*/, State& /*y*/) {}

  /// Functions whose changes of sign end a step early.
  virtual int roots() const { return 0; }
  virtual void root_functions(double /*x*/, const ConstState& /*y*/, double* /*values*/) {}
};

/// ARKODE gives up, with its reason.
class NoStep : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Where Arkode::advance stopped.
struct Step {
  double x = 0;          ///< reached
  bool at_root = false;  ///< y belongs to a root inside the step, interpolated: near it, no more
};

/// SUNDIALS' ARKODE (module ERKStep) with PrinceDormand's method, one accepted step at a time. Its memory is
/// made once; nothing is allocated afterwards.
class Arkode {
 public:
  /// @param size   of y
  /// Throws std::runtime_error if SUNDIALS refuses.
  explicit Arkode(Eigen::Index size);
  ~Arkode();
  Arkode(const Arkode&) = delete;
  Arkode& operator=(const Arkode&) = delete;

  /// @param problem     has to live as long as steps are taken
  /// @param y           at x = 0
  /// @param first_step  trial length of the first step, > 0; 0: ARKODE's guess
  /// @param end         the last x; infinity for none. Steps end there exactly.
  void begin(Problem& problem, const Eigen::Ref<const Eigen::VectorXd>& y, double first_step,
             double end = std::numeric_limits<double>::infinity());

  /// Error of each component that a step may make, from now on; > 0, and not below the rounding of y.
  void set_tolerances(const Eigen::Ref<const Eigen::VectorXd>& tolerances);

  /// Takes one step whose estimated error, relative to the tolerances, is at most 1 (root mean square). Where
  /// a root function changes its sign it stops there; the next call goes on from there within the same step.
  /// @param y  out: the state where it stopped
  /// Throws what the problem's functions throw, std::runtime_error if a derivative is not finite, and NoStep.
  Step advance(Eigen::Ref<Eigen::VectorXd> y);

  /// y at an x within the last step, by ARKODE's interpolant: of lower order than the steps.
  void interpolate(double x, Eigen::VectorXd& y);

  /// Length of the last complete step.
  double last_step() const;
  std::uint64_t evaluations() const;

 private:
  struct Memory;
  std::unique_ptr<Memory> memory_;
};

}  // namespace hybrid_sphere::integration
