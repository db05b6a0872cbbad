#include "python/numbers_of.hpp"

#include "hybrid_sphere/scene/scene_error.hpp"

namespace hybrid_sphere::python {

namespace py = pybind11;

namespace {

/// What most callers give. An array of a subclass, such as a masked one, has numpy.ndarray as its base.
bool is_plain_array_of_doubles(const py::handle& object) {
  return py::isinstance<py::array_t<double>>(object) && Py_TYPE(object.ptr())->tp_base == &PyBaseObject_Type;
}

}  // namespace

Numbers numbers_of(const py::handle& object, const std::string& name) {
  if (is_plain_array_of_doubles(object)) return py::reinterpret_borrow<Numbers>(object);
  const auto refuse = [&name](const std::string& what) {
    throw scene::SceneError(name, what, "real numbers");
  };
  const py::module_ numpy = py::module_::import("numpy");
  if (py::isinstance(object, numpy.attr("ma").attr("MaskedArray"))) refuse("a masked array");
  try {
    const py::object array = numpy.attr("asarray")(object);
    const char kind = array.attr("dtype").attr("kind").cast<char>();
    if (kind == 'c') refuse("an array of complex numbers");
    if (kind == 'O') return array.attr("astype")("f8").cast<Numbers>();
    if (kind == 'f' || kind == 'i' || kind == 'u') return array.cast<Numbers>();
  } catch (py::error_already_set& error) {
    error.restore();
    forget_wrong_kind();
  }
  refuse("no list of numbers");
  return {};
}

void forget_wrong_kind() {
  if (PyErr_Occurred() == nullptr) return;
  for (PyObject* const kind : {PyExc_TypeError, PyExc_ValueError, PyExc_OverflowError, PyExc_UnicodeError}) {
    if (PyErr_ExceptionMatches(kind) == 0) continue;
    PyErr_Clear();
    return;
  }
  throw py::error_already_set();
}

}  // namespace hybrid_sphere::python
