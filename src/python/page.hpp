#pragma once

#include <pybind11/pybind11.h>

namespace hybrid_sphere::python {

/// hybrid_sphere.write_html
void declare_page(pybind11::module_& module);

}  // namespace hybrid_sphere::python
