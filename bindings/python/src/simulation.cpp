#include "simulation.h"

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "base/error.h"
#include "base/hash.h"
#include "bindings.h"
#include "custom_method.h"
#include "dynamics/mesh_error_text.h"
#include "iteration.h"
#include "python_energy.h"
#include "results/explanation.h"
#include "scene/scene_builder.h"
#include "scene/scene_document.h"
#include "state.h"
#include "step_objective.h"
#include "to_table.h"

namespace aspic::python {

SceneSource::SceneSource(std::filesystem::path path, std::vector<std::string> overrides,
                         std::vector<py::object> energies)
    : path_(std::move(path)), overrides_(std::move(overrides)), energies_(std::move(energies)) {}

SceneSource::SceneSource(const py::dict& document, std::string name, std::vector<py::object> energies)
    : name_(std::move(name)), energies_(std::move(energies)) {
  document_ = std::move(to_value(document, name_).table());
  complete_scene_document(*document_, name_);
}

template <class Build>
auto SceneSource::build(const Build& build, const std::shared_ptr<Callbacks>& callbacks) const {
  SceneOptions options;
  options.overrides = overrides_;
  options.allow_outside = true;
  if (!energies_.empty())
    options.amend = [&](Model& model) {
      const HeldGil lock;
      for (const py::object& energy : energies_)
        model.loads.push_back(make_python_energy(energy, model.numbering.vertex, model.mesh.vertex_count(), callbacks));
    };
  const ReleasedGil free;
  return build(options);
}

Scene SceneSource::scene(const std::shared_ptr<Callbacks>& callbacks) const {
  try {
    return build(
        [&](const SceneOptions& options) {
          if (!document_) return load_scene(path_, options);
          return build_scene({*document_, name_, name_, {}, {}}, SceneFiles("", true), options);
        },
        callbacks);
  } catch (const InvalidInput&) {
    callbacks->rethrow();  // the reason of an energy that is not finite
    throw;
  }
}

SceneModel SceneSource::model(const std::shared_ptr<Callbacks>& callbacks) const {
  return build(
      [&](const SceneOptions& options) {
        if (!document_) return load_scene_model(path_, options);
        return build_scene_model({*document_, name_, name_, {}, {}}, SceneFiles("", true), options);
      },
      callbacks);
}

void SceneSource::check_keys() const {
  if (document_) return;  // the constructor has checked it
  SceneOptions options;
  options.overrides = overrides_;
  options.allow_outside = true;
  const ReleasedGil free;
  read_scene_input(path_, options);
}

bool SceneSource::check_model(double most_tets) const {
  const std::string too_many = "are checked before the simulation is made";
  SceneOptions options;
  options.allow_outside = true;
  options.limit = {most_tets, too_many, true};
  const ReleasedGil free;
  try {
    build_scene_model({*document_, name_, name_, {}, {}}, SceneFiles("", true), options);
  } catch (const InvalidInput& e) {
    if (std::string_view(e.what()).find(too_many) == std::string_view::npos) throw;
    return false;
  }
  return true;
}

LiveSimulation::LiveSimulation(std::shared_ptr<const SceneSource> source)
    : source_(std::move(source)),
      scene_(source_->scene(callbacks_)),
      solver_(scene_.simulation.options().solver),
      pins_(scene_.simulation.model().pins, scene_.simulation.state().q) {
  callbacks_->rethrow();
  // A recording of the scene as a file. The comment also changes its fingerprint, so that `aspic run --resume` refuses
  // it.
  if (source_->has_energies())
    scene_.resolved.insert(0, "# This file lacks the energies that were written in Python.\n");
}

Layout LiveSimulation::layout() const {
  const Model& model = scene_.simulation.model();
  return Layout::of_vertices(model.numbering.vertex, model.mesh.vertex_count());
}

Layout LiveSimulation::row_layout() const {
  const Model& model = scene_.simulation.model();
  return Layout::of_vertices(model.numbering.vertex, model.rows());
}

void LiveSimulation::check_idle() const {
  if (occupancy_.is_elsewhere())
    throw std::runtime_error("another thread uses this simulation; give each thread its own");
}

StepReport LiveSimulation::take_step(const IterationObserver& observe) {
  std::vector<Iteration> iterations;
  const IterationObserver observer = [&](const LiveIteration& iteration) {
    iterations.push_back(iteration);
    if (observe) observe(iteration);
  };
  const StepReport report = scene_.simulation.step(observer, callbacks_->token());
  if (recording_ && report.status != Status::interrupted && !callbacks_->has_failed()) {
    for (const Iteration& iteration : iterations) recording_->on_iteration(report.step, iteration);
    recording_->on_step(report, scene_.simulation);
  }
  return report;
}

void LiveSimulation::set_method(const py::object& direction, const py::object& line_search) {
  if (direction.is(direction_) && line_search.is(line_search_)) return;
  Simulation& simulation = scene_.simulation;
  const MethodContext context{row_layout(), callbacks_, [this](std::span<double> d) { pins_.set_zero(d); }};
  direction_ = line_search_ = py::object();  // unknown after an exception
  SolverOptions options = solver_;
  options.minimize.line_search.custom = make_python_line_search(line_search, context);
  simulation.set_solver(options);
  if (!line_search.is_none() && !simulation.integrator().is_implicit)
    throw InvalidInput("line_search: integrator = '" + simulation.options().integrator + "' does not minimize");
  if (!direction.is_none()) simulation.set_direction(make_python_direction(direction, context));
  direction_ = direction, line_search_ = line_search;
}

Report LiveSimulation::step(const py::object& observe, const py::object& direction, const py::object& line_search) {
  const Use use(occupancy_, "simulation");
  if (is_stepping_) throw std::runtime_error("step() was called inside a step of the same simulation");
  set_method(direction, line_search);
  Simulation& simulation = scene_.simulation;
  const IterationObserver observer = observer_of(observe, row_layout(), callbacks_);
  is_stepping_ = true;
  struct Idle {
    bool& is_stepping;
    ~Idle() { is_stepping = false; }
  } const at_end{is_stepping_};
  const Simulation::Snapshot before = simulation.snapshot();
  StepReport taken;
  {
    const ReleasedGil free;
    taken = take_step(observer);
    if (callbacks_->has_failed()) simulation.restore(before);
  }
  callbacks_->rethrow();
  Report report = named(taken, simulation);
  if (!is_success(report.status)) {
    const Explanation why = explain(simulation, taken);
    report.cause = why.cause, report.place = why.place, report.remedy = why.remedy;
  }
  return report;
}

void LiveSimulation::record(const std::filesystem::path& folder, bool is_compact, bool overwrite) {
  const Use use(occupancy_, "simulation");
  if (is_compact) {
    scene_.output.vtu = scene_.output.obj = scene_.output.ply = scene_.output.usd = false;
    scene_.output.pc2 = true;
    scene_.output.checkpoint_every = 1e9;
  }
  const ReleasedGil free;
  recording_.emplace(RunDirectory::create(folder, scene_, overwrite ? ExistingRun::overwrite : ExistingRun::refuse));
}

// Files are closed at the end of a run, so the recording continues as a resumed run, which has the same bits.
void LiveSimulation::flush() {
  const Use use(occupancy_, "simulation");
  if (is_stepping_) throw std::runtime_error("results are not available inside a step");
  if (!recording_) return;
  const ReleasedGil free;
  recording_->finish(scene_.simulation);
  const std::filesystem::path folder = recording_->path();
  recording_.reset();
  recording_.emplace(RunDirectory::resume(folder, scene_));
}

void LiveSimulation::restore(const Simulation::Snapshot& snapshot) {
  check_idle();
  if (is_stepping_) throw std::runtime_error("the state cannot be changed inside a step");
  recording_.reset();
  scene_.simulation.restore(snapshot);
}

namespace {

Array state_array(LiveSimulation& self, std::vector<double> State::*member) {
  return self.layout().out(self.simulation().state().*member);
}

Array reactions_of(LiveSimulation& self) { return self.layout().out(self.simulation().reactions()); }

py::dict fields_of(LiveSimulation& self) {
  const Simulation& simulation = self.simulation();
  const Renumbering& tet = simulation.model().numbering.tet;
  const TetFields fields = simulation.tet_fields();
  const py::ssize_t tets = simulation.model().mesh.element_count();
  py::dict result;
  result["energy_density"] = to_array(tet.to_user(fields.energy_density), {tets});
  result["det_F"] = to_array(tet.to_user(fields.det_F), {tets});
  result["cauchy"] = to_array(tet.to_user(fields.cauchy, 6), {tets, 6});
  result["von_mises"] = to_array(tet.to_user(fields.von_mises), {tets});
  for (const auto& [name, values] : simulation.model().tet_fields)
    result[py::str(name)] = to_array(tet.to_user(values), {tets});
  return result;
}

py::dict mesh_error_of(LiveSimulation& self) {
  const Simulation& simulation = self.simulation();
  const MeshErrorEstimate error = [&] {
    const py::gil_scoped_release release;
    return simulation.mesh_error();
  }();
  const Model& model = simulation.model();
  py::dict result;
  result["text"] = mesh_error_text(error, simulation);
  result["reliable"] = error.is_reliable;
  if (!error.reason.empty()) return result;
  py::dict stiffness, energy;
  for (size_t b = 0; b < error.bodies.size(); ++b) {
    stiffness[py::str(model.bodies[b].name)] = error.bodies[b].stiffness;
    energy[py::str(model.bodies[b].name)] = error.bodies[b].energy;
  }
  result["stiffness"] = stiffness;
  result["energy"] = energy;
  result["density"] = to_array(model.numbering.tet.to_user(error.density), {py::ssize_t{model.mesh.tet_count()}});
  result["direction"] = self.layout().out(error.correction);
  return result;
}

py::list bodies_of(LiveSimulation& self) {
  py::list list;
  for (const BodyRange& body : self.simulation().model().bodies) {
    py::dict entry;
    entry["name"] = body.name;
    entry["vertices"] = py::slice(body.first_vertex, body.first_vertex + body.vertex_count, 1);
    entry["tets"] = py::slice(body.first_tet, body.first_tet + body.tet_count, 1);
    entry["triangles"] = py::slice(body.first_triangle, body.first_triangle + body.triangle_count, 1);
    list.append(entry);
  }
  return list;
}

py::array_t<int> tets_of(LiveSimulation& self) {
  const Model& model = self.simulation().model();
  const TetMesh mesh = to_user(model.numbering, model.mesh);
  py::array_t<int> tets({static_cast<py::ssize_t>(mesh.tets.size()), py::ssize_t{4}});
  if (!mesh.tets.empty()) std::copy_n(mesh.tets.data()->data(), tets.size(), tets.mutable_data());
  return tets;
}

py::array_t<int> triangles_of(LiveSimulation& self) {
  const Model& model = self.simulation().model();
  const TetMesh mesh = to_user(model.numbering, model.mesh);
  py::array_t<int> triangles({static_cast<py::ssize_t>(mesh.sheet.size()), py::ssize_t{3}});
  if (!mesh.sheet.empty()) std::copy_n(mesh.sheet.data()->data(), triangles.size(), triangles.mutable_data());
  return triangles;
}

py::array pinned_of(LiveSimulation& self) {
  const Model& model = self.simulation().model();
  py::array_t<bool> pinned(model.mesh.vertex_count());
  std::fill_n(pinned.mutable_data(), pinned.size(), false);
  for (const Pin& pin : model.pins)
    for (const int v : pin.vertices)
      if (v < model.mesh.vertex_count()) pinned.mutable_data()[model.numbering.vertex.to_user(v)] = true;
  return pinned;
}

void bind_step_objective(py::module_& m) {
  py::class_<StepObjective, Function, std::shared_ptr<StepObjective>>(
      m, "StepObjective", "The incremental potential E(q) of a step of backward Euler, with a model of its own.")
      .def("begin_step", &StepObjective::begin_step, py::arg("q"), py::arg("v"), py::arg("h"),
           py::arg("time") = py::none(),
           "Starts a step from q [m] and v [m/s], (n, 3), of length h [s]. Returns q with moved pins, the first "
           "iterate. "
           "`time`: at the end of the step; by default the clock advances by h.")
      .def("begin_statics", &StepObjective::begin_statics, py::arg("q"), py::arg("time") = py::none(),
           "From now on E = V, at a time. Returns q with moved pins.")
      .def("update_lagged", &StepObjective::update_lagged, py::arg("q"),
           "Takes the normal forces of friction from q. Minimize again until nothing changes.")
      .def_property_readonly("is_lagged", &StepObjective::is_lagged, "Whether friction needs update_lagged().")
      .def_property_readonly("time", &StepObjective::time, "At the end of the step [s].");
}

}  // namespace

void bind_simulation(py::module_& m) {
  bind_report(m);
  bind_step_objective(m);
  bind_snapshot(m);
  py::class_<LiveSimulation, std::shared_ptr<LiveSimulation>>(m, "Simulation")
      .def(py::init([](std::shared_ptr<SceneSource> source) { return std::make_shared<LiveSimulation>(source); }),
           py::arg().none(false))
      .def("step", &LiveSimulation::step, py::arg("observe") = py::none(), py::arg("direction") = py::none(),
           py::arg("line_search") = py::none())
      .def_property_readonly("q", [](LiveSimulation& s) { return state_array(s, &State::q); })
      .def_property_readonly("v", [](LiveSimulation& s) { return state_array(s, &State::qdot); })
      .def("set_q", &set_positions)
      .def("set_v", &set_velocities)
      .def_property_readonly("rest",
                             [](LiveSimulation& s) {
                               const Model& model = s.simulation().model();
                               return to_array(to_user(model.numbering, model.mesh).rest);
                             })
      .def_property_readonly("tets", &tets_of)
      .def_property_readonly("triangles", &triangles_of)
      .def_property_readonly("pinned", &pinned_of)
      .def_property_readonly("mass",
                             [](LiveSimulation& s) {
                               const Model& model = s.simulation().model();
                               return to_array(model.numbering.vertex.to_user(model.mass->vertex_mass()),
                                               {model.mesh.vertex_count()});
                             })
      .def_property_readonly("bodies", &bodies_of)
      .def_property_readonly("time", [](LiveSimulation& s) { return s.simulation().state().time; })
      .def_property_readonly("h", [](LiveSimulation& s) { return s.simulation().options().h; })
      .def_property_readonly("steps_taken", [](LiveSimulation& s) { return s.simulation().steps_taken(); })
      .def_property_readonly("steps_of_run", [](LiveSimulation& s) { return s.scene().steps; })
      .def_property_readonly("name", [](LiveSimulation& s) { return s.scene().name; })
      .def_property_readonly("notes", [](LiveSimulation& s) { return s.scene().notes; })
      .def_property_readonly("warnings", [](LiveSimulation& s) { return s.scene().warnings; })
      .def_property_readonly("resolved", [](LiveSimulation& s) { return s.scene().resolved; })
      .def_property_readonly("solver", [](LiveSimulation& s) { return s.simulation().solver_description(); })
      .def_property_readonly("state_hash", [](LiveSimulation& s) { return hex_digits(s.simulation().state_hash()); })
      .def("fields", &fields_of)
      .def("reactions", &reactions_of)
      .def("mesh_error", &mesh_error_of)
      .def("snapshot", [](LiveSimulation& s) { return s.simulation().snapshot(); })
      .def("restore", &LiveSimulation::restore)
      .def("record", &LiveSimulation::record)
      .def("flush", &LiveSimulation::flush)
      .def("end_recording", &LiveSimulation::end_recording)
      .def_property_readonly("is_recording", &LiveSimulation::is_recording)
      .def("write_inputs",
           [](LiveSimulation& s, const std::filesystem::path& folder) { write_inputs(s.scene(), folder); })
      .def("objective", [](LiveSimulation& s) { return StepObjective::make(s.source(), s.simulation().state().time); });
}

}  // namespace aspic::python
