#pragma once

#include <memory>
#include <vector>

#include "hybrid_sphere/mechanics/equations_of_motion.hpp"

namespace hybrid_sphere::mechanics {

/// The linear equations of stages 1, 2 and 3,
///   M x - C^T y = h
///   C x         = gamma
/// for symmetric M (n x n) that is positive definite on the kernel of C (g x n), g = 0 included. Redundant
/// rows of C (a row of zeros is one) are found by the rank and give the multipliers y of least Euclidean
/// norm; x and C^T y stay unique.
///
/// C^T is decomposed into Q R with column pivoting: x is a sum of columns of Q that satisfies C x = gamma and
/// of columns that span the kernel of C, on which M alone is decomposed. Ranks are decided by dimensionless
/// numbers: velocities are scaled so that M has a unit diagonal, rows of C to unit length, both up to powers
/// of two, so that scaling causes no rounding. A velocity without mass gets its scale from C, as does one of
/// little mass that a row ties to others. Source: docs/theory.md 7.3.
class SaddlePoint {
 public:
  enum class Outcome {
    regular,       ///< a unique solution
    redundant,     ///< x unique, y of least norm; rank() < g
    inconsistent,  ///< no x satisfies C x = gamma: see conflict()
    singular       ///< M is not positive definite on the kernel of C
  };

  SaddlePoint();
  ~SaddlePoint();
  SaddlePoint(SaddlePoint&&) noexcept;
  SaddlePoint& operator=(SaddlePoint&&) noexcept;

  /// x (n) and y (g) are unchanged unless the outcome is regular or redundant. Allocates nothing in the
  /// regular case once it has seen these sizes.
  /// @param gamma_size  (g) sizes of the terms whose sum is gamma, which carries their roundings; null: those
  ///                    of gamma itself. Rows that contradict by no more than such roundings are redundant.
  Outcome solve(const Matrix& mass, const Matrix& gradient, const Vector& h, const Vector& gamma, Vector& x,
                Vector& y, const Vector* gamma_size = nullptr);

  /// A step of Newton's method: the same with K (n x n, symmetric) in place of M, in the scales of M; K
  /// instead of M must be positive definite on the kernel of C. A contradiction also sets x and y: C x is
  /// then gamma in the least-squares sense, with rows of unit length.
  Outcome solve_step(const Matrix& mass, const Matrix& hessian, const Matrix& gradient, const Vector& h,
                     const Vector& gamma, const Vector& gamma_size, Vector& x, Vector& y);

  /// Finds only the rank and the scales. @return rank()
  Index find_rank(const Matrix& mass, const Matrix& gradient);

  /// Rank of C at the last call.
  Index rank() const;
  /// As many rows of C, ascending, that are independent of one another.
  std::vector<Index> independent_rows() const;
  /// Scales (n) of the velocities at the last call: in x / scale, M has a unit diagonal, up to powers of two,
  /// unless a row of C ties a velocity of little mass to others; then its column of C is as large as theirs.
  const Vector& scale() const;
  /// Length of x / scale.
  double length(const Vector& x) const;
  /// How far M is from being singular on the kernel of C at the last solve(): the smallest pivot of its
  /// Cholesky decomposition there, relative to the diagonal of M; in [0, 1]. 1 where C leaves no velocity.
  double regularity() const;
  /// The largest x_i with C x = 0 and x.Mx = 1, at the last solve().
  double mobility(Index i) const;
  /// After a contradiction: rows of C that contradict each other, ascending.
  const std::vector<Index>& conflict() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace hybrid_sphere::mechanics
