#include "mechanics/linear_complementarity.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "interrupt/interrupt.hpp"

namespace hybrid_sphere::mechanics {
namespace {

/// The tableau of I w - A z - e z0 = b: columns w (k), z (k), z0, and b.
class Tableau {
 public:
  Tableau(const Matrix& A, const Vector& b) : size_(b.size()), rows_(size_, 2 * size_ + 2) {
    rows_.leftCols(size_).setIdentity();
    rows_.middleCols(size_, size_) = -A;
    rows_.col(2 * size_).setConstant(-1);
    rows_.col(2 * size_ + 1) = b;
    for (Index i = 0; i < size_; ++i) basis_.push_back(i);
  }

  Index artificial() const { return 2 * size_; }
  Index complement(Index variable) const { return variable < size_ ? variable + size_ : variable - size_; }
  bool is_solved() const { return (rows_.col(2 * size_ + 1).array() >= 0).all(); }

  /// The row that leaves first when z0 enters: the least b.
  Index most_negative() const {
    Index least = 0;
    for (Index i = 1; i < size_; ++i) {
      if (is_less(i, 1, least, 1)) least = i;
    }
    return least;
  }

  /// The row that leaves when `entering` grows; -1 where none does.
  Index leaving(Index entering) const {
    constexpr double least_pivot = 1e-11;
    Index best = -1;
    for (Index i = 0; i < size_; ++i) {
      const double pivot = rows_(i, entering);
      if (!(pivot > least_pivot)) continue;
      if (best < 0 || is_less(i, pivot, best, rows_(best, entering))) best = i;
    }
    return best;
  }

  /// @return  the variable that has left the basis
  Index pivot(Index row, Index entering) {
    rows_.row(row) /= rows_(row, entering);
    for (Index i = 0; i < size_; ++i) {
      if (i != row) rows_.row(i) -= rows_(i, entering) * rows_.row(row).eval();
    }
    return std::exchange(basis_[std::size_t(row)], entering);
  }

  Vector solution() const {
    Vector z = Vector::Zero(size_);
    for (Index i = 0; i < size_; ++i) {
      const Index variable = basis_[std::size_t(i)];
      if (variable >= size_ && variable < 2 * size_) {
        z[variable - size_] = std::max(0.0, rows_(i, 2 * size_ + 1));
      }
    }
    return z;
  }

 private:
  /// Whether (b, w) of row i over `by_i` is lexicographically less than that of row j over `by_j`; z0, where
  /// it is as good as another, leaves first.
  bool is_less(Index i, double by_i, Index j, double by_j) const {
    constexpr double same = 1e-12;
    constexpr double rounding = 1e-14;  // of numbers of the size 1 that cancel
    const double b_i = rows_(i, 2 * size_ + 1) / by_i;
    const double b_j = rows_(j, 2 * size_ + 1) / by_j;
    if (std::abs(b_i - b_j) > same * (std::abs(b_i) + std::abs(b_j)) + rounding) return b_i < b_j;
    if (basis_[std::size_t(i)] == artificial()) return true;
    if (basis_[std::size_t(j)] == artificial()) return false;
    for (Index column = 0; column < size_; ++column) {
      const double a = rows_(i, column) / by_i;
      const double c = rows_(j, column) / by_j;
      if (a != c) return a < c;
    }
    return false;
  }

  Index size_;
  Matrix rows_;
  std::vector<Index> basis_;
};

}  // namespace

std::optional<Vector> solve_complementarity(const Matrix& A, const Vector& b) {
  Tableau tableau(A, b);
  if (tableau.is_solved()) return Vector::Zero(b.size());
  Index left = tableau.pivot(tableau.most_negative(), tableau.artificial());
  const Index most = 100 * (b.size() + 1);
  for (Index i = 0; i < most; ++i) {
    interruption_point();
    const Index entering = tableau.complement(left);
    const Index row = tableau.leaving(entering);
    if (row < 0) return std::nullopt;
    left = tableau.pivot(row, entering);
    if (left == tableau.artificial()) return tableau.solution();
  }
  return std::nullopt;
}

}  // namespace hybrid_sphere::mechanics
