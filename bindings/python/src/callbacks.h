// Python code that the library calls, and the first exception that it raised.
#pragma once
#include <pybind11/pybind11.h>

#include <cxxabi.h>

#include <chrono>
#include <exception>
#include <utility>

#include "base/stop_token.h"
#include "interpreter.h"

namespace aspic::python {

namespace py = pybind11;

// A callback of this thread. Callbacks that call the library, whose callbacks call it again, need more stack than the
// frames that Python counts.
class Nested {
 public:
  static constexpr int kDeepest = 16;
  Nested() {
    if (depth() == kDeepest) {
      PyErr_SetString(PyExc_RecursionError, "functions called by aspic call aspic, more than 16 levels deep");
      throw py::error_already_set();
    }
    ++depth();
  }
  ~Nested() { --depth(); }
  Nested(const Nested&) = delete;
  Nested& operator=(const Nested&) = delete;

 private:
  static int& depth() {
    static thread_local int depth = 0;
    return depth;
  }
};

// The library is not prepared for exceptions inside its loops. Callbacks therefore keep the first one, compute nothing
// more, and stop the computation. The caller then calls rethrow().
class Callbacks {
 public:
  bool has_failed() const { return error_ != nullptr; }
  // Calls `body` with the GIL and keeps its exception. Returns whether there was none.
  template <class Body>
  bool call(const Body& body) {
    if (has_failed()) return false;
    const HeldGil lock;
    try {
      const Nested nested;
      body();
    } catch (const abi::__forced_unwind&) {  // the end of this thread
      throw;
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

  // Stops after an exception, stop(), the end of the program or a signal such as Ctrl-C, which it looks for 50 times
  // per second.
  StopToken token() {
    return StopToken([this] { return is_requested(); });
  }

 private:
  bool is_requested() {
    if (has_failed() || is_stopped_ || is_leaving()) return true;
    const auto now = std::chrono::steady_clock::now();
    if (now - last_check_ < std::chrono::milliseconds(20)) return false;
    last_check_ = now;
    call([] {
      if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    });
    return has_failed();
  }

  std::exception_ptr error_;
  bool is_stopped_ = false;
  std::chrono::steady_clock::time_point last_check_{};
};

}  // namespace aspic::python
