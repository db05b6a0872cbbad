#pragma once

#include <vector>

#include "hybrid_sphere/mechanics/equations_of_motion.hpp"

namespace hybrid_sphere::mechanics {

/// The equations of SaddlePoint where they are far from singular, by the decompositions L D L^T of M and of
/// C M^-1 C^T: M is positive definite by itself, and the rows of C are well apart from one another in its
/// metric. All that is doubtful is left to SaddlePoint. Allocates nothing once it has seen these sizes.
///
/// Systems of more than six velocities leave out zeros: of L, those before the first number of a row, and of
/// L^-1 C^T, those before the first and behind the last. A chain of rigid bodies whose joints are in its
/// order then costs a number of operations proportional to its length, as a tree does whose branches are.
/// Source: A. George and J. W. H. Liu, Computer Solution of Large Sparse Positive Definite Systems (1981),
/// ch. 4 (the envelope of a factor).
class SchurComplement {
 public:
  /// Decomposes M (n x n) and C (g x n). @return  false where they are not regular enough
  bool decompose(const Matrix& mass, const Matrix& gradient);

  // After a decomposition, until the next one:

  /// Solves M x - C^T y = h, C x = gamma. @return  false if a number is not finite; x (n) and y (g) are then
  /// unchanged
  bool solve(const Vector& h, const Vector& gamma, Vector& x, Vector& y) const;

  /// Adds to x the shortest change, in the metric of M, for which C x grows by `missing` (g).
  void add_shortest(const Vector& missing, Vector& x) const;

  /// The smallest pivot of M, relative to its diagonal.
  double regularity() const { return regularity_; }

  /// The largest x_i with C x = 0 and x.Mx = 1.
  double mobility(Index i) const;

 private:
  using Numbers = std::vector<double>;
  /// L (a row after another; its diagonal is 1), the inverse of D, and work space for a row.
  struct Factor {
    Numbers rows;
    Numbers inverse;
    Numbers of_row;
    std::vector<std::size_t> first;  ///< column of the first number of each row that is not 0
  };
  /// Indices from begin to end, without end.
  struct Span {
    std::size_t begin, end;
  };

  // Size is a number, or a type whose value it is, for which the compiler unrolls the loops.
  template <class Size>
  static double pivots(Factor& factor, Size size);
  template <class Size>
  static void solve_lower(const Factor& factor, Size size, double* x);
  template <class Size>
  static void solve_upper(const Factor& factor, Size size, double* x);
  template <class Size>
  bool decompose(const Matrix& mass, const Matrix& gradient, Size n);
  template <class Size>
  bool set_images(const Matrix& gradient, Size n);
  template <class Size>
  bool solve(const Vector& h, const Vector& gamma, Vector& x, Vector& y, Size n) const;
  template <class Size>
  void tie(const Vector& wanted, Size n, double* x) const;
  template <class Size>
  static std::size_t first_of(const Factor& factor, std::size_t i, Size size);
  template <class Size>
  Span common_span(std::size_t a, std::size_t b, Size n) const;
  void set_span(std::size_t b);
  void solve_complement(double* y) const;
  void resize(std::size_t n, std::size_t g);

  std::size_t n_ = 0;
  std::size_t g_ = 0;
  Factor mass_;
  // A row after another (g x n):
  Numbers rows_;                   // C
  Numbers images_;                 // L^-1 C^T, transposed
  Numbers weighted_;               // D^-1 L^-1 C^T, transposed
  std::vector<Span> spans_;        // of images_, a row each (g)
  std::vector<std::size_t> tied_;  // velocity that is nearly all of a row; n: none
  Factor complement_;
  mutable Numbers velocities_;   // work space (n)
  mutable Numbers multipliers_;  // likewise (g)
  double regularity_ = 1;
};

}  // namespace hybrid_sphere::mechanics
