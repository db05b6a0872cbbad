#include "python/number_object.hpp"
#include "python/numbers_of.hpp"

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

#include "python/number_arithmetic.hpp"
#include "python/number_ufunc.hpp"
#include "text/refusal.hpp"

namespace hybrid_sphere::python {
namespace {

namespace py = pybind11;

// Objects of the module, which live as long as the interpreter.
PyTypeObject* number_type = nullptr;
std::array<PyTypeObject*, 3> numpy_numbers{};

NumberObject* as_number(PyObject* object) { return reinterpret_cast<NumberObject*>(object); }

void deallocate(PyObject* self) {
  PyTypeObject* const type = Py_TYPE(self);
  PyObject_Free(self);
  Py_DECREF(type);
}

PyObject* represent(PyObject* self) {
  const NumberView x = as_number(self)->view();
  std::string text = "Number(" + text::shortest(x.value());
  for (int i = 0; i < x.shape.slopes; ++i) text += (i == 0 ? ", [" : ", ") + text::shortest(x.slope(i));
  text += x.shape.slopes > 0 ? "])" : ")";
  return PyUnicode_FromString(text.c_str());
}

PyObject* compare(PyObject* a, PyObject* b, int operation) {
  Operand x, y;
  if (!read(a, x) || !read(b, y)) Py_RETURN_NOTIMPLEMENTED;
  Py_RETURN_RICHCOMPARE(x.value, y.value, operation);
}

int is_not_zero(PyObject* self) { return as_number(self)->data[0] != 0 ? 1 : 0; }

PyObject* refuse_float(PyObject* /*self*/) {
  PyErr_SetString(
      PyExc_TypeError,
      "a Number has derivatives, which float(), the functions of math and arrays of floats would lose: "
      "take those of numpy, np.sin(q[0]), and arrays of objects, np.array([q[0], 0])");
  return nullptr;
}

/// Number(value, gradient=(), hessian=None)
PyObject* construct(PyTypeObject* /*type*/, PyObject* arguments, PyObject* keywords) {
  static const char* names[] = {"value", "gradient", "hessian", nullptr};
  double value = 0;
  PyObject* gradient = nullptr;
  PyObject* hessian = nullptr;
  if (PyArg_ParseTupleAndKeywords(arguments, keywords, "d|OO:Number", const_cast<char**>(names), &value,
                                  &gradient, &hessian) == 0) {
    return nullptr;
  }
  try {
    const auto slopes =
        gradient == nullptr ? std::vector<double>() : py::handle(gradient).cast<std::vector<double>>();
    const auto size = static_cast<int>(slopes.size());
    NumberObject* const result = new_number({size, size}, value);
    py::object owner = py::reinterpret_steal<py::object>(as_object(result));
    std::copy(slopes.begin(), slopes.end(), result->data + 1);
    if (hessian != nullptr && hessian != Py_None) {
      const auto rows = py::handle(hessian).cast<py::array_t<double, py::array::forcecast>>();
      if (rows.ndim() != 2 || rows.shape(0) != size || rows.shape(1) != size) {
        throw py::value_error(
            "the Hessian has to be a matrix with as many rows and columns as there are slopes");
      }
      const auto values = rows.unchecked<2>();
      for (int i = 0; i < size; ++i) {
        for (int j = 0; j <= i; ++j)
          result->data[result->shape.place(i, j)] = 0.5 * (values(i, j) + values(j, i));
      }
    }
    return owner.release().ptr();
  } catch (py::error_already_set& error) {
    error.restore();
  } catch (const py::value_error& error) {
    PyErr_SetString(PyExc_ValueError, error.what());
  } catch (const py::cast_error&) {
    PyErr_SetString(PyExc_TypeError,
                    "Number(value, gradient, hessian): a number, a list and a matrix of numbers");
  }
  return nullptr;
}

PyObject* value_of(PyObject* self, void*) { return PyFloat_FromDouble(as_number(self)->data[0]); }

PyObject* gradient_of(PyObject* self, void*) {
  const NumberView x = as_number(self)->view();
  return py::array_t<double>(x.shape.slopes, x.data + 1).release().ptr();
}

PyObject* hessian_of(PyObject* self, void*) {
  const NumberView x = as_number(self)->view();
  py::array_t<double> result({x.shape.second, x.shape.second});
  auto values = result.mutable_unchecked<2>();
  for (int i = 0; i < x.shape.second; ++i) {
    for (int j = 0; j < x.shape.second; ++j) values(i, j) = x.second(i, j);
  }
  return result.release().ptr();
}

constexpr const char* number_doc = R"(Number(value, gradient=(), hessian=None)
--

A number with its first and second derivatives: what the functions of a System are called with.

It has + - * / ** % //, abs, comparisons, which compare values, and the functions of numpy: np.sin(q[2]), np.sqrt,
np.arctan2, also of arrays of Numbers (where np.arctan2, np.hypot and the like need Numbers first). abs, maximum and
minimum take the derivative of the branch they return; floor, ceil and rint are constant between their jumps.

gradient  first derivatives, (k,)
hessian   second derivatives among the first m directions, (m, m))";

PyGetSetDef attributes[] = {{"value", value_of, nullptr, "Without derivatives: a float.", nullptr},
                            {"gradient", gradient_of, nullptr, "First derivatives, (k,).", nullptr},
                            {"hessian", hessian_of, nullptr, "Second derivatives, (m, m), m <= k.", nullptr},
                            {nullptr, nullptr, nullptr, nullptr, nullptr}};

template <class Function>
PyType_Slot slot(int id, Function* function) {
  return {id, reinterpret_cast<void*>(function)};
}

PyObject* make_type() {
  std::vector<PyType_Slot> slots = {slot(Py_tp_dealloc, deallocate),
                                    slot(Py_tp_repr, represent),
                                    slot(Py_tp_richcompare, compare),
                                    slot(Py_tp_new, construct),
                                    slot(Py_tp_getattro, number_attribute),
                                    slot(Py_nb_bool, is_not_zero),
                                    slot(Py_nb_float, refuse_float),
                                    {Py_tp_doc, const_cast<char*>(number_doc)},
                                    {Py_tp_getset, attributes},
                                    {Py_tp_methods, number_methods()}};
  for (const PyType_Slot& operation : number_operations()) slots.push_back(operation);
  slots.push_back({0, nullptr});
  PyType_Spec spec = {"hybrid_sphere.Number", static_cast<int>(offsetof(NumberObject, data)), sizeof(double),
                      Py_TPFLAGS_DEFAULT, slots.data()};
  return PyType_FromSpec(&spec);
}

}  // namespace

NumberObject* new_number(const NumberShape& shape) {
  NumberObject* const result =
      PyObject_NewVar(NumberObject, number_type, static_cast<Py_ssize_t>(shape.size()));
  if (result == nullptr) throw py::error_already_set();
  result->shape = shape;
  return result;
}

NumberObject* new_number(const NumberShape& shape, double value) {
  NumberObject* const result = new_number(shape);
  std::memset(result->data, 0, shape.size() * sizeof(double));
  result->data[0] = value;
  return result;
}

bool read(PyObject* object, Operand& operand) {
  if (Py_TYPE(object) == number_type) {
    operand.number = as_number(object);
    operand.value = operand.number->data[0];
    return true;
  }
  if (PyFloat_Check(object)) {
    operand.value = PyFloat_AS_DOUBLE(object);
    return true;
  }
  const auto is_of = [object](PyTypeObject* type) { return PyObject_TypeCheck(object, type) != 0; };
  if (!PyLong_Check(object) && std::none_of(numpy_numbers.begin(), numpy_numbers.end(), is_of)) return false;
  operand.value = PyFloat_AsDouble(object);
  if (PyErr_Occurred() == nullptr) return true;
  forget_wrong_kind();
  return false;
}

void declare_number(py::module_& module) {
  const py::module_ numpy = py::module_::import("numpy");
  const char* const names[] = {"floating", "integer", "bool_"};
  std::transform(std::begin(names), std::end(names), numpy_numbers.begin(), [&](const char* name) {
    return reinterpret_cast<PyTypeObject*>(numpy.attr(name).cast<py::object>().release().ptr());
  });
  const py::object type = py::reinterpret_steal<py::object>(make_type());
  if (!type) throw py::error_already_set();
  find_ufuncs();
  number_type = reinterpret_cast<PyTypeObject*>(type.ptr());
  module.attr("Number") = type;
  type.inc_ref();
}

}  // namespace hybrid_sphere::python
