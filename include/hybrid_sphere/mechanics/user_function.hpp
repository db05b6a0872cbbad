#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>

#include "hybrid_sphere/mechanics/dual.hpp"
#include "hybrid_sphere/mechanics/equations_of_motion.hpp"

/// What user functions are called with, and what they may return.
namespace hybrid_sphere::mechanics::user_function {

template <class T, int size>
using VectorOf = CheckedVector<T, size>;

/// Numbers with derivatives along c directions, and along the motion.
struct FirstDerivatives {
  template <int c>
  using Number = Dual<double, c + 1>;
  static constexpr int least = 1;
};

/// Numbers with derivatives along c directions, of those along c directions and along the motion. Of fewer
/// than four a call costs more than they do.
struct SecondDerivatives {
  template <int c>
  using Number = Dual<Dual<double, c + 1>, c>;
  static constexpr int least = 4;
};

/// How many of n directions are differentiated at once, with the numbers of `Order`: all, if a user function
/// may then hold a square matrix of its numbers, with as many rows as there are coordinates, as an Eigen
/// object of fixed size, for which Eigen has a limit; otherwise an even share of the fewest calls for which
/// it may.
template <class Order, int n, int side, int calls = 1>
constexpr int directions_at_once() {
  constexpr std::size_t limit = 0x20000;  // [bytes], 128 kB, Eigen's own
  constexpr int share = (n + calls - 1) / calls;
  if constexpr (share <= Order::least ||
                sizeof(typename Order::template Number<share>) * side * side <= limit) {
    return share;
  } else {
    return directions_at_once<Order, n, side, calls + 1>();
  }
}

/// Calls function(first, count) for one part of 0, 1, ..., n - 1 after another; count is a type whose value
/// is the number of the part's members: `at_once`, or what the last part has.
template <int n, int at_once, class Function>
void each_part(Function function) {
  int first = 0;
  for (; first + at_once <= n; first += at_once) function(first, std::integral_constant<int, at_once>());
  if constexpr (n % at_once != 0) function(first, std::integral_constant<int, n % at_once>());
}

template <class Derived>
std::true_type is_matrix(const Eigen::MatrixBase<Derived>*);
std::false_type is_matrix(const void*);

/// Rows and columns of a result, known from its type: 1 x 1 for a number. Eigen::Dynamic where the type does
/// not fix them.
/// @code
/// using Result = Eigen::Vector2d;
/// static_assert(mechanics::user_function::Shape<Result>::rows == 2);
/// @endcode
template <class Result, bool matrix = decltype(is_matrix(static_cast<const Result*>(nullptr)))::value>
struct Shape {
  static constexpr int rows = 1;
  static constexpr int columns = 1;
};
template <class Result>
struct Shape<Result, true> {
  static constexpr int rows = Result::RowsAtCompileTime;
  static constexpr int columns = Result::ColsAtCompileTime;
};

/// Converts a result to numbers of type T. T, double and int count as numbers; a matrix may be an expression.
template <class T, int rows, int columns, class Result>
Eigen::Matrix<T, rows, columns> to_matrix(const Result& result) {
  static_assert(Shape<Result>::rows == rows && Shape<Result>::columns == columns,
                "wrong sizes: the function returns a matrix, vector or number of other than the wanted size, "
                "which has to be fixed");
  if constexpr (decltype(is_matrix(&result))::value) {
    return result.template cast<T>();
  } else {
    static_assert(std::is_convertible_v<Result, T>, "the function returns neither a number nor a vector");
    return Eigen::Matrix<T, rows, columns>::Constant(T(result));
  }
}

template <class T, int size, class Result>
VectorOf<T, size> to_vector(const Result& result) {
  return to_matrix<T, size, 1>(result);
}

template <class T, class Result>
T to_number(const Result& result) {
  return to_matrix<T, 1, 1>(result)[0];
}

/// Throws std::invalid_argument if `vector` does not have `size` numbers. @param name  "q"
template <int size>
VectorOf<double, size> fixed(const char* name, const Vector& vector) {
  if (vector.size() != size) {
    throw std::invalid_argument(std::string(name) + " has " + std::to_string(vector.size()) +
                                " numbers, not " + std::to_string(size));
  }
  return vector;
}

/// Throws NotFinite, naming the function, if its value is not finite.
inline void check_value(bool finite, std::string_view function) {
  if (!finite) throw NotFinite(std::string(function));
}
/// Throws NotFinite with "derivative of " and the name of the function if a derivative is not finite.
inline void check_derivative(bool finite, std::string_view function) {
  if (!finite) throw NotFinite("derivative of " + std::string(function));
}

}  // namespace hybrid_sphere::mechanics::user_function
