// Scenes, materials and their names.
#include "scene/scene.h"

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <climits>

#include "base/error.h"
#include "base/parallel.h"
#include "bindings.h"
#include "material/registry.h"
#include "python_energy.h"
#include "simulation.h"

namespace aspic::python {
namespace {

py::list described_materials() {
  py::list list;
  for (const MaterialInfo& info : materials()) {
    py::dict entry, extra;
    for (const ExtraParameter& e : info.extra)
      extra[py::str(e.name)] = e.meaning + (e.unit.empty() ? "" : " [" + e.unit + "]");
    entry["name"] = info.name;
    entry["formula"] = info.formula;
    entry["remarks"] = info.remarks;
    entry["parameters"] = extra;
    list.append(entry);
  }
  return list;
}

}  // namespace

void bind_scene(py::module_& m) {
  py::class_<SceneSource, std::shared_ptr<SceneSource>>(m, "SceneSource")
      .def(py::init<std::filesystem::path, std::vector<std::string>, std::vector<py::object>>())
      .def(py::init<const py::dict&, std::string, std::vector<py::object>>())
      .def("check_keys", &SceneSource::check_keys)
      .def("check_model", &SceneSource::check_model);
  m.def("check_energy", [](const py::object& energy) {
    make_python_energy(energy, Renumbering(), INT_MAX, std::make_shared<Callbacks>());
  });
  m.def("materials", &described_materials);
  m.def("integrator_names", &integrator_names);
  m.def("thread_count", &thread_count);
  m.def("set_thread_count", [](int count) {
    if (count < 1 || count > 1024) throw InvalidInput("threads: must be from 1 to 1024");
    set_thread_count(count);
  });
}

}  // namespace aspic::python
