// The parts of the module, one function per layer of the library.
#pragma once
#include <pybind11/pybind11.h>

namespace aspic::python {

namespace py = pybind11;

void bind_mesh(py::module_& m);
void bind_linalg(py::module_& m);
void bind_optimize(py::module_& m);
void bind_simulation(py::module_& m);
void bind_scene(py::module_& m);
void bind_material(py::module_& m);
void bind_compare(py::module_& m);
void bind_results(py::module_& m);
void bind_fit(py::module_& m);
void bind_verification(py::module_& m);

}  // namespace aspic::python
