#include "mechanics/impulse_equations.hpp"

#include <algorithm>
#include <cfloat>
#include <cmath>

namespace hybrid_sphere::mechanics {
namespace {

double size_of_terms(const Matrix& matrix, Index row, const Vector& v) {
  double sum = 0;
  for (Index s = 0; s < v.size(); ++s) sum += std::abs(matrix(row, s) * v[s]);
  return sum;
}

}  // namespace

double residual_of(const Vector& f, const Matrix& gradient, const Vector& v) {
  constexpr double least = DBL_MIN / DBL_EPSILON;  // smaller numbers have lost figures
  double largest = 0;
  for (Index b = 0; b < f.size(); ++b) {
    if (std::abs(f[b]) < least) continue;
    largest = std::max(largest, std::abs(f[b]) / size_of_terms(gradient, b, v));
  }
  return largest;
}

void ImpulseEquations::place(const ActiveSet& active, double t, const Vector& q) {
  constraints_.set(active);
  t_ = t;
  q_ = &q;
}

void ImpulseEquations::begin(const Vector& v1) {
  before_.v = v1;
  before_.multipliers.setZero(constraints_.size());
  evaluate(before_);
}

void ImpulseEquations::evaluate(ImpulsePoint& point) {
  evaluate_constraints(point);
  model_->equations->momentum(t_, *q_, point.v, point.p, point.mass);
  if (!point.p.allFinite() || !point.mass.allFinite()) throw NotFinite("momentum");
}

void ImpulseEquations::evaluate_constraints(ImpulsePoint& point) {
  constraints_.evaluate(t_, *q_, point.v, point.f, point.gradient);
}

void ImpulseEquations::find_step(const ImpulsePoint& point, double share, ImpulseStep& step) {
  h_ = before_.p - point.p;
  gamma_ = share * before_.f - point.f;
  gamma_size_.resize(gamma_.size());
  for (Index b = 0; b < gamma_.size(); ++b) gamma_size_[b] = size_of_terms(point.gradient, b, point.v);
  step.definite = true;
  if ((point.multipliers.array() != 0).any()) {
    hessian_.setZero(point.v.size(), point.v.size());
    weights_ = -point.multipliers;
    constraints_.add_curvature(t_, *q_, point.v, weights_, hessian_);
    hessian_ += point.mass;
    step.outcome = saddle_point_.solve_step(point.mass, hessian_, point.gradient, h_, gamma_, gamma_size_,
                                            step.dv, step.multipliers);
    if (step.outcome != SaddlePoint::Outcome::singular) return;
    step.definite = false;
  }
  step.outcome = saddle_point_.solve_step(point.mass, point.mass, point.gradient, h_, gamma_, gamma_size_,
                                          step.dv, step.multipliers);
}

bool ImpulseEquations::is_solved(const ImpulsePoint& point, double share, double tolerance) {
  measure(point, share);
  return (residual_.array().abs() <= tolerance * size_.array()).all();
}

bool ImpulseEquations::is_solved_in_the_mean(const ImpulsePoint& point, double share, double tolerance) {
  measure(point, share);
  const Index g = point.f.size();
  const Index n = point.v.size();
  const Vector& scale = saddle_point_.scale();
  const double balance = residual_.tail(n).cwiseProduct(scale).norm();
  if (!(balance <= tolerance * size_.tail(n).cwiseProduct(scale).norm())) return false;
  const double speed = saddle_point_.length(point.v) + saddle_point_.length(before_.v);
  for (Index b = 0; b < g; ++b) {
    const double size =
        std::abs(share * before_.f[b]) + speed * point.gradient.row(b).transpose().cwiseProduct(scale).norm();
    if (!(std::abs(residual_[b]) <= tolerance * size)) return false;
  }
  return true;
}

/// The residuals of f (g) and of the balance of p (n), and the sizes of their terms at v and v1.
void ImpulseEquations::measure(const ImpulsePoint& point, double share) {
  const Index g = point.f.size();
  residual_.resize(g + point.v.size());
  size_.resize(residual_.size());
  for (Index b = 0; b < g; ++b) {
    const double wanted = share * before_.f[b];
    residual_[b] = point.f[b] - wanted;
    size_[b] = size_of_terms(point.gradient, b, point.v) + size_of_terms(point.gradient, b, before_.v) +
               std::abs(wanted);
  }
  for (Index s = 0; s < point.v.size(); ++s) {
    double residual = point.p[s] - before_.p[s];
    double size = std::abs(point.p[s]) + std::abs(before_.p[s]) + size_of_terms(point.mass, s, point.v) +
                  size_of_terms(point.mass, s, before_.v);
    for (Index b = 0; b < g; ++b) {
      const double part = point.gradient(b, s) * point.multipliers[b];
      residual -= part;
      size += std::abs(part);
    }
    residual_[g + s] = residual;
    size_[g + s] = size;
  }
}

}  // namespace hybrid_sphere::mechanics
