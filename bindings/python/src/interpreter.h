// The lock of the interpreter (GIL), and the end of the program while threads compute.
#pragma once
#include <pybind11/pybind11.h>

namespace aspic::python {

namespace py = pybind11;

struct Departure;  // of the threads that compute when the program ends

// Releases the GIL as long as this lives. The interpreter waits for these threads when the program ends.
class ReleasedGil {
 public:
  ReleasedGil();  // requires the GIL. Raises SystemExit in a daemon thread when the program ends
  ~ReleasedGil();
  ReleasedGil(const ReleasedGil&) = delete;
  ReleasedGil& operator=(const ReleasedGil&) = delete;

 private:
  Departure& departure_;
  PyThreadState* thread_;
};

// Holds the GIL as long as this lives.
class HeldGil {
 public:
  HeldGil();
  ~HeldGil();
  HeldGil(const HeldGil&) = delete;
  HeldGil& operator=(const HeldGil&) = delete;

 private:
  Departure& departure_;
  PyGILState_STATE state_;
};

// Returns whether the program ends, so that computations of this thread stop.
bool is_leaving();

// Call once, with the GIL.
void watch_for_the_end();

// Makes classes raise TypeError where they would abort: for uses of objects whose __init__ was not called, and for
// pickles of objects without a state. Call after all classes are bound.
void guard_classes(const py::module_& m);

}  // namespace aspic::python
