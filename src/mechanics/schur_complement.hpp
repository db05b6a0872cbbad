#pragma once

#include <vector>

#include "hybrid_sphere/mechanics/equations_of_motion.hpp"
#include "mechanics/block_pattern.hpp"

namespace hybrid_sphere::mechanics {

/// The equations of SaddlePoint where they are far from singular, by the decompositions L D L^T of M and of
/// C M^-1 C^T, block by block: M is positive definite by itself, and the rows of C are well apart from one
/// another in its metric. All that is doubtful is left to SaddlePoint. Allocates nothing after set_pattern().
///
/// A tree of rigid bodies costs a number of operations proportional to the number of its joints.
class SchurComplement {
 public:
  /// The blocks of the next decompositions.
  void set_pattern(BlockPattern pattern);

  /// Decomposes M (n x n) and C.
  /// @param gradient  C (g x n); without a pattern of its size, it is dense
  /// @param rows      the rows of C that count, ascending; null: all
  /// @return  false where they are not regular enough
  bool decompose(const Matrix& mass, const Matrix& gradient, const std::vector<Index>* rows = nullptr);

  // After a decomposition, until the next one, where g is the number of rows that count:

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
  /// The rows of a group that count.
  struct Rows {
    std::size_t count;
    std::size_t first;  ///< number of the first one among all that count
  };
  /// A row that is nearly all one velocity's.
  struct Tie {
    std::size_t group, row, velocity;
  };

  void set_rows(const std::vector<Index>* rows);
  // Size is the number of velocities in a block of M, or of rows in a group, or a type whose value it is.
  template <class Size>
  bool copy_mass(const Matrix& mass, Size size);
  template <class Size>
  bool decompose_mass(const Matrix& mass, Size size);
  template <class Size>
  bool set_images(const Matrix& gradient, Size size);
  template <class Size>
  bool set_tie(std::size_t group, std::size_t row, Size size);
  template <class Size>
  void multiply_images(Size size);
  bool decompose_complement();
  template <class Size>
  bool eliminate(std::size_t group, Size size);

  // With the velocities, or the multipliers, in place:
  template <class Size, class Solve>
  void solve_mass(Solve solve, Size size) const;
  template <class Size>
  void tie(const Vector& wanted, Size size) const;
  void solve_complement() const;
  void gather(const Vector& numbers) const;
  bool give(Vector& x, Vector& y) const;
  template <class Function>
  void for_each_row(Function function) const;

  BlockPattern pattern_;
  std::vector<Rows> kept_;           // by group
  std::vector<std::size_t> source_;  // rows of C that count, from the first row of their group on
  bool are_all_ = true;
  std::vector<Index> chosen_;  // rows that count, otherwise
  std::size_t count_ = 0;      // of them
  // A block of M after another, row by row:
  Numbers triangles_;  // M
  bool is_mass_decomposed_ = false;
  Numbers mass_;                   // L
  Numbers inverse_mass_;           // of D (n)
  std::vector<char> is_diagonal_;  // whether a block of M is
  // All entries, row by row:
  Numbers rows_;      // C
  Numbers images_;    // L^-1 C^T, transposed
  Numbers weighted_;  // D^-1 L^-1 C^T, transposed
  std::vector<Tie> ties_;
  Numbers diagonal_;    // of C M^-1 C^T
  Numbers complement_;  // C M^-1 C^T, then its L
  Numbers scaled_;      // L D, off the diagonal blocks
  Numbers inverse_complement_;
  Numbers of_row_;               // work space for a row
  mutable Numbers velocities_;   // work space (n)
  mutable Numbers multipliers_;  // likewise, by rows of the pattern
  double regularity_ = 1;
};

}  // namespace hybrid_sphere::mechanics
