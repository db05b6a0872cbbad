#include "python/errors.hpp"

#include <exception>
#include <string>

#include "hybrid_sphere/scene/scene_error.hpp"

namespace hybrid_sphere::python {
namespace {

namespace py = pybind11;

py::object error_type(const char* name) { return py::module_::import("hybrid_sphere._errors").attr(name); }

void set_error(const py::object& error) { PyErr_SetObject(py::type::of(error).ptr(), error.ptr()); }

void translate(std::exception_ptr thrown) {
  try {
    if (thrown) std::rethrow_exception(thrown);
  } catch (const scene::SceneError& error) {
    set_error(error_type("SceneError")(error.what(), error.path(), error.value(), error.allowed()));
  } catch (const HaltedError& error) {
    if (error.stop() == Stop::out_of_memory) {
      PyErr_SetString(PyExc_MemoryError, error.what());
    } else {
      set_error(halted(error, py::none()));
    }
  }
}

}  // namespace

void register_exceptions() { py::register_exception_translator(translate); }

py::object halted(const HaltedError& error, const py::object& states) {
  return error_type("Halted")(error.what(), to_string(error.stop()), error.time(), states);
}

}  // namespace hybrid_sphere::python
