#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstddef>
#include <string_view>
#include <type_traits>

#include "hybrid_sphere/export.hpp"
#include "hybrid_sphere/mechanics/dual.hpp"
#include "hybrid_sphere/mechanics/equations_of_motion.hpp"
#include "hybrid_sphere/mechanics/hyper_dual.hpp"

/// What user functions are called with, and what they may return.
namespace hybrid_sphere::mechanics::user_function {

template <class T, int size>
using VectorOf = CheckedVector<T, size>;

template <class T, int size>
using ArrayOf = T[std::size_t(size)];

[[noreturn]] HYBRID_SPHERE_EXPORT void refuse_size(const char* name, Index found, Index size);
[[noreturn]] HYBRID_SPHERE_EXPORT void refuse_value(std::string_view function);
[[noreturn]] HYBRID_SPHERE_EXPORT void refuse_derivative(std::string_view function);

/// Numbers with derivatives along c directions, and along the motion.
struct FirstDerivatives {
  template <int c>
  using Number = Dual<double, c + 1>;
  static constexpr int least = 1;
};

/// Numbers with derivatives along c directions, and of those along the motion.
struct DerivativesAlongMotion {
  template <int c>
  using Number = Dual<Dual<double, 1>, c>;
  static constexpr int least = 1;
};

/// Whether Eigen lets a square matrix of such numbers be an object of fixed size.
template <class Number, int side>
constexpr bool fits() {
  constexpr std::size_t limit = 0x20000;  // [bytes], 128 kB, Eigen's own
  return sizeof(Number) * side * side <= limit;
}

/// How many of n directions are differentiated at once, with the numbers of `Order`: all, if a user function
/// may then hold a square matrix of its numbers, with as many rows as there are coordinates, as an Eigen
/// object of fixed size, for which Eigen has a limit; otherwise an even share of the fewest calls for which
/// it may.
template <class Order, int n, int side, int calls = 1>
constexpr int directions_at_once() {
  constexpr int share = (n + calls - 1) / calls;
  if constexpr (share <= Order::least || fits<typename Order::template Number<share>, side>()) {
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

/// The calls that give all second derivatives along n velocities: one with all of them, if a user function
/// may then hold a square matrix of its numbers, as above. Otherwise the velocities are divided into groups,
/// and each two groups have a call.
template <int n, int side, int groups = 1>
constexpr int groups_of_velocities() {
  constexpr int at_once = groups == 1 ? n : 2 * ((n + groups - 1) / groups);
  if constexpr (at_once <= 2 || fits<HyperDual<at_once>, side>()) {
    return groups;
  } else {
    return groups_of_velocities<n, side, groups + 1>();
  }
}

template <int n, int side>
class SecondDerivatives {
  static constexpr int groups = groups_of_velocities<n, side>();
  static constexpr int in_group = (n + groups - 1) / groups;

 public:
  static constexpr int at_once = groups == 1 ? n : 2 * in_group;
  using Number = HyperDual<at_once>;

  /// Calls function(along) for each call: along[a] is the velocity along which the derivative a is taken, or
  /// `none`.
  template <class Function>
  static void each_call(Function function) {
    if constexpr (groups == 1) {
      function(All());
    } else {
      for (int first = 0; first < groups; ++first) {
        for (int second = first + 1; second < groups; ++second) function(pair(first, second));
      }
    }
  }
  static constexpr int none = -1;

 private:
  struct All {
    constexpr int operator[](int a) const { return a; }
  };
  struct Some {
    int velocities[std::size_t(at_once)];
    int operator[](int a) const { return velocities[a]; }
  };
  static Some pair(int first, int second) {
    Some along;
    for (int a = 0; a < in_group; ++a) {
      const auto member = [a](int group) { return group * in_group + a < n ? group * in_group + a : none; };
      along.velocities[a] = member(first);
      along.velocities[in_group + a] = member(second);
    }
    return along;
  }
};

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

template <class Derived>
std::true_type is_plain(const Eigen::PlainObjectBase<Derived>*);
std::false_type is_plain(const void*);

/// Converts a result to numbers of type T, a column after another. T, double and int count as numbers; a
/// matrix may be an expression.
template <class T, int rows, int columns, class Result>
void convert(const Result& result, T* numbers) {
  static_assert(Shape<Result>::rows == rows && Shape<Result>::columns == columns,
                "wrong sizes: the function returns a matrix, vector or number of other than the wanted size, "
                "which has to be fixed");
  if constexpr (decltype(is_plain(&result))::value) {
    for (int j = 0; j < columns; ++j) {
      for (int i = 0; i < rows; ++i) numbers[j * rows + i] = result.coeff(i, j);
    }
  } else if constexpr (decltype(is_matrix(&result))::value) {
    convert<T, rows, columns>(result.eval(), numbers);
  } else {
    static_assert(std::is_convertible_v<Result, T>, "the function returns neither a number nor a vector");
    numbers[0] = T(result);
  }
}

template <class T, class Result>
T to_number(const Result& result) {
  T number;
  convert<T, 1, 1>(result, &number);
  return number;
}

/// Throws std::invalid_argument if `vector` does not have `size` numbers. @param name  "q"
inline void check_size(const char* name, const Vector& vector, Index size) {
  if (vector.size() != size) refuse_size(name, vector.size(), size);
}

/// Gives a number without derivatives its value.
inline void set_value(double& number, double value) { number = value; }
template <class T>
void set_value(T& number, double value) {
  set_value(number.value, value);
}

/// Constants of type T. Set in place: copying a number with many derivatives is slow.
template <class T, int size>
VectorOf<T, size> constants(const VectorOf<double, size>& numbers) {
  VectorOf<T, size> result;
  for (int i = 0; i < size; ++i) set_value(result.coeffRef(i), numbers.coeff(i));
  return result;
}
/// The same from a vector. Throws std::invalid_argument if it does not have `size` numbers. @param name  "q"
template <class T, int size>
VectorOf<T, size> constants(const char* name, const Vector& numbers) {
  check_size(name, numbers, size);
  VectorOf<T, size> result;
  for (int i = 0; i < size; ++i) set_value(result.coeffRef(i), numbers.coeff(i));
  return result;
}

/// Throws NotFinite, naming the function, if its value is not finite.
inline void check_value(bool finite, std::string_view function) {
  if (!finite) refuse_value(function);
}
/// Throws NotFinite with "derivative of " and the name of the function if a derivative is not finite.
inline void check_derivative(bool finite, std::string_view function) {
  if (!finite) refuse_derivative(function);
}

}  // namespace hybrid_sphere::mechanics::user_function
