// The module _aspic. The package `aspic` is its interface; nothing else should import it.
#include <pybind11/pybind11.h>

#include "base/error.h"
#include "bindings.h"
#include "interpreter.h"

namespace aspic::python {
namespace {

// pybind11 before 2.12 reads arrays of NumPy 2 wrongly.
void require_numpy() {
#if PYBIND11_VERSION_HEX < 0x020C0000
  const auto version = py::module_::import("numpy").attr("__version__").cast<std::string>();
  if (!version.starts_with("1."))
    throw py::import_error("NumPy " + version + " is too new for this build of aspic, which was made with pybind11 " +
                           std::to_string(PYBIND11_VERSION_MAJOR) + "." + std::to_string(PYBIND11_VERSION_MINOR) +
                           "; install NumPy 1 (pip install 'numpy<2'), or build with pybind11 2.12 or newer");
#endif
}

}  // namespace
}  // namespace aspic::python

PYBIND11_MODULE(_aspic, m) {
  using namespace aspic::python;
  require_numpy();
  m.attr("__version__") = ASPIC_VERSION;
  py::register_exception<aspic::InvalidInput>(m, "InvalidInput", PyExc_ValueError);
  bind_mesh(m);
  bind_linalg(m);
  bind_optimize(m);
  bind_simulation(m);
  bind_scene(m);
  bind_material(m);
  bind_compare(m);
  bind_results(m);
#ifdef ASPIC_HAS_FIT
  bind_fit(m);
#endif
  bind_verification(m);
  guard_classes(m);
  watch_for_the_end();
}
