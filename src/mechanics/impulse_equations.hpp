#pragma once

#include <cfloat>

#include "hybrid_sphere/mechanics/model.hpp"
#include "mechanics/active_constraints.hpp"
#include "mechanics/saddle_point.hpp"

namespace hybrid_sphere::mechanics {

/// Velocities between v1 and v2, with the values of the functions there.
struct ImpulsePoint {
  Vector v;            // (n)
  Vector multipliers;  // Lambda (g)
  Vector p;            // dL/dv (n)
  Matrix mass;         // M (n x n)
  Vector f;            // (g)
  Matrix gradient;     // C (g x n)
};

/// A step of Newton's method.
struct ImpulseStep {
  Vector dv;
  Vector multipliers;  // Lambda after it, not its change
  SaddlePoint::Outcome outcome = SaddlePoint::Outcome::regular;
  /// Whether K = M - sum Lambda d2f/dv2 is positive definite on the kernel of C, as at a local minimum.
  bool definite = true;
};

/// The equations of stage 2 with part of f(v1) left, share from 1 (where v1 solves them) to 0 (where v2
/// does),
///   p(v) - p(v1) = C(v)^T Lambda,   f(v) = share f(v1).
/// Source: docs/theory.md 7.2.
class ImpulseEquations {
 public:
  explicit ImpulseEquations(const Model& model) : model_(&model), constraints_(model) {}

  /// @param q  must live as long as it is the place
  void place(const ActiveSet& active, double t, const Vector& q);
  /// Throws NotFinite.
  void begin(const Vector& v1);
  /// v1, with Lambda = 0.
  const ImpulsePoint& before() const { return before_; }
  const ActiveConstraints& constraints() const { return constraints_; }
  const SaddlePoint& saddle_point() const { return saddle_point_; }

  /// Fills everything that follows from v. Throws NotFinite.
  void evaluate(ImpulsePoint& point);
  /// Only f and C. Throws NotFinite.
  void evaluate_constraints(ImpulsePoint& point);

  /// If K is not positive definite on the kernel of C, M replaces it: the step then still leads to a minimum.
  /// Constraints that contradict each other to first order are solved in the least-squares sense. Throws
  /// NotFinite.
  void find_step(const ImpulsePoint& point, double share, ImpulseStep& step);

  /// Whether both equations hold, each component relative to the sizes of its terms at v and v1.
  bool is_solved(const ImpulsePoint& point, double share, double tolerance);
  /// The same in the metric of M: the balance of p as a whole, and f relative to what all of v could make it.
  /// This is the best possible if coefficients differ by many powers of ten.
  bool is_solved_in_the_mean(const ImpulsePoint& point, double share, double tolerance);

  /// Of C at `point`.
  Index rank(const ImpulsePoint& point) { return saddle_point_.find_rank(point.mass, point.gradient); }

 private:
  void measure(const ImpulsePoint& point, double share);

  const Model* model_;
  ActiveConstraints constraints_;
  SaddlePoint saddle_point_;
  double t_ = 0;
  const Vector* q_ = nullptr;
  ImpulsePoint before_;
  Vector h_;
  Vector gamma_;
  Vector gamma_size_;
  Vector weights_;
  Matrix hessian_;
  Vector residual_;  // (g + n)
  Vector size_;      // (g + n)
};

/// max over the rows of abs(f) / sum over s of abs(C_s v_s); 0 where f = 0.
double residual_of(const Vector& f, const Matrix& gradient, const Vector& v);
inline double residual_of(const ImpulsePoint& point) { return residual_of(point.f, point.gradient, point.v); }

/// f counts as 0 up to this part of sum abs(C_s v_s): the roundings of its own evaluation.
/// @param n  number of velocities
inline double strict_tolerance(Index n) { return static_cast<double>(8 + n) * DBL_EPSILON; }

}  // namespace hybrid_sphere::mechanics
