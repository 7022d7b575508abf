// Documents from dicts: scenes written in Python pass the same checks as TOML files.
#pragma once
#include <pybind11/pybind11.h>

#include <string>

#include "scene/value.h"

namespace aspic::python {

namespace py = pybind11;

// Converts numbers, strings, booleans, lists, arrays and dicts; None entries of a dict are left out. Messages about a
// value name its place as `where` and the keys that lead to it: "scene.body.jelly.pin.top". Throws InvalidInput.
Value to_value(const py::handle& value, const std::string& where);

}  // namespace aspic::python
