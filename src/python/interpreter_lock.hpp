#pragma once

#include <pybind11/pybind11.h>

#include <chrono>
#include <thread>

namespace hybrid_sphere::python {

/// Whether this thread is the one that ends the interpreter: what is destroyed then may still compute.
inline thread_local bool ends_interpreter = false;

/// While the interpreter ends, any other thread that asks for its lock would be unwound, which C++ does not
/// survive: it waits for the end of the process instead.
inline void wait_if_interpreter_ends() {
  while (!ends_interpreter && _Py_IsFinalizing() != 0) std::this_thread::sleep_for(std::chrono::seconds(1));
}

/// While one lives, the lock of the interpreter is released.
class WithoutLock {
 public:
  WithoutLock() {
    ends_interpreter = _Py_IsFinalizing() != 0;
    thread_ = PyEval_SaveThread();
  }
  ~WithoutLock() {
    wait_if_interpreter_ends();
    PyEval_RestoreThread(thread_);
  }
  WithoutLock(const WithoutLock&) = delete;
  WithoutLock& operator=(const WithoutLock&) = delete;

 private:
  PyThreadState* thread_;
};

}  // namespace hybrid_sphere::python
