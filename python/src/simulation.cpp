#include "simulation.h"

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "base/error.h"
#include "base/hash.h"
#include "bindings.h"
#include "custom_method.h"
#include "dynamics/step_fields.h"
#include "iteration.h"
#include "python_energy.h"
#include "scene/explanation.h"
#include "scene/scene_builder.h"
#include "scene/scene_document.h"
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
      const py::gil_scoped_acquire lock;
      for (const py::object& energy : energies_)
        model.loads.push_back(make_python_energy(energy, model.numbering.vertex, model.mesh.vertex_count(), callbacks));
    };
  const py::gil_scoped_release free;
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
  const MethodContext context{layout(), callbacks_, [this](std::span<double> d) { pins_.set_zero(d); }};
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
  const IterationObserver observer = observer_of(observe, layout(), callbacks_);
  is_stepping_ = true;
  struct Idle {
    bool& is_stepping;
    ~Idle() { is_stepping = false; }
  } const at_end{is_stepping_};
  const Simulation::Snapshot before = simulation.snapshot();
  Report report;
  {
    const py::gil_scoped_release free;
    static_cast<StepReport&>(report) = take_step(observer);
    if (callbacks_->has_failed()) simulation.restore(before);
  }
  callbacks_->rethrow();
  report.potential_names = simulation.potential_names();
  if (!is_success(report.status)) {
    const Explanation why = explain(simulation, report);
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
  const py::gil_scoped_release free;
  recording_.emplace(RunDirectory::create(folder, scene_, overwrite ? ExistingRun::overwrite : ExistingRun::refuse));
}

// Files are closed at the end of a run, so the recording continues as a resumed run, which has the same bits.
void LiveSimulation::flush() {
  const Use use(occupancy_, "simulation");
  if (is_stepping_) throw std::runtime_error("results are not available inside a step");
  if (!recording_) return;
  const py::gil_scoped_release free;
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

py::object python_of(const StepValue& value) {
  return std::visit([](const auto& v) { return py::cast(v); }, value);
}

py::dict columns_of(const Report& report) {
  py::dict result;
  for (const StepField& field : step_fields())
    if (field.get) result[py::str(std::string(field.name))] = python_of(field.get(report));
  return result;
}

std::string explanation_of(const Report& report) {
  if (report.cause.empty()) return "";
  return report.cause + (report.place.empty() ? "" : "; where: " + report.place) + "; remedy: " + report.remedy;
}

py::dict potential_of(const Report& report) {
  py::dict result;
  for (size_t i = 0; i < report.potential.size() && i < report.potential_names.size(); ++i)
    result[py::str(report.potential_names[i])] = report.potential[i];
  return result;
}

void bind_report(py::module_& m) {
  py::class_<Report> report(m, "StepReport", "The record of a time step.");
  report.def_readonly("step", &Report::step, "1 for the first.")
      .def_readonly("time", &Report::time, "At the end of the step [s].")
      .def_property_readonly("status", [](const Report& r) { return std::string(to_string(r.status)); })
      .def_property_readonly(
          "ok", [](const Report& r) { return is_success(r.status); }, "The step converged.")
      .def_readonly("iterations", &Report::iterations)
      .def_readonly("trials", &Report::trials, "Evaluations by line searches.")
      .def_readonly("projected_hessians", &Report::projected_hessians)
      .def_readonly("objective", &Report::objective, "E at the end of the minimization.")
      .def_readonly("gradient_norm", &Report::objective_gradient)
      .def_readonly("residual", &Report::residual, "|M a + dV/dx + dD/dx| over the free vertices [N].")
      .def_readonly("residual_threshold", &Report::residual_threshold, "[N]")
      .def_readonly("min_det_F", &Report::min_det_F)
      .def_readonly("contacts", &Report::contacts)
      .def_readonly("min_gap", &Report::min_gap, "Smallest distance of a contact [m].")
      .def_readonly("kinetic", &Report::kinetic, "[J]")
      .def_property_readonly("potential", &potential_of, "Energy of each term of V by name [J].")
      .def_readonly("potential_total", &Report::potential_total, "[J]")
      .def_readonly("pin_work", &Report::pin_work, "[J]")
      .def_readonly("load_work", &Report::load_work, "[J]")
      .def_readonly("muscle_work", &Report::muscle_work, "[J]")
      .def_readonly("damping_loss", &Report::damping_loss, "[J]")
      .def_readonly("nonconservative_work", &Report::nonconservative_work,
                    "Work of pressures on open patches beyond the change of their potential [J].")
      .def_readonly("numerical_loss", &Report::numerical_loss, "Energy lost by the integrator [J].")
      .def_readonly("ledger_error", &Report::ledger_error, "Difference of both sides of the energy balance [J].")
      .def_readonly("seconds", &Report::seconds, "Wall time.")
      .def_property_readonly("state_hash", [](const Report& r) { return hex_digits(r.state_hash); })
      .def_property_readonly("explanation", &explanation_of, "Cause, place and remedy of a failure; else empty.")
      .def("to_dict", &columns_of, "All columns of steps.csv.")
      .def("__repr__", [](const Report& r) {
        return "<StepReport " + std::to_string(r.step) + ": " + std::string(to_string(r.status)) + ", " +
               std::to_string(r.iterations) + " iterations>";
      });
}

Array state_array(LiveSimulation& self, std::vector<double> State::*member) {
  return self.layout().out(self.simulation().state().*member);
}

void set_state(LiveSimulation& self, const py::object& value, std::vector<double> State::*member) {
  Simulation::Snapshot snapshot = self.simulation().snapshot();
  snapshot.state.*member = self.layout().in(value, member == &State::q ? "q" : "v");
  snapshot.previous.reset();
  self.restore(snapshot);
}

py::dict fields_of(LiveSimulation& self) {
  const Simulation& simulation = self.simulation();
  const Renumbering& tet = simulation.model().numbering.tet;
  const TetFields fields = simulation.tet_fields();
  const py::ssize_t tets = simulation.model().mesh.tet_count();
  py::dict result;
  result["energy_density"] = to_array(tet.to_user(fields.energy_density), {tets});
  result["det_F"] = to_array(tet.to_user(fields.det_F), {tets});
  result["cauchy"] = to_array(tet.to_user(fields.cauchy, 6), {tets, 6});
  result["von_mises"] = to_array(tet.to_user(fields.von_mises), {tets});
  for (const auto& [name, values] : simulation.model().tet_fields)
    result[py::str(name)] = to_array(tet.to_user(values), {tets});
  return result;
}

py::list bodies_of(LiveSimulation& self) {
  py::list list;
  for (const BodyRange& body : self.simulation().model().bodies) {
    py::dict entry;
    entry["name"] = body.name;
    entry["vertices"] = py::slice(body.first_vertex, body.first_vertex + body.vertex_count, 1);
    entry["tets"] = py::slice(body.first_tet, body.first_tet + body.tet_count, 1);
    list.append(entry);
  }
  return list;
}

py::array_t<int> tets_of(LiveSimulation& self) {
  const Model& model = self.simulation().model();
  const TetMesh mesh = to_user(model.numbering, model.mesh);
  py::array_t<int> tets({static_cast<py::ssize_t>(mesh.tets.size()), py::ssize_t{4}});
  std::copy_n(mesh.tets.data()->data(), tets.size(), tets.mutable_data());
  return tets;
}

py::array pinned_of(LiveSimulation& self) {
  const Model& model = self.simulation().model();
  py::array_t<bool> pinned(model.mesh.vertex_count());
  std::fill_n(pinned.mutable_data(), pinned.size(), false);
  for (const Pin& pin : model.pins)
    for (const int v : pin.vertices) pinned.mutable_data()[model.numbering.vertex.to_user(v)] = true;
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
  py::class_<Simulation::Snapshot>(m, "Snapshot", "A state that a simulation can return to, with the same bits.")
      .def_property_readonly("time", [](const Simulation::Snapshot& s) { return s.state.time; });
  py::class_<LiveSimulation, std::shared_ptr<LiveSimulation>>(m, "Simulation")
      .def(py::init([](std::shared_ptr<SceneSource> source) { return std::make_shared<LiveSimulation>(source); }))
      .def("step", &LiveSimulation::step, py::arg("observe") = py::none(), py::arg("direction") = py::none(),
           py::arg("line_search") = py::none())
      .def_property_readonly("q", [](LiveSimulation& s) { return state_array(s, &State::q); })
      .def_property_readonly("v", [](LiveSimulation& s) { return state_array(s, &State::qdot); })
      .def("set_q", [](LiveSimulation& s, const py::object& q) { set_state(s, q, &State::q); })
      .def("set_v", [](LiveSimulation& s, const py::object& v) { set_state(s, v, &State::qdot); })
      .def_property_readonly("rest",
                             [](LiveSimulation& s) {
                               const Model& model = s.simulation().model();
                               return to_array(to_user(model.numbering, model.mesh).rest);
                             })
      .def_property_readonly("tets", &tets_of)
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
      .def_property_readonly("resolved", [](LiveSimulation& s) { return s.scene().resolved; })
      .def_property_readonly("solver", [](LiveSimulation& s) { return s.simulation().solver_description(); })
      .def_property_readonly("state_hash", [](LiveSimulation& s) { return hex_digits(s.simulation().state_hash()); })
      .def("fields", &fields_of)
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
