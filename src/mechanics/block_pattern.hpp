#pragma once

#include <cstddef>
#include <set>
#include <vector>

#include "hybrid_sphere/mechanics/model.hpp"

namespace hybrid_sphere::mechanics {

/// Which blocks of M, C and C M^-1 C^T have numbers, and in which order the rows of C are eliminated. The
/// rows belong to groups, those of one constraint each; C M^-1 C^T has a block for two groups that share a
/// block of M, and for two that elimination connects. The next group to be eliminated is the one that is
/// connected with the fewest others: in a tree of bodies, from its leaves on. Source: A. George and J. W. H.
/// Liu, Computer Solution of Large Sparse Positive Definite Systems (1981), ch. 5 (minimum degree).
class BlockPattern {
 public:
  /// One block of n velocities, and one group of g rows.
  static BlockPattern dense(std::size_t n, std::size_t g);
  /// The blocks of the equations, and a group for each of these constraints. Dense if there is one block.
  static BlockPattern of(const Model& model, const ActiveSet& active);

  /// A part of C: rows of a group, columns of a block of M.
  struct Entry {
    std::size_t block;
    std::size_t place;  ///< of its first number among those of all entries
  };
  /// A block of the lower triangle of C M^-1 C^T below the diagonal.
  struct Coupling {
    std::size_t group;  ///< its rows; the columns are of a group eliminated before
    std::size_t place;  ///< of its first number
  };
  /// Adds the product of two entries to the block of their groups.
  struct Product {
    std::size_t rows, columns;              ///< groups; the same ones on the diagonal
    std::size_t rows_place, columns_place;  ///< of the entries
    std::size_t place;                      ///< of the block
  };
  struct Group {
    std::size_t size;   ///< rows
    std::size_t first;  ///< row of C
    std::vector<Entry> entries;
    std::size_t diagonal;             ///< place of its block of C M^-1 C^T
    std::vector<Coupling> couplings;  ///< of its columns, with the groups eliminated after it
    std::vector<std::size_t> fill;    ///< places of the blocks for each two of the couplings, j <= i
  };

  std::size_t velocities() const { return block_ * blocks_; }
  std::size_t rows() const { return rows_; }
  std::size_t block() const { return block_; }    ///< velocities in a block of M
  std::size_t blocks() const { return blocks_; }  ///< their number
  const std::vector<Group>& groups() const { return groups_; }
  const std::vector<std::size_t>& order() const { return order_; }
  const std::vector<Product>& products() const { return products_; }
  std::size_t entry_numbers() const { return entry_numbers_; }        ///< of all entries together
  std::size_t triangle_numbers() const { return triangle_numbers_; }  ///< of C M^-1 C^T

 private:
  void add_group(std::size_t size, const std::vector<std::size_t>& blocks);
  void finish();
  std::vector<std::set<std::size_t>> neighbours() const;
  void eliminate();
  void place_blocks();
  void add_products();
  std::size_t place_of(std::size_t row, std::size_t column) const;

  std::size_t block_ = 0;
  std::size_t blocks_ = 0;
  std::size_t rows_ = 0;
  std::vector<Group> groups_;
  std::vector<std::size_t> order_;  // of elimination
  std::vector<std::size_t> turn_;   // of each group in it
  std::vector<Product> products_;
  std::size_t entry_numbers_ = 0;
  std::size_t triangle_numbers_ = 0;
};

}  // namespace hybrid_sphere::mechanics
