// Reports of steps: values by name, the columns of steps.csv, and pickles.
#include <pybind11/stl.h>

#include <algorithm>

#include "base/error.h"
#include "base/hash.h"
#include "bindings.h"
#include "dynamics/step_fields.h"
#include "simulation.h"

namespace aspic::python {
namespace {

using Names = std::vector<std::string>;

py::object python_of(const StepValue& value) {
  return std::visit([](const auto& v) { return py::cast(v); }, value);
}

StepValue value_of(const StepField& field, const py::handle& value) {
  switch (field.type) {
    case StepFieldType::flag:
      return value.cast<bool>();
    case StepFieldType::count:
      return value.cast<int>();
    case StepFieldType::real:
      return value.cast<double>();
    default:
      return value.cast<std::string>();
  }
}

// Calls visit(name, resultant).
template <class Visit>
void for_each(const Names& names, const std::vector<Resultant>& resultants, const Visit& visit) {
  for (size_t i = 0; i < std::min(names.size(), resultants.size()); ++i) visit(names[i], resultants[i]);
}

py::dict vectors_of(const Names& names, const std::vector<Resultant>& resultants, Vec3d Resultant::*member) {
  py::dict result;
  for_each(names, resultants,
           [&](const std::string& name, const Resultant& sum) { result[py::str(name)] = to_array(sum.*member); });
  return result;
}

py::dict potential_of(const Report& report) {
  py::dict result;
  for (size_t i = 0; i < std::min(report.potential.size(), report.potential_names.size()); ++i)
    result[py::str(report.potential_names[i])] = report.potential[i];
  return result;
}

void add_resultants(const Report& report, py::dict& columns) {
  const auto add = [&](const std::string& kind, const Names& names, const std::vector<Resultant>& resultants) {
    for_each(names, resultants, [&](const std::string& name, const Resultant& sum) {
      for (const auto& [prefix, vector] : {std::pair(kind + "_", sum.force), std::pair(kind + "_moment_", sum.moment)})
        for (int r = 0; r < 3; ++r) columns[py::str(prefix + name + "_" + "xyz"[r])] = vector[r];
    });
  };
  add("reaction", report.pin_names, report.resultants.pins);
  add("load", report.load_names, report.resultants.loads);
  add("body", report.body_names, report.resultants.bodies);
  for (size_t i = 0; i < report.cavities.size(); ++i) {
    columns[py::str("volume_" + report.cavity_names[i])] = report.cavities[i].volume;
    columns[py::str("pressure_" + report.cavity_names[i])] = report.cavities[i].pressure;
  }
}

py::dict columns_of(const Report& report) {
  py::dict result;
  for (const StepField& field : step_fields()) {
    if (field.get) result[py::str(std::string(field.name))] = python_of(field.get(report));
    if (field.type == StepFieldType::resultants) add_resultants(report, result);
    if (field.type != StepFieldType::potentials) continue;
    for (const auto& [name, energy] : potential_of(report))
      result[py::str("potential_" + std::string(py::str(name)))] = energy;
  }
  result["status"] = std::string(to_string(report.status));
  return result;
}

std::string explanation_of(const Report& report) {
  if (report.cause.empty()) return "";
  return report.cause + (report.place.empty() ? "" : "; where: " + report.place) + "; remedy: " + report.remedy;
}

// (n, 6): force and moment.
Array rows_of(const std::vector<Resultant>& resultants) {
  std::vector<double> rows;
  for (const Resultant& sum : resultants)
    for (const Vec3d* v : {&sum.force, &sum.moment}) rows.insert(rows.end(), v->a, v->a + 3);
  return to_array(rows, {static_cast<py::ssize_t>(resultants.size()), 6});
}

std::vector<Resultant> resultants_in(const py::handle& rows) {
  const Array numbers = reals(rows, "resultants", {-1, 6}, Finite::not_required);
  std::vector<Resultant> resultants(static_cast<size_t>(numbers.shape(0)));
  const double* at = numbers.data();
  for (Resultant& sum : resultants)
    for (Vec3d* v : {&sum.force, &sum.moment})
      for (int r = 0; r < 3; ++r) (*v)[r] = *at++;
  return resultants;
}

py::dict dict_of_all(const Report& report) {
  py::dict state;
  for (const StepField& field : step_fields())
    if (field.get && field.set) state[py::str(std::string(field.name))] = python_of(field.get(report));
  state["status"] = static_cast<int>(report.status);
  state["objective"] = report.objective, state["gradient_norm"] = report.objective_gradient;
  state["potential"] = report.potential;
  state["names"] = py::make_tuple(report.potential_names, report.pin_names, report.load_names, report.body_names,
                                  report.cavity_names);
  std::vector<std::pair<double, double>> cavities;
  for (const CavityState& cavity : report.cavities) cavities.emplace_back(cavity.volume, cavity.pressure);
  state["cavities"] = cavities;
  const Resultants& sums = report.resultants;
  state["resultants"] = py::make_tuple(rows_of(sums.pins), rows_of(sums.loads), rows_of(sums.bodies));
  state["explanation"] = py::make_tuple(report.cause, report.place, report.remedy);
  return state;
}

Report report_in(const py::dict& state) {
  Report report;
  for (const StepField& field : step_fields())
    if (field.get && field.set && field.name != "status")
      field.set(report, value_of(field, state[py::str(std::string(field.name))]));
  report.status = static_cast<Status>(std::clamp(state["status"].cast<int>(), 0, kStatusCount - 1));
  report.objective = state["objective"].cast<double>();
  report.objective_gradient = state["gradient_norm"].cast<double>();
  report.potential = state["potential"].cast<std::vector<double>>();
  const py::tuple names = state["names"], sums = state["resultants"], explanation = state["explanation"];
  size_t i = 0;
  for (Names* of :
       {&report.potential_names, &report.pin_names, &report.load_names, &report.body_names, &report.cavity_names})
    *of = names[i++].cast<Names>();
  for (const auto& [volume, pressure] : state["cavities"].cast<std::vector<std::pair<double, double>>>())
    report.cavities.push_back({volume, pressure});
  if (report.cavities.size() != report.cavity_names.size()) throw InvalidInput("cavities and their names differ");
  i = 0;
  for (auto* of : {&report.resultants.pins, &report.resultants.loads, &report.resultants.bodies})
    *of = resultants_in(sums[i++]);
  i = 0;
  for (std::string* of : {&report.cause, &report.place, &report.remedy}) *of = explanation[i++].cast<std::string>();
  return report;
}

}  // namespace

Report named(const StepReport& report, const Simulation& simulation) {
  Report result{report, simulation.potential_names(), {}, {}, {}, {}, {}, {}, {}};
  const Model& model = simulation.model();
  if (report.worst_vertex >= 0) result.worst_vertex = model.numbering.vertex.to_user(report.worst_vertex);
  for (const Pin& pin : model.pins) result.pin_names.push_back(pin.name);
  for (const auto& load : model.loads) {
    result.load_names.emplace_back(load->name());
    if (dynamic_cast<const Cavity*>(load.get())) result.cavity_names.emplace_back(load->name());
  }
  for (const BodyRange& body : model.bodies) result.body_names.push_back(body.name);
  return result;
}

void bind_report(py::module_& m) {
  py::class_<Report> report(m, "StepReport", "The record of a time step.");
  report.def_readonly("step", &Report::step, "1 for the first.")
      .def_readonly("time", &Report::time, "At the end of the step [s].")
      .def_property_readonly(
          "status", [](const Report& r) { return std::string(to_string(r.status)); },
          "converged, round_off (a success, too), or why the step ended: iteration_limit, budget, stuck, no_descent, "
          "interrupted, undefined, unstable, inaccurate, inverted.")
      .def_property_readonly(
          "ok", [](const Report& r) { return is_success(r.status); }, "The step converged.")
      .def_readonly("iterations", &Report::iterations, "Iterations of the minimizer.")
      .def_readonly("trials", &Report::trials, "Evaluations by line searches.")
      .def_readonly("projected_hessians", &Report::projected_hessians,
                    "Modified Hessians among those of the iterations.")
      .def_readonly("objective", &Report::objective, "E at the end of the minimization.")
      .def_readonly("gradient_norm", &Report::objective_gradient,
                    "Norm of the gradient of E at the end of the minimization.")
      .def_readonly("residual", &Report::residual, "|M a + dV/dx + dD/dx| over the free vertices [N].")
      .def_readonly("residual_threshold", &Report::residual_threshold,
                    "The residual below which a step counts as converged [N].")
      .def_readonly("min_det_F", &Report::min_det_F, "Smallest volume ratio of any tet; negative: inverted.")
      .def_readonly("contacts", &Report::contacts, "Pairs of surface features in contact.")
      .def_readonly("min_gap", &Report::min_gap, "Smallest distance of a contact [m].")
      .def_readonly("attachment_gap", &Report::attachment_gap, "Largest gap of an attachment [m].")
      .def_readonly("kinetic", &Report::kinetic, "Kinetic energy [J].")
      .def_property_readonly("potential", &potential_of, "Energy of each term of V by name [J].")
      .def_readonly("potential_total", &Report::potential_total, "V, the sum of all potentials [J].")
      .def_readonly("pin_work", &Report::pin_work, "Work of moving pins [J].")
      .def_readonly("load_work", &Report::load_work, "Work of loads [J].")
      .def_readonly("muscle_work", &Report::muscle_work, "Work of muscles [J].")
      .def_readonly("damping_loss", &Report::damping_loss, "Energy lost to damping and friction [J].")
      .def_readonly("nonconservative_work", &Report::nonconservative_work,
                    "Work of pressures on open patches beyond the change of their potential [J].")
      .def_readonly("numerical_loss", &Report::numerical_loss, "Energy lost by the integrator [J].")
      .def_readonly("ledger_error", &Report::ledger_error, "Difference of both sides of the energy balance [J].")
      .def_property_readonly(
          "reactions", [](const Report& r) { return vectors_of(r.pin_names, r.resultants.pins, &Resultant::force); },
          "Mean force of each pin on its vertices by name [N].")
      .def_property_readonly(
          "reaction_moments",
          [](const Report& r) { return vectors_of(r.pin_names, r.resultants.pins, &Resultant::moment); },
          "Moment of each pin about the origin by name [N m].")
      .def_readonly("seconds", &Report::seconds, "Wall time.")
      .def_property_readonly(
          "state_hash", [](const Report& r) { return hex_digits(r.state_hash); }, "As in steps.csv: 16 digits.")
      .def_property_readonly("explanation", &explanation_of, "Cause, place and remedy of a failure; else empty.")
      .def("to_dict", &columns_of, "All columns of steps.csv.")
      .def(py::pickle(&dict_of_all, &report_in))
      .def("__repr__", [](const Report& r) {
        return "<StepReport " + std::to_string(r.step) + ": " + std::string(to_string(r.status)) + ", " +
               std::to_string(r.iterations) + " iterations>";
      });
}

}  // namespace aspic::python
