#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <utility>

#include "hybrid_sphere/export.hpp"

namespace hybrid_sphere::mechanics {

using Eigen::Index;

/// Throws std::out_of_range: there is no component i.
[[noreturn]] HYBRID_SPHERE_EXPORT void refuse_index(Index i, Index size);

/// A column vector of Eigen whose [i] and (i) throw std::out_of_range, with the index and the size, where
/// there is no such component, in every build. Everything else is Eigen's.
/// @tparam size  the number of components, or Eigen::Dynamic
/// @code
/// const mechanics::CheckedVector<double, 2> v = {1, 2};
/// const double sum = v[0] + v[1];  // v[2] would throw
/// @endcode
template <class T, int size>
class CheckedVector : public Eigen::Matrix<T, size, 1> {
 public:
  using Base = Eigen::Matrix<T, size, 1>;
  using Base::Base;
  using Base::operator=;
  using Base::operator();
  using Base::operator[];

  CheckedVector() = default;
  CheckedVector(const Base& other) : Base(other) {}
  CheckedVector(Base&& other) : Base(std::move(other)) {}
  /// Its components. Throws std::out_of_range if their number is fixed and another.
  CheckedVector(std::initializer_list<T> components) { *this = components; }

  CheckedVector& operator=(std::initializer_list<T> components) {
    const auto given = static_cast<Index>(components.size());
    if (size != Eigen::Dynamic && given != size) refuse_index(given - 1, size);
    this->resize(given);
    std::copy(components.begin(), components.end(), this->data());
    return *this;
  }

  const T& operator[](Index i) const { return this->coeffRef(checked(i)); }
  T& operator[](Index i) { return this->coeffRef(checked(i)); }
  const T& operator()(Index i) const { return this->coeffRef(checked(i)); }
  T& operator()(Index i) { return this->coeffRef(checked(i)); }

 private:
  Index checked(Index i) const {
    if (i < 0 || i >= this->size()) refuse_index(i, this->size());
    return i;
  }
};

using Vector = CheckedVector<double, Eigen::Dynamic>;

/// Whether all numbers are finite. Eigen's allFinite() takes several times as long.
inline bool are_finite(const double* numbers, Index count) {
  bool finite = true;
  for (Index i = 0; i < count; ++i) finite &= std::abs(numbers[i]) <= std::numeric_limits<double>::max();
  return finite;
}
template <class Derived>
bool is_finite(const Eigen::PlainObjectBase<Derived>& numbers) {
  return are_finite(numbers.data(), numbers.size());
}

}  // namespace hybrid_sphere::mechanics
