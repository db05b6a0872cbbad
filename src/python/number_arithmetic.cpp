#include "python/number_arithmetic.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>

#include "python/number_object.hpp"
#include "python/number_ufunc.hpp"

namespace hybrid_sphere::python {
namespace {

namespace py = pybind11;
using mechanics::Partials;

PyObject* result_of(const Partials& f, const Operand& x) {
  if (x.is_constant()) return as_object(new_number({}, f.value));
  NumberObject* const result = new_number(x.number->shape);
  compose(f, x.number->view(), result->data);
  return as_object(result);
}

PyObject* result_of(const Partials& f, const Operand& x, const Operand& y) {
  if (y.is_constant()) return result_of(f, x);
  if (x.is_constant()) return result_of(Partials{f.value, f.y, 0, f.yy, 0, 0}, y);
  if (!(x.number->shape == y.number->shape)) {
    PyErr_SetString(
        PyExc_ValueError,
        "these Numbers have other derivatives each: a function must not keep them from call to call");
    return nullptr;
  }
  NumberObject* const result = new_number(x.number->shape);
  compose(f, x.number->view(), y.number->view(), result->data);
  return as_object(result);
}

/// No C++ exception may leave a function that Python calls.
template <class Function>
PyObject* guarded(Function function) {
  try {
    return function();
  } catch (py::error_already_set& error) {
    error.restore();
    return nullptr;
  }
}

// Operators.

using BinaryRule = Partials (*)(double x, double y);

Partials sum(double x, double y) { return {x + y, 1, 1, 0, 0, 0}; }
Partials difference(double x, double y) { return {x - y, 1, -1, 0, 0, 0}; }
Partials product(double x, double y) { return {x * y, y, x, 0, 1, 0}; }
Partials quotient(double x, double y) {
  const double inverse = 1 / y;
  const double ratio = x / y;
  return {ratio, inverse, -ratio * inverse, 0, -inverse * inverse, 2 * ratio * inverse * inverse};
}
/// The sign of y, as Python has it; the quotient is taken for a constant.
Partials rest(double x, double y) {
  const double whole = std::floor(x / y);
  double value = std::fmod(x, y);
  if (value != 0 && (value < 0) != (y < 0)) value += y;
  return {value, 1, -whole, 0, 0, 0};
}
Partials whole_quotient(double x, double y) { return {std::floor(x / y), 0, 0, 0, 0, 0}; }

template <BinaryRule rule>
PyObject* binary(PyObject* a, PyObject* b) {
  Operand x, y;
  if (!read(a, x) || !read(b, y)) Py_RETURN_NOTIMPLEMENTED;
  return guarded([&] { return result_of(rule(x.value, y.value), x, y); });
}

PyObject* raise(PyObject* a, PyObject* b, PyObject* modulus) {
  Operand x, y;
  if (modulus != Py_None || !read(a, x) || !read(b, y)) Py_RETURN_NOTIMPLEMENTED;
  return guarded([&] {
    if (y.is_constant()) return result_of(power(x.value, y.value), x);
    if (x.is_constant()) return result_of(power_of_base(x.value, y.value), y);
    return result_of(power_of_both(x.value, y.value), x, y);
  });
}

template <int sign>
PyObject* signed_one(PyObject* self) {
  Operand x;
  read(self, x);
  return guarded([&] { return result_of(Partials{sign * x.value, sign, 0, 0, 0, 0}, x); });
}

PyObject* absolute(PyObject* self) {
  Operand x;
  read(self, x);
  return x.value < 0 ? signed_one<-1>(self) : signed_one<1>(self);
}

// Functions of one number.

struct UnaryFunction {
  const char* name;
  Taylor (*rule)(const Taylor& x);
};

constexpr double degree = 0.017453292519943295;

Taylor linear(const Taylor& x, double factor) { return chain(x, factor * x.value, factor, 0); }

constexpr UnaryFunction unary_functions[] = {
    {"sqrt", [](const Taylor& x) { return sqrt(x); }},
    {"cbrt", [](const Taylor& x) { return cbrt(x); }},
    {"sin", [](const Taylor& x) { return sin(x); }},
    {"cos", [](const Taylor& x) { return cos(x); }},
    {"tan", [](const Taylor& x) { return tan(x); }},
    {"arcsin", [](const Taylor& x) { return asin(x); }},
    {"arccos", [](const Taylor& x) { return acos(x); }},
    {"arctan", [](const Taylor& x) { return atan(x); }},
    {"sinh", [](const Taylor& x) { return sinh(x); }},
    {"cosh", [](const Taylor& x) { return cosh(x); }},
    {"tanh", [](const Taylor& x) { return tanh(x); }},
    {"arcsinh", [](const Taylor& x) { return asinh(x); }},
    {"arccosh", [](const Taylor& x) { return acosh(x); }},
    {"arctanh", [](const Taylor& x) { return atanh(x); }},
    {"exp", [](const Taylor& x) { return exp(x); }},
    {"exp2", [](const Taylor& x) { return exp2(x); }},
    {"expm1", [](const Taylor& x) { return expm1(x); }},
    {"log", [](const Taylor& x) { return log(x); }},
    {"log2", [](const Taylor& x) { return log2(x); }},
    {"log10", [](const Taylor& x) { return log10(x); }},
    {"log1p", [](const Taylor& x) { return log1p(x); }},
    {"erf", [](const Taylor& x) { return erf(x); }},
    {"erfc", [](const Taylor& x) { return erfc(x); }},
    {"fabs", [](const Taylor& x) { return linear(x, x.value < 0 ? -1 : 1); }},
    {"radians", [](const Taylor& x) { return linear(x, degree); }},
    {"deg2rad", [](const Taylor& x) { return linear(x, degree); }},
    {"degrees", [](const Taylor& x) { return linear(x, 1 / degree); }},
    {"rad2deg", [](const Taylor& x) { return linear(x, 1 / degree); }},
    {"conjugate", [](const Taylor& x) { return linear(x, 1); }},
    {"rint", [](const Taylor& x) { return chain(x, std::rint(x.value), 0, 0); }},
    {"__floor__", [](const Taylor& x) { return chain(x, std::floor(x.value), 0, 0); }},
    {"__ceil__", [](const Taylor& x) { return chain(x, std::ceil(x.value), 0, 0); }},
    {"__trunc__", [](const Taylor& x) { return chain(x, std::trunc(x.value), 0, 0); }}};

template <std::size_t i>
PyObject* unary(PyObject* self, PyObject* /*none*/) {
  Operand x;
  read(self, x);
  return guarded([&] { return result_of(unary_functions[i].rule(Taylor(x.value)).f, x); });
}

// Functions of two numbers.

struct BinaryFunction {
  const char* name;
  BinaryRule rule;
};

Partials least(double x, double y) { return y < x ? Partials{y, 0, 1, 0, 0, 0} : Partials{x, 1, 0, 0, 0, 0}; }
Partials greatest(double x, double y) {
  return x < y ? Partials{y, 0, 1, 0, 0, 0} : Partials{x, 1, 0, 0, 0, 0};
}

Partials arctan2(double y, double x) { return atan2(Taylor(y), Taylor(x)).f; }
Partials hypotenuse(double x, double y) { return hypot(Taylor(x), Taylor(y)).f; }
Partials c_rest(double x, double y) { return fmod(Taylor(x), Taylor(y)).f; }
Partials with_sign(double x, double y) {
  const double sign = std::signbit(x) == std::signbit(y) ? 1 : -1;
  return {sign * x, sign, 0, 0, 0, 0};
}

constexpr BinaryFunction binary_functions[] = {{"arctan2", arctan2}, {"hypot", hypotenuse},
                                               {"fmod", c_rest},     {"copysign", with_sign},
                                               {"fmin", least},      {"fmax", greatest}};

template <std::size_t i>
PyObject* binary_method(PyObject* self, PyObject* other) {
  Operand x, y;
  read(self, x);
  if (!read(other, y)) {
    PyErr_Format(PyExc_TypeError, "%s: the second argument has to be a number, not %R",
                 binary_functions[i].name, reinterpret_cast<PyObject*>(Py_TYPE(other)));
    return nullptr;
  }
  return guarded([&] { return result_of(binary_functions[i].rule(x.value, y.value), x, y); });
}

PyObject* raised(PyObject* a, PyObject* b) { return raise(a, b, Py_None); }

template <PyObject* (*function)(PyObject*)>
PyObject* of_one(PyObject* x, PyObject* /*none*/) {
  return function(x);
}

template <std::size_t... i>
void append_functions(std::index_sequence<i...> /*of one*/, std::vector<NumberFunction>& all) {
  for (const NumberFunction& function : {NumberFunction{unary_functions[i].name, unary<i>, nullptr}...}) {
    const std::string_view name = function.ufunc;
    // numpy has no erf, and calls floor what Python calls __floor__.
    if (name[0] != '_' && name != "erf" && name != "erfc") all.push_back(function);
  }
}

template <std::size_t... i, std::size_t... k>
std::vector<PyMethodDef> make_methods(std::index_sequence<i...> /*of one*/,
                                      std::index_sequence<k...> /*of two*/) {
  return {{unary_functions[i].name, unary<i>, METH_NOARGS, nullptr}...,
          {binary_functions[k].name, binary_method<k>, METH_O, nullptr}...,
          {"__array_ufunc__", reinterpret_cast<PyCFunction>(reinterpret_cast<void (*)()>(number_ufunc)),
           METH_VARARGS | METH_KEYWORDS, nullptr},
          {nullptr, nullptr, 0, nullptr}};
}

template <class Function>
PyType_Slot number_slot(int id, Function* function) {
  return {id, reinterpret_cast<void*>(function)};
}

}  // namespace

std::vector<PyType_Slot> number_operations() {
  return {number_slot(Py_nb_add, binary<sum>),
          number_slot(Py_nb_subtract, binary<difference>),
          number_slot(Py_nb_multiply, binary<product>),
          number_slot(Py_nb_true_divide, binary<quotient>),
          number_slot(Py_nb_remainder, binary<rest>),
          number_slot(Py_nb_floor_divide, binary<whole_quotient>),
          number_slot(Py_nb_power, raise),
          number_slot(Py_nb_negative, signed_one<-1>),
          number_slot(Py_nb_positive, signed_one<1>),
          number_slot(Py_nb_absolute, absolute)};
}

std::vector<NumberFunction> number_functions() {
  std::vector<NumberFunction> all = {{"add", nullptr, binary<sum>},
                                     {"subtract", nullptr, binary<difference>},
                                     {"multiply", nullptr, binary<product>},
                                     {"true_divide", nullptr, binary<quotient>},
                                     {"remainder", nullptr, binary<rest>},
                                     {"floor_divide", nullptr, binary<whole_quotient>},
                                     {"power", nullptr, raised},
                                     {"arctan2", nullptr, binary<arctan2>},
                                     {"hypot", nullptr, binary<hypotenuse>},
                                     {"fmod", nullptr, binary<c_rest>},
                                     {"copysign", nullptr, binary<with_sign>},
                                     {"fmin", nullptr, binary<least>},
                                     {"fmax", nullptr, binary<greatest>},
                                     {"minimum", nullptr, binary<least>},
                                     {"maximum", nullptr, binary<greatest>},
                                     {"negative", of_one<signed_one<-1>>, nullptr},
                                     {"positive", of_one<signed_one<1>>, nullptr},
                                     {"absolute", of_one<absolute>, nullptr}};
  append_functions(std::make_index_sequence<std::size(unary_functions)>(), all);
  return all;
}

PyMethodDef* number_methods() {
  static std::vector<PyMethodDef> methods =
      make_methods(std::make_index_sequence<std::size(unary_functions)>(),
                   std::make_index_sequence<std::size(binary_functions)>());
  return methods.data();
}

}  // namespace hybrid_sphere::python
