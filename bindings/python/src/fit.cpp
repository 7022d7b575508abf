// Equilibria and motions as differentiable functions of the material, and fits to measurements.
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <cmath>

#include "base/error.h"
#include "bindings.h"
#include "data/data_set.h"
#include "data/synthesis.h"
#include "material/registry.h"
#include "model/elastic_parameters.h"
#include "model/equilibrium.h"
#include "model/trajectory.h"
#include "pipeline/fit_options.h"
#include "pipeline/fit_run.h"
#include "pipeline/fit_verdict.h"
#include "scene/material_file.h"
#include "simulation.h"
#include "to_table.h"

namespace aspic::python {
namespace {

// The parameters theta of every tet, (m, p) in the order of the user: mu, lambda [Pa] and the material's own.
class ParameterArrays {
 public:
  explicit ParameterArrays(const Model& model) : tet_(model.numbering.tet) {
    if (!model.mesh.sheet.empty())
      throw InvalidInput("the scene has sheets; derivatives by material parameters need bodies of tets");
    for (const auto& term : model.elasticity) {
      if (count_ != 0 && term->parameter_count() != count_)
        throw InvalidInput("the bodies have materials with different numbers of parameters; give them one material");
      count_ = term->parameter_count();
      const auto own = term->parameters();
      values_.insert(values_.end(), own.begin(), own.end());
    }
  }

  std::vector<MaterialParameters> in(const py::handle& value) const {
    const std::vector<double> flat = tet_.from_user(view(reals(value, "parameters", shape())), count_);
    std::vector<MaterialParameters> all = values_;
    for (size_t t = 0; t < all.size(); ++t) {
      const double* row = flat.data() + t * static_cast<size_t>(count_);
      if (!(row[0] > 0) || !(row[1] > -2.0 / 3 * row[0]))
        throw InvalidInput("parameters[" + std::to_string(tet_.to_user(static_cast<int>(t))) +
                           "]: mu must be positive and lambda above -2/3 mu");
      all[t].lame = {row[0], row[1]};
      for (int e = 2; e < count_; ++e) all[t].extra[static_cast<size_t>(e) - 2] = row[e];
    }
    return all;
  }

  Array out() const {
    std::vector<double> flat;
    for (const MaterialParameters& p : values_) {
      flat.push_back(p.lame.mu);
      flat.push_back(p.lame.lambda);
      for (int e = 2; e < count_; ++e) flat.push_back(p.extra[static_cast<size_t>(e) - 2]);
    }
    return gradient(flat);
  }

  std::vector<double> change_in(const py::handle& value) const {
    return tet_.from_user(view(reals(value, "change", shape())), count_);
  }
  Array gradient(std::span<const double> flat) const { return to_array(tet_.to_user(flat, count_), shape()); }
  size_t size() const { return values_.size() * static_cast<size_t>(count_); }
  Shape shape() const { return {static_cast<py::ssize_t>(values_.size()), count_}; }
  const Renumbering& tet() const { return tet_; }

 private:
  Renumbering tet_;
  int count_ = 0;
  std::vector<MaterialParameters> values_;  // as in the scene
};

Layout layout_of(const Model& model) { return Layout::of_vertices(model.numbering.vertex, model.mesh.vertex_count()); }

// x(theta) = argmin V(x; theta)
class PyEquilibrium {
 public:
  PyEquilibrium(const SceneSource& source, double tolerance)
      : PyEquilibrium(source, tolerance, std::make_shared<Callbacks>()) {}

  Array solve(const py::object& parameters, const py::object& start) {
    require_idle(occupancy_, "solve");
    const Use use(occupancy_, "equilibrium");
    if (!start.is_none()) equilibrium_.set_x(layout_.in(start, "start"));
    if (!parameters.is_none()) equilibrium_.set_parameters(parameters_.in(parameters));
    MinimizeReport report;
    is_linearized_ = false;
    {
      const ReleasedGil free;
      report = equilibrium_.solve();
    }
    callbacks_->rethrow();
    if (!is_success(report.status)) throw std::runtime_error("no equilibrium: " + equilibrium_.failure());
    return layout_.out(equilibrium_.x());
  }

  Array vjp(const py::object& qbar) {
    require_idle(occupancy_, "vjp");
    const Use use(occupancy_, "equilibrium");
    const std::vector<double> weights = layout_.in(qbar, "qbar");
    linearize();
    std::vector<double> gradient(parameters_.size());
    SolveReport report;
    {
      const ReleasedGil free;
      report = equilibrium_.add_adjoint(weights, gradient);
    }
    check(report);
    return parameters_.gradient(gradient);
  }

  Array jvp(const py::object& change) {
    require_idle(occupancy_, "jvp");
    const Use use(occupancy_, "equilibrium");
    const std::vector<double> dtheta = parameters_.change_in(change);
    linearize();
    std::vector<double> dx(3 * static_cast<size_t>(layout_.rows()));
    SolveReport report;
    {
      const ReleasedGil free;
      report = equilibrium_.tangent(dtheta, dx);
    }
    check(report);
    return layout_.out(dx);
  }

  Array parameters() const { return parameters_.out(); }
  Shape shape() const { return {layout_.rows(), 3}; }

 private:
  PyEquilibrium(const SceneSource& source, double tolerance, const std::shared_ptr<Callbacks>& callbacks)
      : PyEquilibrium(source.model(callbacks), tolerance, callbacks) {}
  PyEquilibrium(SceneModel scene, double tolerance, const std::shared_ptr<Callbacks>& callbacks)
      : callbacks_(callbacks),
        parameters_(scene.model),
        layout_(layout_of(scene.model)),
        equilibrium_(made_from(scene, tolerance)) {}

  static Equilibrium made_from(SceneModel& scene, double tolerance) {
    const ReleasedGil free;
    return Equilibrium(std::move(scene.model), std::move(scene.start.q), {.tolerance = tolerance});
  }

  void linearize() {
    if (is_linearized_) return;
    const ReleasedGil free;
    is_linearized_ = equilibrium_.factorize();
    if (!is_linearized_) throw std::runtime_error("no derivatives: " + equilibrium_.failure());
  }
  static void check(const SolveReport& report) {
    if (!report.ok && report.relative_residual > 1e-6)
      throw std::runtime_error("the adjoint solve failed: relative residual " +
                               std::to_string(report.relative_residual));
  }

  std::shared_ptr<Callbacks> callbacks_;
  ParameterArrays parameters_;
  Layout layout_;
  Equilibrium equilibrium_;
  bool is_linearized_ = false;
  Occupancy occupancy_;
};

// The motion as a function of the material and the initial state.
class PyTrajectory {
 public:
  PyTrajectory(const SceneSource& source, const TrajectoryOptions& options)
      : PyTrajectory(source, options, std::make_shared<Callbacks>()) {}

  void set_parameters(const py::object& parameters) {
    require_idle(occupancy_, "set_parameters");
    const Use use(occupancy_, "trajectory");
    trajectory_->set_parameters(parameters_.in(parameters));
  }
  void set_start(const py::object& q, const py::object& v) {
    require_idle(occupancy_, "set_start");
    const Use use(occupancy_, "trajectory");
    start_.q = layout_.in(q, "q"), start_.qdot = layout_.in(v, "v");
    trajectory_->set_start(start_);
  }

  Array simulate() {
    const auto size = static_cast<size_t>(layout_.size());
    Array motion(Shape{options_.steps + 1, layout_.rows(), 3});
    double* const data = motion.mutable_data();
    run(
        [&](int point, const State& state, std::span<double>, std::span<double>) {
          const std::vector<double> q = layout_.vertex.to_user(state.q, 3);
          std::copy(q.begin(), q.end(), data + static_cast<size_t>(point) * size);
          return 0.0;
        },
        nullptr);
    return motion;
  }

  py::dict vjp(const py::object& qbar) {
    const Array weights = reals(qbar, "qbar", {options_.steps + 1, layout_.rows(), 3});
    const auto size = static_cast<size_t>(layout_.size());
    TrajectoryGradient gradient;
    run(
        [&](int point, const State&, std::span<double> q, std::span<double>) {
          if (q.empty()) return 0.0;
          const std::span<const double> row = view(weights).subspan(static_cast<size_t>(point) * size, size);
          const std::vector<double> own = layout_.vertex.from_user(row, 3);
          for (size_t i = 0; i < size; ++i) q[i] += own[i];
          return 0.0;
        },
        &gradient);
    return dict_of(gradient);
  }

  // objective(point, q, v) returns a value, or (value, dvalue/dq, dvalue/dv) with None for zeros.
  py::tuple value_and_gradient(const py::function& objective) {
    TrajectoryGradient gradient;
    const TrajectoryReport report = run(
        [&](int point, const State& state, std::span<double> q, std::span<double> v) {
          double value = 0;
          callbacks_->call([&] {
            const py::object result = objective(point, layout_.out(state.q), layout_.out(state.qdot));
            if (!py::isinstance<py::tuple>(result)) {
              value = result.cast<double>();
              return;
            }
            const py::tuple parts = result;
            value = parts[0].cast<double>();
            if (!q.empty() && parts.size() > 1) add(parts[1], "dvalue/dq", q);
            if (!v.empty() && parts.size() > 2) add(parts[2], "dvalue/dv", v);
          });
          return value;
        },
        &gradient);
    return py::make_tuple(report.value, dict_of(gradient));
  }

  Array parameters() const { return parameters_.out(); }
  Shape shape() const { return {options_.steps + 1, layout_.rows(), 3}; }

 private:
  PyTrajectory(const SceneSource& source, TrajectoryOptions options, std::shared_ptr<Callbacks> callbacks)
      : PyTrajectory(source.model(callbacks), std::move(options), callbacks) {}
  PyTrajectory(SceneModel scene, TrajectoryOptions options, std::shared_ptr<Callbacks> callbacks)
      : callbacks_(std::move(callbacks)),
        parameters_(scene.model),
        layout_(layout_of(scene.model)),
        options_(std::move(options)),
        start_(scene.start) {
    if (options_.h == 0) options_.h = scene.options.h;
    options_.integrator = scene.options.integrator;
    options_.stop = callbacks_->token();
    const ReleasedGil free;
    trajectory_.emplace(std::move(scene.model), std::move(scene.start), options_);
  }

  TrajectoryReport run(const TrajectoryObjective& objective, TrajectoryGradient* gradient) {
    require_idle(occupancy_, "simulate");
    const Use use(occupancy_, "trajectory");
    TrajectoryReport report;
    {
      const ReleasedGil free;
      report = gradient ? trajectory_->differentiate(objective, *gradient) : trajectory_->simulate(objective);
    }
    callbacks_->rethrow();
    if (!report.ok) throw std::runtime_error("the motion failed: " + report.message);
    return report;
  }

  void add(const py::object& value, const char* name, std::span<double> sum) const {
    if (value.is_none()) return;
    const std::vector<double> own = layout_.in(value, name);
    for (size_t i = 0; i < sum.size(); ++i) sum[i] += own[i];
  }

  py::dict dict_of(const TrajectoryGradient& gradient) const {
    py::dict result;
    result["parameters"] = parameters_.gradient(gradient.elastic);
    if (!gradient.density.empty())
      result["density"] =
          to_array(parameters_.tet().to_user(gradient.density), {static_cast<py::ssize_t>(gradient.density.size())});
    result["q"] = layout_.out(gradient.q);
    result["v"] = layout_.out(gradient.qdot);
    return result;
  }

  std::shared_ptr<Callbacks> callbacks_;
  ParameterArrays parameters_;
  Layout layout_;
  TrajectoryOptions options_;
  State start_;
  std::optional<Trajectory> trajectory_;
  Occupancy occupancy_;
};

py::dict dict_of(const FittedQuantity& quantity, const Renumbering& tet) {
  const auto array = [&](const std::vector<double>& values) -> py::object {
    if (values.empty()) return py::none();
    return to_array(tet.to_user(values), {static_cast<py::ssize_t>(values.size())});
  };
  py::dict result;
  result["unit"] = quantity.unit;
  result["values"] = array(quantity.values);
  result["sigma"] = array(quantity.sigma);
  result["reduction"] = array(quantity.reduction);
  py::list rows;
  for (const ValueRow& row : quantity.rows)
    rows.append(py::make_tuple(
        row.where, row.value,
        row.interval ? py::object(py::make_tuple(row.interval->lower, row.interval->upper)) : py::object(py::none())));
  result["rows"] = rows;
  return result;
}

py::dict dict_of(const DataSet& data, const FitOutcome& outcome) {
  py::dict result, quantities;
  for (const FittedQuantity& quantity : outcome.quantities)
    quantities[py::str(quantity.name)] = dict_of(quantity, data.numbering.tet);
  py::list history;
  for (const FitIteration& it : outcome.report.history)
    history.append(py::make_tuple(it.misfit, it.roughness, it.decrement));
  const FitVerdict judged = verdict(data, outcome);
  py::list reasons;
  for (const FitReason& reason : judged.reasons) reasons.append(reason.text);
  result["quantities"] = quantities;
  result["status"] = std::string(to_string(outcome.report.status));
  result["misfit"] = outcome.report.misfit;
  result["residuals"] = outcome.residuals;
  result["history"] = history;
  result["good"] = judged.is_good();
  result["verdict"] = judged.text;
  result["reasons"] = reasons;
  result["warnings"] = outcome.warnings;
  return result;
}

py::dict fit_data(const std::filesystem::path& path, const std::string& model,
                  const std::vector<std::string>& parameters, const std::vector<std::string>& known,
                  const py::dict& options, const py::object& observe, const py::object& out) {
  FitPlan plan;
  plan.model = material_info(model).name;
  for (const std::string& text : parameters) plan.parameters.push_back(parse_parameter(text));
  for (const std::string& text : known) plan.known.push_back(parse_known(text));
  read_fit_options(to_value(options, "fit").table(), "fit", plan);
  Callbacks callbacks;
  FitCallbacks observers{.stop = callbacks.token()};
  if (!observe.is_none())
    observers.iterate = [&](FitStage, const FitIteration& it, std::span<const double> p) {
      callbacks.call([&] { observe(it.index, it.misfit, to_array(p, {static_cast<py::ssize_t>(p.size())})); });
    };
  DataSet data;
  FitOutcome outcome;
  {
    const ReleasedGil free;
    data = read_data_set(path);
    outcome = fit_material(data, plan, {}, observers);
  }
  callbacks.rethrow();
  if (!outcome.has_material()) throw std::runtime_error("the fit failed: " + outcome.failure);
  if (!out.is_none()) write_material(out.cast<std::filesystem::path>(), outcome.material);
  return dict_of(data, outcome);
}

std::vector<std::string> capture(const SceneSource& source, const std::filesystem::path& folder,
                                 const py::dict& numbers) {
  Callbacks callbacks;
  SynthesisOptions options{.stop = callbacks.token()};
  const auto read = [&](const char* key, auto& value) {
    if (numbers.contains(key)) value = numbers[key].cast<std::remove_reference_t<decltype(value)>>();
  };
  read("indentations", options.indentations), read("depths", options.depths), read("markers", options.markers);
  read("deepest", options.deepest), read("tip_radius", options.indenter_radius), read("seed", options.seed);
  read("noise", options.noise), read("force_noise", options.force_noise), read("regions", options.regions);
  const Scene scene = source.scene(std::make_shared<Callbacks>());
  Synthesis made;
  {
    const ReleasedGil free;
    made = synthesize(scene, options);
    if (!made.interrupted)
      write_data_set(folder, made.data,
                     [&](const std::filesystem::path& beside) { write_material(beside / "truth.vtu", made.truth); });
  }
  callbacks.rethrow();
  return made.notes;
}

TrajectoryOptions trajectory_options(int steps, double h, double tolerance) {
  if (steps < 1) throw InvalidInput("steps: at least 1 is needed");
  if (!(h >= 0) || !std::isfinite(h)) throw InvalidInput("h: must be positive and finite [s]");
  return {.h = h, .steps = steps, .tolerance = tolerance};
}

}  // namespace

void bind_fit(py::module_& m) {
  py::class_<PyEquilibrium>(m, "Equilibrium")
      .def(py::init([](const std::shared_ptr<SceneSource>& source, double tolerance) {
             return std::make_unique<PyEquilibrium>(*source, tolerance);
           }),
           py::arg().none(false), py::arg())
      .def("solve", &PyEquilibrium::solve)
      .def("vjp", &PyEquilibrium::vjp)
      .def("jvp", &PyEquilibrium::jvp)
      .def_property_readonly("parameters", &PyEquilibrium::parameters)
      .def_property_readonly("shape", [](const PyEquilibrium& e) { return py::tuple(py::cast(e.shape())); });
  py::class_<PyTrajectory>(m, "Trajectory")
      .def(py::init([](const std::shared_ptr<SceneSource>& source, int steps, double h, double tolerance) {
             return std::make_unique<PyTrajectory>(*source, trajectory_options(steps, h, tolerance));
           }),
           py::arg().none(false), py::arg(), py::arg(), py::arg())
      .def("set_parameters", &PyTrajectory::set_parameters)
      .def("set_start", &PyTrajectory::set_start)
      .def("simulate", &PyTrajectory::simulate)
      .def("vjp", &PyTrajectory::vjp)
      .def("value_and_gradient", &PyTrajectory::value_and_gradient)
      .def_property_readonly("parameters", &PyTrajectory::parameters)
      .def_property_readonly("shape", [](const PyTrajectory& t) { return py::tuple(py::cast(t.shape())); });
  m.def("fit", &fit_data);
  m.def(
      "capture",
      [](const std::shared_ptr<SceneSource>& source, const std::filesystem::path& folder, const py::dict& numbers) {
        return capture(*source, folder, numbers);
      },
      py::arg().none(false), py::arg(), py::arg());
}

}  // namespace aspic::python
