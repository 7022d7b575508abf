// The module _aspic. The package `aspic` is its interface; nothing else should import it.
#include <pybind11/pybind11.h>

#include "base/error.h"
#include "bindings.h"
#include "interpreter.h"

PYBIND11_MODULE(_aspic, m) {
  using namespace aspic::python;
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
