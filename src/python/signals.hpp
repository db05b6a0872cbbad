#pragma once

#include <pybind11/pybind11.h>

#include <chrono>
#include <exception>
#include <utility>

#include "python/interpreter_lock.hpp"

namespace hybrid_sphere::python {

/// Whether a long computation, which has released the lock of the interpreter, is to stop as Ctrl-C has been
/// pressed, or a signal's handler in Python throws.
class Signals {
 public:
  /// Looks every 20 ms: to take the lock may mean to wait for another thread.
  bool have_come() {
    const auto now = std::chrono::steady_clock::now();
    if (now - looked_ < std::chrono::milliseconds(20)) return false;
    looked_ = now;
    wait_if_interpreter_ends();
    const pybind11::gil_scoped_acquire lock;
    if (PyErr_CheckSignals() == 0) return false;
    thrown_ = std::make_exception_ptr(pybind11::error_already_set());
    return true;
  }

  /// Of the handler. To be called with the lock.
  [[noreturn]] void rethrow() { std::rethrow_exception(std::exchange(thrown_, nullptr)); }

 private:
  std::chrono::steady_clock::time_point looked_ = std::chrono::steady_clock::now();
  std::exception_ptr thrown_;
};

}  // namespace hybrid_sphere::python
