#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <type_traits>
#include <vector>

#include "hybrid_sphere/mechanics/elementary_functions.hpp"

namespace hybrid_sphere::mechanics {

/// What has been calculated with TapedNumbers, in its order, for the gradient of a sum of the results with
/// respect to all inputs (reverse mode): it costs a few times what the results cost, however many inputs
/// there are. Keeps its memory.
/// @code
/// mechanics::Tape tape;
/// const mechanics::TapedNumber x = tape.input(3.0, 0.0), y = x * x;
/// tape.seed(y, 1);
/// tape.propagate();
/// const double slope = tape.adjoint(x);  // 6
/// @endcode
class Tape {
 public:
  /// An operation of up to two arguments, with its derivatives along them.
  struct Operation {
    int x, y;  // places on the tape; `nowhere`: none
    double slope_x, slope_y;
  };
  static constexpr int nowhere = -1;

  inline class TapedNumber input(double value, double rate);

  /// @return  its place
  int record(const Operation& operation) {
    operations_.push_back(operation);
    return static_cast<int>(operations_.size()) - 1;
  }
  int size() const { return static_cast<int>(operations_.size()); }
  /// Forgets all from the place `size` on, and all adjoints.
  void resize(int size) {
    operations_.resize(static_cast<std::size_t>(size));
    adjoints_.clear();
  }

  /// Adds a result of this weight to the sum.
  inline void seed(const TapedNumber& result, double weight);
  /// Finds the derivatives of the sum along all that is on the tape.
  void propagate() {
    adjoints_.resize(operations_.size());
    for (std::size_t i = operations_.size(); i-- > 0;) {
      const Operation& operation = operations_[i];
      if (operation.x != nowhere) adjoints_[std::size_t(operation.x)] += operation.slope_x * adjoints_[i];
      if (operation.y != nowhere) adjoints_[std::size_t(operation.y)] += operation.slope_y * adjoints_[i];
    }
  }
  /// The derivative of the sum along an input, after propagate().
  inline double adjoint(const TapedNumber& input) const;

 private:
  std::vector<Operation> operations_;
  std::vector<double> adjoints_;
};

/// A number that is recorded on a tape, with its derivative along the motion. It has all operators and
/// functions of Dual, with the same rules. Constants are on no tape.
class TapedNumber : public ElementaryFunctions<TapedNumber> {
 public:
  double value = 0;
  double rate = 0;  ///< derivative along the motion

  TapedNumber() = default;
  /// A constant.
  template <class Number, class = std::enable_if_t<std::is_arithmetic_v<Number>>>
  TapedNumber(Number constant) : value(static_cast<double>(constant)) {}

  bool is_constant() const { return tape_ == nullptr; }

  TapedNumber& operator+=(const TapedNumber& b) { return *this = *this + b; }
  TapedNumber& operator-=(const TapedNumber& b) { return *this = *this - b; }
  TapedNumber& operator*=(const TapedNumber& b) { return *this = *this * b; }
  TapedNumber& operator/=(const TapedNumber& b) { return *this = *this / b; }

  friend TapedNumber operator+(const TapedNumber& a) { return a; }
  friend TapedNumber operator-(const TapedNumber& a) { return chain(a, -a.value, -1, 0); }
  friend TapedNumber operator+(const TapedNumber& a, const TapedNumber& b) {
    return combine(a, b, a.value + b.value, 1, 1);
  }
  friend TapedNumber operator-(const TapedNumber& a, const TapedNumber& b) {
    return combine(a, b, a.value - b.value, 1, -1);
  }
  friend TapedNumber operator*(const TapedNumber& a, const TapedNumber& b) {
    return combine(a, b, a.value * b.value, b.value, a.value);
  }
  friend TapedNumber operator/(const TapedNumber& a, const TapedNumber& b) {
    const double quotient = a.value / b.value;
    return combine(a, b, quotient, 1 / b.value, -quotient / b.value);
  }

  /// f(x). @param value  f @param slope  f'
  friend TapedNumber chain(const TapedNumber& x, double value, double slope, double /*curvature*/) {
    TapedNumber result;
    result.value = value;
    if (x.is_constant()) return result;
    result.rate = slope * x.rate;
    result.tape_ = x.tape_;
    result.place_ = x.tape_->record({x.place_, Tape::nowhere, slope, 0});
    return result;
  }
  /// f(x, y)
  friend TapedNumber chain(const TapedNumber& x, const TapedNumber& y, const Partials& f) {
    return combine(x, y, f.value, f.x, f.y);
  }

 private:
  friend class Tape;

  static TapedNumber combine(const TapedNumber& x, const TapedNumber& y, double value, double slope_x,
                             double slope_y) {
    if (y.is_constant()) return chain(x, value, slope_x, 0);
    if (x.is_constant()) return chain(y, value, slope_y, 0);
    TapedNumber result;
    result.value = value;
    result.rate = slope_x * x.rate + slope_y * y.rate;
    result.tape_ = x.tape_;
    result.place_ = x.tape_->record({x.place_, y.place_, slope_x, slope_y});
    return result;
  }

  Tape* tape_ = nullptr;
  int place_ = Tape::nowhere;
};

inline TapedNumber Tape::input(double value, double rate) {
  TapedNumber number = value;
  number.rate = rate;
  number.tape_ = this;
  number.place_ = record({nowhere, nowhere, 0, 0});
  return number;
}

inline void Tape::seed(const TapedNumber& result, double weight) {
  if (result.is_constant()) return;
  adjoints_.resize(operations_.size());
  adjoints_[std::size_t(result.place_)] += weight;
}

inline double Tape::adjoint(const TapedNumber& input) const { return adjoints_[std::size_t(input.place_)]; }

/// The value of x without derivatives.
inline double plain(const TapedNumber& x) { return x.value; }
inline bool is_constant(const TapedNumber& x) { return x.is_constant(); }

}  // namespace hybrid_sphere::mechanics

namespace Eigen {

template <>
struct NumTraits<hybrid_sphere::mechanics::TapedNumber> : NumTraits<double> {
  using Real = hybrid_sphere::mechanics::TapedNumber;
  using NonInteger = Real;
  using Nested = Real;
  enum { RequireInitialization = 1, ReadCost = 4, AddCost = 8, MulCost = 8 };
};

template <class Operation>
struct ScalarBinaryOpTraits<hybrid_sphere::mechanics::TapedNumber, double, Operation> {
  using ReturnType = hybrid_sphere::mechanics::TapedNumber;
};
template <class Operation>
struct ScalarBinaryOpTraits<double, hybrid_sphere::mechanics::TapedNumber, Operation> {
  using ReturnType = hybrid_sphere::mechanics::TapedNumber;
};

}  // namespace Eigen
