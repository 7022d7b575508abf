// Terms of V written in Python: a batch of elements whose values and derivatives numpy computes at once.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "callbacks.h"
#include "energy/energy.h"
#include "mesh/numbering.h"

namespace aspic::python {

// `energy` has `elements` (E, k), vertices of the scene, and the methods value(x), gradient(x) and hessian(x) of
// x (E, k, 3), which return arrays of shape (E,), (E, k, 3) and (E, k, 3, k, 3). Requires the GIL. Throws InvalidInput.
std::unique_ptr<Energy> make_python_energy(const py::object& energy, const Renumbering& vertex, int vertex_count,
                                           std::shared_ptr<Callbacks> callbacks);

}  // namespace aspic::python
