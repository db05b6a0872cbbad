#pragma once

#include <pybind11/numpy.h>

#include <cstddef>
#include <string>
#include <vector>

namespace hybrid_sphere::python {

/// The dtype of an array whose items also have their fields as attributes. To be called with the lock of the
/// interpreter.
/// @param offsets  [bytes]
/// @param size     of an item [bytes]
inline pybind11::dtype record_dtype(const pybind11::list& names, const pybind11::list& formats,
                                    const pybind11::list& offsets, std::size_t size) {
  namespace py = pybind11;
  const py::module_ numpy = py::module_::import("numpy");
  py::dict layout;
  layout["names"] = names;
  layout["formats"] = formats;
  layout["offsets"] = offsets;
  layout["itemsize"] = size;
  const py::object plain = numpy.attr("dtype")(layout);
  return numpy.attr("dtype")(py::make_tuple(numpy.attr("record"), plain)).cast<py::dtype>();
}

/// An array to be filled: of bytes at first, as numpy would set items that have texts to 0, which takes as
/// long as to fill them.
inline pybind11::array unset_array(const pybind11::dtype& dtype, const std::vector<std::size_t>& shape) {
  namespace py = pybind11;
  const py::dtype bytes("V" + std::to_string(dtype.itemsize()));
  return py::array(bytes, shape).attr("view")(dtype);
}

}  // namespace hybrid_sphere::python
