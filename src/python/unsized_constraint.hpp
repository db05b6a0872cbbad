#pragma once

#include "hybrid_sphere/mechanics/solution.hpp"

namespace hybrid_sphere::python {

/// A constraint whose number of functions shows when it is called.
class UnsizedConstraint : public mechanics::ConstraintFunction {
 public:
  mechanics::Index size() const override { return size_; }
  /// Calls the function, unless the size is known.
  void find_size(double t, const mechanics::Vector& q, const mechanics::Vector& v) const {
    if (size_ == 0) size_ = count(t, q, v);
  }
  /// Where the size is known from the same constraint for another input.
  void set_size(mechanics::Index size) const {
    if (size_ == 0) size_ = size;
  }

 private:
  virtual mechanics::Index count(double t, const mechanics::Vector& q, const mechanics::Vector& v) const = 0;

  mutable mechanics::Index size_ = 0;  // behind the lock of the interpreter
};

inline void set_size(const mechanics::Constraint& constraint, mechanics::Index size) {
  const auto* const unsized_one = dynamic_cast<const UnsizedConstraint*>(constraint.function.get());
  if (unsized_one != nullptr) unsized_one->set_size(size);
}

/// The sizes of all constraints of a model.
inline void find_sizes(const mechanics::Model& model, const mechanics::Initial& at) {
  for (const mechanics::Constraint& constraint : model.constraints) {
    const auto* const unsized_one = dynamic_cast<const UnsizedConstraint*>(constraint.function.get());
    if (unsized_one != nullptr) unsized_one->find_size(at.time, at.q, at.v);
  }
}

}  // namespace hybrid_sphere::python
