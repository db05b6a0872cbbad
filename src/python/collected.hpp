#pragma once

#include <pybind11/pybind11.h>

#include <utility>

namespace hybrid_sphere::python {

/// The functions written in Python that a model calls, a list. Whatever Python object has such a model has
/// this, too, and shows it to the garbage collector: a function often refers to the object that has the
/// system.
class KeptFunctions {
 public:
  /// @return  the function, which lives as long as this
  pybind11::handle keep(const pybind11::object& function) {
    if (!list_) list_ = pybind11::list();
    pybind11::reinterpret_borrow<pybind11::list>(list_).append(function);
    return function;
  }
  pybind11::handle list() const { return list_; }
  /// What has a model that calls them must not be used any more.
  pybind11::object let_go() { return std::exchange(list_, pybind11::object()); }

 private:
  pybind11::object list_;  // null: none
};

/// The object of C++ in an object of Python; null while it is being made.
template <class Owner>
Owner* owner_of(PyObject* self) {
  auto part = reinterpret_cast<pybind11::detail::instance*>(self)->get_value_and_holder();
  return part.holder_constructed() ? part.template value_ptr<Owner>() : nullptr;
}

/// What a class needs whose objects have KeptFunctions: `functions()`, and `let_go()`, which makes an object
/// useless and returns them.
template <class Owner>
pybind11::custom_type_setup collected() {
  return pybind11::custom_type_setup([](PyHeapTypeObject* heap_type) {
    PyTypeObject& type = heap_type->ht_type;
    type.tp_flags |= Py_TPFLAGS_HAVE_GC;
    type.tp_traverse = [](PyObject* self, visitproc visit, void* arg) {
      Py_VISIT(Py_TYPE(self));
      const Owner* const owner = owner_of<Owner>(self);
      if (owner != nullptr) Py_VISIT(owner->functions().list().ptr());
      return 0;
    };
    type.tp_clear = [](PyObject* self) {
      Owner* const owner = owner_of<Owner>(self);
      if (owner != nullptr) owner->let_go();
      return 0;
    };
  });
}

}  // namespace hybrid_sphere::python
