#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "hybrid_sphere/mechanics/model.hpp"

namespace hybrid_sphere::mechanics {

/// Returns true if the constraint of this index is in the active set.
inline bool contains(const ActiveSet& active, std::size_t constraint) {
  return std::binary_search(active.begin(), active.end(), constraint);
}

/// The functions f (g) of the constraints that hold, stacked in the order of the active set.
class ActiveConstraints {
 public:
  /// @param model  must outlive this object
  explicit ActiveConstraints(const Model& model) : model_(&model) {}

  void set(const ActiveSet& active);
  Index size() const { return static_cast<Index>(owner_.size()); }  ///< g
  const ActiveSet& active() const { return active_; }

  /// f (g) and C = df/dv (g x n). Throws NotFinite, naming the constraint.
  void evaluate(double t, const Vector& q, const Vector& v, Vector& value, Matrix& gradient);

  /// Copies the columns of a constraint's C that are not always 0 into its rows of all constraints' C.
  /// @param i  its place in the active set @param row  its first one
  void copy_gradient(std::size_t i, Index row, const Matrix& from, Matrix& to) const;

  /// Adds the sum over beta of multipliers_beta d2f_beta/dv2 to `sum` (n x n). Throws NotFinite.
  void add_curvature(double t, const Vector& q, const Vector& v, const Vector& multipliers, Matrix& sum);

  /// The constraints to which the functions belong, ascending. @param rows  ascending
  ActiveSet owners(const std::vector<Index>& rows) const;

  /// "constraint rolling", or "function 2 of constraint rolling" if it has several.
  std::string name_of(Index row) const;

 private:
  bool have_same_columns() const;
  void set_columns();

  const Model* model_;
  ActiveSet active_;
  std::vector<std::size_t> owner_;  // of each row
  /// Columns from begin to end, without end.
  struct Columns {
    Index begin, end;
  };
  std::vector<std::vector<Columns>> columns_;  // by constraint of the active set: those that are not always 0
  bool is_dense_ = true;                       // whether these are all columns
  std::vector<Vector> values_;                 // by constraint of the active set
  std::vector<Matrix> gradients_;
  std::vector<Vector> multipliers_;
};

}  // namespace hybrid_sphere::mechanics
