#pragma once

#include <functional>
#include <memory>

#include "hybrid_sphere/mechanics/constraint.hpp"
#include "hybrid_sphere/mechanics/event.hpp"
#include "python/python_function.hpp"
#include "python/unsized_constraint.hpp"

/// Constraints, guards, loads and events from functions written in Python, differentiated exactly. Each takes
/// the lock of the interpreter where it calls its function.
namespace hybrid_sphere::python {

/// f(t, q, v) = 0, one number or a list. See mechanics::AutomaticConstraint.
class PythonConstraint final : public UnsizedConstraint {
 public:
  explicit PythonConstraint(PythonFunction function) : function_(std::move(function)) {}

  void evaluate(double t, const Vector& q, const Vector& v, const Vector& rate,
                mechanics::ConstraintTerms& terms) const override;
  void evaluate(double t, const Vector& q, const Vector& v, Vector& value,
                mechanics::Matrix& gradient) const override;
  void add_curvature(double t, const Vector& q, const Vector& v, const Vector& multipliers,
                     mechanics::Matrix& sum) const override;

 private:
  Index count(double t, const Vector& q, const Vector& v) const override;

  PythonFunction function_;
};

/// g(t, q) = 0, one number or a list: f is its rate. See mechanics::HolonomicConstraint.
class PythonHolonomicConstraint final : public UnsizedConstraint {
 public:
  PythonHolonomicConstraint(PythonFunction function,
                            std::shared_ptr<const mechanics::EquationsOfMotion> equations)
      : function_(std::move(function)), equations_(std::move(equations)) {}

  void evaluate(double t, const Vector& q, const Vector& v, const Vector& rate,
                mechanics::ConstraintTerms& terms) const override;
  void evaluate(double t, const Vector& q, const Vector& v, Vector& value,
                mechanics::Matrix& gradient) const override;
  void add_curvature(double, const Vector&, const Vector&, const Vector&, mechanics::Matrix&) const override {
  }
  bool has_position() const override { return true; }
  void position(double t, const Vector& q, Vector& value) const override;

 private:
  struct Slopes {
    mechanics::Matrix place;  // dg/dq (g x N)
    Vector time;              // dg/dt (g)
  };

  Index count(double t, const Vector& q, const Vector& v) const override;
  Slopes differentiate(double t, const Vector& q) const;
  Vector second_rate(double t, const Vector& q, const Vector& rate) const;

  PythonFunction function_;
  std::shared_ptr<const mechanics::EquationsOfMotion> equations_;
};

/// g(t, q) > 0, or -g. See mechanics::AutomaticGuard.
class PythonGuard final : public mechanics::Guard {
 public:
  /// @param sign  1 or -1
  PythonGuard(PythonFunction function, int sign) : function_(std::move(function)), sign_(sign) {}

  double value(double t, const Vector& q) const override;
  double rate(double t, const Vector& q, const Vector& q_rate) const override;

 private:
  PythonFunction function_;
  int sign_;
};

/// N(t, q, v)
class PythonLoad final : public mechanics::Load {
 public:
  explicit PythonLoad(PythonFunction function) : function_(std::move(function)) {}
  double value(double t, const Vector& q, const Vector& v) const override;

 private:
  PythonFunction function_;
};

/// g(t, q, v) of an event.
std::function<double(double, const Vector&, const Vector&)> event_function(PythonFunction function);
/// The velocities after it (n).
std::function<Vector(double, const Vector&, const Vector&)> reset_function(PythonFunction function);
/// q -> q, as Model::normalize.
std::function<void(Vector&)> normalize_function(PythonFunction function);

}  // namespace hybrid_sphere::python
