#pragma once

#include <pybind11/pybind11.h>

#include "python/number.hpp"

/// hybrid_sphere.Number as an object of Python: its doubles lie in the object itself.
namespace hybrid_sphere::python {

struct NumberObject {
  PyVarObject head;
  NumberShape shape;
  double data[1];  // shape.size()

  NumberView view() const { return {shape, data}; }
};

/// A new one, whose numbers are not set; throws error_already_set where there is no memory.
NumberObject* new_number(const NumberShape& shape);
/// A new one whose derivatives are all 0.
NumberObject* new_number(const NumberShape& shape, double value);
inline PyObject* as_object(NumberObject* number) { return reinterpret_cast<PyObject*>(number); }

/// What arithmetic takes: a Number, or a real number of Python or numpy.
struct Operand {
  double value = 0;
  const NumberObject* number = nullptr;  ///< null: a real number

  bool is_constant() const { return number == nullptr || number->shape.is_constant(); }
  double slope(int i) const { return is_constant() ? 0 : number->view().slope(i); }
  double second(int i, int j) const { return is_constant() ? 0 : number->view().second(i, j); }
};

/// Whether an object is one of these; no exception is set where it is not.
bool read(PyObject* object, Operand& operand);

void declare_number(pybind11::module_& module);

}  // namespace hybrid_sphere::python
