// Python code that the library calls, and the first exception that it raised.
#pragma once
#include <pybind11/pybind11.h>

#include <chrono>
#include <exception>

#include "base/stop_token.h"

namespace aspic::python {

namespace py = pybind11;

// The library is not prepared for exceptions inside its loops. Callbacks therefore keep the first one, compute nothing
// more, and stop the computation. The caller then calls rethrow().
class Callbacks {
 public:
  bool has_failed() const { return error_ != nullptr; }
  // Calls `body` with the GIL and keeps its exception. Returns whether there was none.
  template <class Body>
  bool call(const Body& body) {
    if (has_failed()) return false;
    const py::gil_scoped_acquire lock;
    try {
      body();
    } catch (...) {
      error_ = std::current_exception();
    }
    return !has_failed();
  }
  void stop() { is_stopped_ = true; }  // without an exception
  // Requires the GIL.
  void rethrow() {
    is_stopped_ = false;
    if (const std::exception_ptr error = std::exchange(error_, nullptr)) std::rethrow_exception(error);
  }

  // Stops after an exception, stop() or a signal such as Ctrl-C, which it looks for 50 times per second.
  StopToken token() {
    return StopToken([this] { return is_requested(); });
  }

 private:
  bool is_requested() {
    if (has_failed() || is_stopped_) return true;
    const auto now = std::chrono::steady_clock::now();
    if (now - last_look_ < std::chrono::milliseconds(20)) return false;
    last_look_ = now;
    call([] {
      if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    });
    return has_failed();
  }

  std::exception_ptr error_;
  bool is_stopped_ = false;
  std::chrono::steady_clock::time_point last_look_{};
};

}  // namespace aspic::python
