#pragma once

#include <pybind11/pybind11.h>

#include <string>
#include <vector>

#include "hybrid_sphere/mechanics/vector.hpp"
#include "python/collected.hpp"
#include "python/number_object.hpp"

namespace hybrid_sphere::python {

using mechanics::Index;
using mechanics::Vector;

/// What a user's function has returned.
class Results {
 public:
  Results(pybind11::object owner, std::vector<Operand> numbers)
      : owner_(std::move(owner)), numbers_(std::move(numbers)) {}
  Index size() const { return static_cast<Index>(numbers_.size()); }
  const Operand& operator[](Index i) const { return numbers_[static_cast<std::size_t>(i)]; }

 private:
  pybind11::object owner_;  // of the numbers
  std::vector<Operand> numbers_;
};

/// A function of (t, q, v), or fewer of them, that a user has written in Python. All of it needs the lock of
/// the interpreter.
class PythonFunction {
 public:
  /// @param label  the name that messages have: "constraint blade"
  /// @param kept  whoever calls the function has them
  PythonFunction(std::string label, const pybind11::object& function, KeptFunctions& kept);

  /// Calls it for one number, or for a vector of `size` numbers; any_size: for a number or a vector.
  /// Throws what it raises; ValueError or TypeError where it returns anything else, or Numbers with
  /// derivatives other than `shape`; NotFinite where a value is not finite.
  static constexpr Index any_size = -1;
  static constexpr Index one = 0;
  template <class... Arguments>
  Results operator()(Index size, const NumberShape& shape, const Arguments&... arguments) const {
    return results_of(function_(arguments...), size, shape);
  }

  /// Calls it for any object. Throws what it raises.
  template <class... Arguments>
  pybind11::object call(const Arguments&... arguments) const {
    return function_(arguments...);
  }

  const std::string& label() const { return label_; }
  /// Throws NotFinite, "derivative of ...".
  void check_derivative(bool is_finite) const;

 private:
  Results results_of(pybind11::object result, Index size, const NumberShape& shape) const;
  Operand number_of(PyObject* object, const NumberShape& shape) const;
  [[noreturn]] void refuse(const pybind11::object& result, Index size) const;

  std::string label_;
  pybind11::handle function_;
};

/// A Number, for an argument. @param slope  index of the derivative that is 1; -1: none
pybind11::object number(double value, const NumberShape& shape, int slope = -1);

/// An array of Numbers (values.size()). @param set  set(i, slopes), sets some slopes of the component i
template <class Set>
pybind11::object numbers(const Vector& values, const NumberShape& shape, Set set);

/// Without derivatives.
pybind11::object numbers(const Vector& values);

/// An array of floats.
pybind11::object floats(const Vector& values);

/// An array for `size` objects whose items are empty. @param items  out: where these are
pybind11::object object_array(Index size, PyObject**& items);

template <class Set>
pybind11::object numbers(const Vector& values, const NumberShape& shape, Set set) {
  PyObject** items = nullptr;
  pybind11::object array = object_array(values.size(), items);
  for (Index i = 0; i < values.size(); ++i) {
    NumberObject* const item = new_number(shape, values[i]);
    items[i] = as_object(item);
    set(i, item->data + 1);
  }
  return array;
}

}  // namespace hybrid_sphere::python
