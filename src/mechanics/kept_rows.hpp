#pragma once

#include <memory>
#include <vector>

#include "hybrid_sphere/mechanics/equations_of_motion.hpp"

namespace hybrid_sphere::mechanics {

/// The rows of C by which a motion is computed if the others depend on them all along it. Off the
/// constraints, as a stage of a step is, dependent rows become independent of one another and would lock the
/// motion.
class KeptRows {
 public:
  /// Numbers of rows, ascending; null: all rows.
  using Rows = std::shared_ptr<const std::vector<Index>>;

  void set(Rows rows) { rows_ = std::move(rows); }
  bool are_all() const { return rows_ == nullptr; }
  /// Null: all.
  const std::vector<Index>* rows() const { return rows_.get(); }

  /// The kept rows of a matrix or of a vector (g rows), valid until the next call for the same kind.
  const Matrix& of(const Matrix& all);
  const Vector& of(const Vector& all);

  /// Puts the kept numbers in their places among g; 0 elsewhere.
  void spread(const Vector& kept, Vector& all) const;

 private:
  Rows rows_;
  Matrix matrix_;
  Vector vector_;
};

/// Decides at the nodes of a segment whether rows of C depend on others all along it. At a singular position
/// alone the rank is less, too: it counts once two nodes have had it, and none has had a larger one.
class Redundancy {
 public:
  void begin() { *this = {}; }

  /// @param rank  of C at the node @param rows  that are independent of one another
  /// @return  the rows to keep in the step from the node
  KeptRows::Rows see(double t, Index rank, Index count, const std::vector<Index>& rows);

 private:
  Index rank_ = -1;  // the largest
  double time_ = 0;  // at which it was found first
};

}  // namespace hybrid_sphere::mechanics
