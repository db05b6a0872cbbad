#pragma once

/// Classes of pybind11 that declarations name: code that only computes does not read pybind11's headers.
namespace pybind11 {

class array;
class dtype;
class handle;

}  // namespace pybind11
