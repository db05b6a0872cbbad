#include "mechanics/kept_rows.hpp"

namespace hybrid_sphere::mechanics {

const Matrix& KeptRows::of(const Matrix& all) {
  if (are_all()) return all;
  matrix_.resize(static_cast<Index>(rows_->size()), all.cols());
  for (Index s = 0; s < all.cols(); ++s) {
    Index kept = 0;
    for (const Index row : *rows_) matrix_(kept++, s) = all(row, s);
  }
  return matrix_;
}

const Vector& KeptRows::of(const Vector& all) {
  if (are_all()) return all;
  vector_.resize(static_cast<Index>(rows_->size()));
  Index kept = 0;
  for (const Index row : *rows_) vector_[kept++] = all[row];
  return vector_;
}

void KeptRows::spread(const Vector& kept, Vector& all) const {
  if (are_all()) {
    all = kept;
    return;
  }
  all.setZero();
  Index place = 0;
  for (const Index row : *rows_) all[row] = kept[place++];
}

KeptRows::Rows Redundancy::see(double t, Index rank, Index count, const std::vector<Index>& rows) {
  if (rank > rank_) {
    rank_ = rank;
    time_ = t;
    return nullptr;
  }
  if (rank < rank_ || rank == count || t == time_) return nullptr;
  return std::make_shared<const std::vector<Index>>(rows);
}

}  // namespace hybrid_sphere::mechanics
