#include <cmath>
#include <sstream>
#include <stdexcept>

#include "hybrid_sphere/mechanics/model.hpp"
#include "text/refusal.hpp"

namespace hybrid_sphere::mechanics {
namespace {

std::string shape(Index rows, Index columns) {
  return columns == 1 ? std::to_string(rows) : std::to_string(rows) + " x " + std::to_string(columns);
}

void check_shape(const std::string& what, const Matrix& filled, Index rows, Index columns) {
  if (filled.rows() == rows && filled.cols() == columns) return;
  throw std::invalid_argument(what + " has " + shape(filled.rows(), filled.cols()) +
                              " components; the model has " + shape(rows, columns));
}

void check_symmetry(const Matrix& mass) {
  constexpr double rounding = 1e-9;
  for (Index i = 0; i < mass.rows(); ++i) {
    for (Index j = 0; j < i; ++j) {
      const double size = std::sqrt(std::abs(mass(i, i)) * std::abs(mass(j, j)));
      if (!(std::abs(mass(i, j) - mass(j, i)) > rounding * size)) continue;
      std::ostringstream message;
      message << "the equations' mass is not symmetric: components (" << i + 1 << ", " << j + 1 << ") and ("
              << j + 1 << ", " << i + 1 << ") are " << mass(i, j) << " and " << mass(j, i);
      throw std::invalid_argument(message.str());
    }
  }
}

/// Refuses an M with numbers where the equations say that it has none.
void check_blocks(const Matrix& mass, Index block) {
  if (block < 1 || mass.rows() % block != 0) {
    throw std::invalid_argument(
        text::refusal("the equations' mass_block() = " + std::to_string(block),
                      "a divisor of the number of velocities, " + std::to_string(mass.rows())));
  }
  for (Index i = 0; i < mass.rows(); ++i) {
    for (Index j = 0; j < i; ++j) {
      if (i / block == j / block || mass(i, j) == 0) continue;
      std::ostringstream message;
      message << "the equations' mass has the component (" << i + 1 << ", " << j + 1 << ") = " << mass(i, j)
              << " outside of its blocks of " << block << "; allowed: 0";
      throw std::invalid_argument(message.str());
    }
  }
}

void check_equations(const EquationsOfMotion& equations, double t, const Vector& q, const Vector& v) {
  MotionTerms terms;
  equations.evaluate(t, q, v, terms);
  const Index n = equations.velocities();
  check_shape("the equations' rate", terms.rate, equations.coordinates(), 1);
  check_shape("the equations' momentum", terms.momentum, n, 1);
  check_shape("the equations' mass", terms.mass, n, n);
  check_shape("the equations' force", terms.force, n, 1);
  check_symmetry(terms.mass);
  if (n > 0) check_blocks(terms.mass, equations.mass_block());
}

void check_constraint(const Constraint& constraint, double t, const Vector& q, const Vector& v,
                      const Vector& rate) {
  const ConstraintFunction& function = *constraint.function;
  const std::string subject = "constraint " + constraint.name + "'s ";
  ConstraintTerms terms;
  function.evaluate(t, q, v, rate, terms);
  check_shape(subject + "value", terms.value, function.size(), 1);
  check_shape(subject + "gradient", terms.gradient, function.size(), v.size());
  check_shape(subject + "gamma", terms.gamma, function.size(), 1);
  for (Index s = 0; s < v.size(); ++s) {
    if (function.depends_on(s) || terms.gradient.col(s).isZero(0)) continue;
    throw std::invalid_argument(subject + "gradient is not 0 in column " + std::to_string(s + 1) +
                                ", but depends_on(" + std::to_string(s) + ") is false");
  }
}

}  // namespace

void check_terms(const Model& model, double t, const Vector& q, const Vector& v) {
  Vector rate;
  try {
    check_equations(*model.equations, t, q, v);
    model.equations->rate(q, v, rate);
  } catch (const NotFinite&) {
    return;  // another place may be finite: the motion tells
  }
  for (const Constraint& constraint : model.constraints) {
    try {
      check_constraint(constraint, t, q, v, rate);
    } catch (const NotFinite&) {
      continue;
    }
  }
}

}  // namespace hybrid_sphere::mechanics
