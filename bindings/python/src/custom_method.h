// Search directions and line searches written in Python.
#pragma once
#include <functional>
#include <memory>

#include "function.h"
#include "optimize/minimize.h"

namespace aspic::python {

// The minimization that a custom method serves.
struct MethodContext {
  Layout layout;
  std::shared_ptr<Callbacks> callbacks;
  std::function<void(std::span<double>)> set_pins_zero = {};  // of a direction
};

// compute(E, x, g) returns d. Requires the GIL. Throws InvalidInput unless it is callable.
std::unique_ptr<SearchDirection> make_python_direction(const py::object& compute, MethodContext context);
// search(E, x, d, g) returns alpha. Returns an empty function for None.
std::function<double(const SearchLine&)> make_python_line_search(const py::object& search, MethodContext context);

}  // namespace aspic::python
