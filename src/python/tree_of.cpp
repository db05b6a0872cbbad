#include "python/tree_of.hpp"

#include <pybind11/numpy.h>

#include <cstddef>

#include "python/numbers_of.hpp"
#include "scene/printable.hpp"
#include "scene/yaml.hpp"

namespace hybrid_sphere::python {
namespace {

namespace py = pybind11;
using scene::SceneError;
using scene::Tree;

bool is_a(const py::handle& object, const char* module, const char* type) {
  return py::isinstance(object, py::module_::import(module).attr(type));
}

std::string type_of(const py::handle& object) {
  return "an object of type " +
         scene::printable(py::str(py::type::of(object).attr("__name__")).cast<std::string>());
}

class Reader {
 public:
  Tree read(const py::handle& object, const std::string& path, std::size_t depth) {
    const std::string where = path.empty() ? "scene" : path;
    if (++values_ > limits_.values || depth > limits_.depth) {
      throw SceneError(where, "a value",
                       "up to " + std::to_string(limits_.depth) + " nested dicts and lists, and " +
                           std::to_string(limits_.values) + " values in all");
    }
    if (object.is_none()) return {};
    if (py::isinstance<py::bool_>(object) || is_a(object, "numpy", "bool_")) return {object.cast<bool>()};
    if (py::isinstance<py::str>(object)) return {text(object, where)};
    if (py::isinstance<py::float_>(object) || py::isinstance<py::int_>(object))
      return {number(object, where)};
    if (is_a(object, "os", "PathLike"))
      return {text(py::module_::import("os").attr("fspath")(object), where)};
    if (py::isinstance<py::dict>(object)) return map(object, path, depth);
    if (py::isinstance<py::list>(object) || py::isinstance<py::tuple>(object))
      return list(object, path, depth);
    if (is_a(object, "numpy", "generic")) return scalar(object, where);
    if (py::isinstance<py::array>(object)) return read(object.attr("tolist")(), path, depth + 1);
    if (is_a(object, "collections.abc", "Mapping"))
      return map(py::dict(object.cast<py::object>()), path, depth);
    throw SceneError(where, type_of(object), "a number, a text, a boolean, a list or a dict");
  }

 private:
  static std::string text(const py::handle& object, const std::string& where) {
    Py_ssize_t size = 0;
    const char* const utf8 =
        py::isinstance<py::str>(object) ? PyUnicode_AsUTF8AndSize(object.ptr(), &size) : nullptr;
    if (utf8 != nullptr) return {utf8, static_cast<std::size_t>(size)};
    forget_wrong_kind();
    throw SceneError(where, "a text that is not UTF-8", "UTF-8");
  }

  /// Of numpy: a number, a boolean or a text.
  Tree scalar(const py::handle& object, const std::string& where) {
    const char kind = object.attr("dtype").attr("kind").cast<char>();
    if (kind == 'f' || kind == 'i' || kind == 'u') return {number(object, where)};
    if (kind == 'U') return {text(py::str(object), where)};
    throw SceneError(where, type_of(object), "a number, a text, a boolean, a list or a dict");
  }

  static double number(const py::handle& object, const std::string& where) {
    const double value = PyFloat_AsDouble(object.ptr());
    if (!PyErr_Occurred()) return value;
    if (PyErr_ExceptionMatches(PyExc_OverflowError) == 0) throw py::error_already_set();
    PyErr_Clear();
    throw SceneError(where, "a number beyond the range of binary64", "numbers up to 1e+308");
  }

  /// A copy, as what is read may run code of the user's that changes it.
  Tree map(const py::handle& object, const std::string& path, std::size_t depth) {
    const py::dict copy = py::reinterpret_steal<py::dict>(PyDict_Copy(object.ptr()));
    if (!copy) throw py::error_already_set();
    Tree::Map entries;
    for (const auto& [key, value] : copy) {
      if (!py::isinstance<py::str>(key)) {
        throw SceneError(path.empty() ? "scene" : path, "a key that is " + type_of(key), "texts for keys");
      }
      const std::string name = text(key, path.empty() ? "scene" : path);
      const std::string shown = scene::printable(name);
      entries.emplace_back(name, read(value, path.empty() ? shown : path + "." + shown, depth + 1));
    }
    return {entries};
  }

  Tree list(const py::handle& object, const std::string& path, std::size_t depth) {
    const py::tuple copy(py::reinterpret_borrow<py::object>(object));
    Tree::List items;
    for (const py::handle item : copy) {
      items.push_back(read(item, path + "[" + std::to_string(items.size()) + "]", depth + 1));
    }
    return {items};
  }

  scene::YamlLimits limits_;
  std::size_t values_ = 0;
};

}  // namespace

Tree tree_of(const py::handle& object, const std::string& path) { return Reader().read(object, path, 0); }

}  // namespace hybrid_sphere::python
