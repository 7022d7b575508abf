// Objectives, iterations, and minimization with functions and directions written in Python.
#include <pybind11/stl.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "base/error.h"
#include "bindings.h"
#include "custom_method.h"
#include "iteration.h"
#include "optimize/derivative_check.h"
#include "optimize/landscape.h"
#include "optimize/solver.h"
#include "optimize/test_functions.h"
#include "python_function.h"
#include "scene/schema.h"
#include "scene/solver_options.h"
#include "to_table.h"

namespace aspic::python {

Objective& Function::E() {
  if (!E_)
    throw std::runtime_error("this objective belonged to an observer that has returned; use it inside the observer");
  return *E_;
}

double Function::value(const py::handle& x) {
  const Use use(occupancy_, "objective");
  const std::vector<double> in = layout_.in(x, "x");
  Objective& f = E();
  Evaluation found;
  {
    const ReleasedGil free;
    found = f.evaluate(in);
  }
  callbacks_->rethrow();
  round_off_ = found.round_off;
  return found.value;
}

Array Function::gradient(const py::handle& x) {
  const Use use(occupancy_, "objective");
  const std::vector<double> in = layout_.in(x, "x");
  std::vector<double> g(in.size());
  Objective& f = E();
  {
    const ReleasedGil free;
    f.gradient(in, g);
  }
  callbacks_->rethrow();
  return layout_.out(g);
}

std::shared_ptr<Hessian> Function::hessian(const py::handle& x, const std::string& definiteness) {
  const Use use(occupancy_, "objective");
  const std::vector<double> in = layout_.in(x, "x");
  const Projection projection{definiteness_named(definiteness)};
  std::shared_ptr<Hessian> result;
  Objective& f = E();
  {
    const ReleasedGil free;
    const BlockSparse& H = f.hessian(in, projection);
    if (const auto* dense = f.traits().dense_rows; dense && !dense->dense_rows().empty())
      throw InvalidInput(
          "the Hessian of a closed cavity couples all vertices of its surface: it is not a sparse matrix");
    if (!pattern_ || pattern_->version != H.pattern->version)
      pattern_ = std::make_shared<const BlockPattern>(*H.pattern);
    result = std::make_shared<Hessian>(H, pattern_, layout_);
  }
  callbacks_->rethrow();
  return result;
}

double Function::max_step(const py::handle& x, const py::handle& d) {
  const Use use(occupancy_, "objective");
  const std::vector<double> from = layout_.in(x, "x"), along = layout_.in(d, "d");
  Objective& f = E();
  const ReleasedGil free;
  return f.max_step(from, along);
}

ObservedIteration::ObservedIteration(const LiveIteration& live, const Layout& layout,
                                     std::shared_ptr<Callbacks> callbacks)
    : Iteration(live),
      objective(std::make_shared<Function>(&live.E, layout, std::move(callbacks))),
      trials(Shape{static_cast<py::ssize_t>(live.tried.size()), 5}),
      live_(&live) {
  double* row = trials.mutable_data();
  for (const Trial& trial : live.tried)
    for (const double x :
         {trial.alpha, trial.value, trial.bound, trial.accepted ? 1.0 : 0.0, trial.by_slope ? 1.0 : 0.0})
      *row++ = x;
}

const LiveIteration& ObservedIteration::live() const {
  if (!live_) throw std::runtime_error("this iteration is over; copy its vectors inside the observer");
  return *live_;
}

IterationObserver observer_of(const py::object& observe, const Layout& layout, std::shared_ptr<Callbacks> callbacks) {
  if (observe.is_none()) return {};
  if (!PyCallable_Check(observe.ptr())) throw InvalidInput("observe: must be callable, as observe(iteration)");
  return [observe = observe.ptr(), layout, callbacks](const LiveIteration& live) {
    callbacks->call([&] {
      const auto iteration = std::make_shared<ObservedIteration>(live, layout, callbacks);
      struct Expire {
        ObservedIteration& it;
        ~Expire() { it.expire(); }
      } const at_end{*iteration};
      const Lent lent(iteration->objective);
      const py::object result = py::reinterpret_borrow<py::object>(observe)(iteration);
      if (result.ptr() == Py_False) callbacks->stop();
    });
  };
}

namespace {

py::dict dict_of(const MinimizeReport& report, const Array& x) {
  py::dict result;
  result["x"] = x;
  result["status"] = std::string(to_string(report.status));
  result["success"] = is_success(report.status);
  result["value"] = report.value;
  result["gradient_norm"] = report.gradient_norm;
  result["iterations"] = report.iterations;
  result["trials"] = report.trials;
  result["values"] = report.values;
  result["gradients"] = report.gradients;
  result["hessians"] = report.hessians;
  return result;
}

// A line search written in Python among the options; None if there is none.
py::object take_line_search(py::dict& options) {
  if (!options.contains("line_search") || !PyCallable_Check(py::object(options["line_search"]).ptr()))
    return py::none();
  return options.attr("pop")("line_search");
}

py::dict minimize_function(Function& f, const py::object& start, const py::object& direction, py::dict options,
                           const py::object& observe) {
  const Use use(f.occupancy(), "objective");
  std::vector<double> x = f.layout().in(start, "x");
  const std::shared_ptr<Callbacks> callbacks(&f.callbacks(), [](auto*) {});  // f outlives the minimization
  const MethodContext context{f.layout(), callbacks, [&f](std::span<double> d) { f.set_pins_zero(d); }};
  const bool is_named = py::isinstance<py::str>(direction);
  const py::object line_search = take_line_search(options);
  Value table = to_value(options, "solver");
  if (is_named) table.table().set("method", {direction.cast<std::string>(), table.place});
  check_and_complete(table.table(), "solver", scene_schema(), "solver");
  SolverOptions chosen = solver_options(table);
  const auto search = is_named ? make_search_direction(chosen) : make_python_direction(direction, context);
  MinimizeOptions& how = chosen.minimize;
  how.line_search.custom = make_python_line_search(line_search, context);
  how.stop = callbacks->token();
  const IterationObserver observer = observer_of(observe, f.layout(), callbacks);
  MinimizeReport report;
  {
    const ReleasedGil free;
    report = Minimizer().minimize(f.E(), *search, x, how, observer);
  }
  callbacks->rethrow();
  return dict_of(report, f.layout().out(x));
}

py::dict dict_of(const DerivativeCheck& check) {
  py::dict result;
  const py::ssize_t n = static_cast<py::ssize_t>(check.step.size());
  result["step"] = to_array(check.step, {n});
  result["error"] = to_array(check.error, {n});
  result["smallest_error"] = check.smallest_error;
  result["order"] = check.order;
  result["passed"] = check.passed;
  result["row"] = check.row;
  result["column"] = check.column;
  result["found"] = check.found;
  result["expected"] = check.expected;
  return result;
}

// Functions of flat arrays of n numbers.
py::tuple check_python_derivatives(const py::function& value, const py::function& gradient, const py::function& product,
                                   const py::object& at, double length, double tolerance, const py::object& fixed) {
  const Nested nested;
  const Array x = reals(at, "x", {-1});
  const Shape shape = {x.size()};
  const auto array = [&](std::span<const double> v) { return to_array(v, shape); };
  const auto copy = [&](const py::object& from, std::span<double> to, const char* name) {
    const Array numbers = reals(from, name, shape, Finite::not_required);
    std::copy_n(numbers.data(), to.size(), to.begin());
  };
  const Differentiable f{
      [&](std::span<const double> v) { return py::cast<double>(py::float_(value(array(v)))); },
      [&](std::span<const double> v, std::span<double> g) { copy(gradient(array(v)), g, "gradient"); },
      [&](std::span<const double> v, std::span<const double> d, std::span<double> Hd) {
        copy(product(array(v), array(d)), Hd, "hessian");
      }};
  DerivativeCheckOptions options{.length = length, .tolerance = tolerance};
  if (!fixed.is_none())
    for (const auto mark : fixed) options.fixed.push_back(py::cast<bool>(mark) ? 1 : 0);
  const DerivativeReport report = check_derivatives(f, view(x), options);
  return py::make_tuple(dict_of(report.gradient), dict_of(report.hessian));
}

py::dict curve_of(const ObservedIteration& self, double c, int samples) {
  constexpr int kMostSamples = 100'000;  // each evaluates E
  if (samples < 2 || samples > kMostSamples)
    throw InvalidInput("samples = " + std::to_string(samples) + "; must be from 2 to " + std::to_string(kMostSamples));
  std::vector<CurvePoint> points;
  {
    const LiveIteration& live = self.live();
    const Use use(self.objective->occupancy(), "iteration");
    const ReleasedGil free;
    points = curve_along(live, c, samples);
  }
  const auto column = [&](double CurvePoint::*member) {
    std::vector<double> values;
    for (const CurvePoint& p : points) values.push_back(p.*member);
    return to_array(values, {static_cast<py::ssize_t>(values.size())});
  };
  py::dict result;
  result["alpha"] = column(&CurvePoint::alpha);
  result["value"] = column(&CurvePoint::value);
  result["model"] = column(&CurvePoint::model);
  result["textbook_bound"] = column(&CurvePoint::textbook_bound);
  result["slide_bound"] = column(&CurvePoint::slide_bound);
  return result;
}

py::dict slice_of(const ObservedIteration& self, int samples) {
  if (samples < 2 || samples > 1000)
    throw InvalidInput("samples = " + std::to_string(samples) + "; must be from 2 to 1000");
  Slice slice;
  {
    const LiveIteration& live = self.live();
    const Use use(self.objective->occupancy(), "iteration");
    const ReleasedGil free;
    slice = slice_through(live, samples);
  }
  const auto table = [&](double SlicePoint::*member) {
    std::vector<double> values;
    for (const SlicePoint& p : slice.point) values.push_back(p.*member);
    return to_array(values, {slice.rows, slice.columns});
  };
  py::dict result;
  result["s"] = table(&SlicePoint::s);
  result["t"] = table(&SlicePoint::t);
  result["value"] = table(&SlicePoint::value);
  result["model"] = table(&SlicePoint::model);
  return result;
}

class TestFunctionOf : public Function {
 public:
  explicit TestFunctionOf(std::unique_ptr<PlanarFunction> f)
      : Function(f.get(), Layout{{2}}, std::make_shared<Callbacks>()), f_(std::move(f)) {}

 private:
  std::unique_ptr<PlanarFunction> f_;
};

py::list described_test_functions() {
  py::list list;
  for (const TestFunction& f : test_functions()) {
    py::dict entry;
    entry["name"] = f.name;
    entry["formula"] = f.formula;
    entry["remarks"] = f.remarks;
    entry["minimizer"] = to_array(f.minimizer, {2});
    entry["minimum"] = f.minimum;
    entry["start"] = to_array(f.start, {2});
    entry["lower"] = to_array(f.lower, {2});
    entry["upper"] = to_array(f.upper, {2});
    list.append(entry);
  }
  return list;
}

void bind_iteration(py::module_& m) {
  using It = ObservedIteration;
  py::class_<It, std::shared_ptr<It>>(m, "Iteration",
                                      "An iteration of a minimization. Vectors are available inside the observer only.")
      .def_readonly("index", &It::index, "From 0.")
      .def_readonly("value", &It::value, "E before the step.")
      .def_readonly("gradient_norm", &It::gradient_norm, "|g| before the step.")
      .def_readonly("decrement", &It::decrement, "Newton decrement -g.d / 2.")
      .def_readonly("alpha", &It::alpha, "Accepted step length; 0: none.")
      .def_readonly("trials", &It::trials,
                    "A row per trial of the line search: alpha, value, bound, accepted, by_slope.")
      .def_readonly("fallbacks", &It::fallbacks, "Fallbacks to a more cautious direction.")
      .def_readonly("gradients", &It::gradients, "Evaluations of the gradient.")
      .def_property_readonly(
          "work",
          [](const It& it) {
            py::dict work;
            work["hessians"] = it.direction.hessians;
            work["projected"] = it.direction.projected;
            work["projected_elements"] = it.direction.projected_elements;
            work["factorizations"] = it.direction.factorizations;
            work["linear_iterations"] = it.direction.linear_iterations;
            work["products"] = it.direction.products;
            work["cycles"] = it.direction.cycles;
            return work;
          },
          "Hessians, modified elements, factorizations, iterations and products of the linear solver.")
      .def_property_readonly("projected_elements", [](const It& it) { return it.direction.projected_elements; })
      .def_readonly("E", &It::objective, "The objective.")
      .def_property_readonly("x", [](const It& it) { return it.out(it.live().x); })
      .def_property_readonly("g", [](const It& it) { return it.out(it.live().g); })
      .def_property_readonly("d", [](const It& it) { return it.out(it.live().d); })
      .def_property_readonly("x_next", [](const It& it) { return it.out(it.live().x_next); })
      .def("curve", &curve_of, py::arg("c") = 1e-4, py::arg("samples") = 101,
           "Samples E along d: alpha, value, the quadratic model, and the bounds of both decrease tests.")
      .def("slice", &slice_of, py::arg("samples") = 41,
           "Samples E on the plane x + s d + t v: arrays s, t, value and model.");
}

}  // namespace

void bind_optimize(py::module_& m) {
  py::class_<Function, std::shared_ptr<Function>>(m, "Objective", "A function E(x) with its derivatives.")
      .def(
          "__call__", [](Function& f, const py::object& x) { return f.value(x); }, py::arg("x"),
          "E(x); inf where E is not defined.")
      .def(
          "value", [](Function& f, const py::object& x) { return f.value(x); }, py::arg("x"))
      .def(
          "gradient", [](Function& f, const py::object& x) { return f.gradient(x); }, py::arg("x"),
          "dE/dx, in the shape of x.")
      .def(
          "hessian", [](Function& f, const py::object& x, const std::string& kind) { return f.hessian(x, kind); },
          py::arg("x"), py::arg("definiteness") = "exact",
          "d2E/dx2. 'clamped' and 'absolute' modify negative eigenvalues of element Hessians.")
      .def(
          "max_step", [](Function& f, const py::object& x, const py::object& d) { return f.max_step(x, d); },
          py::arg("x"), py::arg("d"), "Largest alpha for which contact allows the path from x to x + alpha d.")
      .def_property_readonly("round_off", &Function::round_off, "Bound of the rounding error of the last E(x).")
      .def_property_readonly("shape", [](const Function& f) { return py::tuple(py::cast(f.layout().shape)); });
  py::class_<PythonFunction, Function, std::shared_ptr<PythonFunction>>(m, "PythonObjective")
      .def(py::init(&PythonFunction::make), py::arg("f"), py::arg("x"));
  bind_iteration(m);
  m.def("test_function", [](const std::string& name) -> std::shared_ptr<Function> {
    return std::make_shared<TestFunctionOf>(make_test_function(name));
  });
  m.def("test_functions", &described_test_functions);
  m.def("minimize", &minimize_function);
  m.def("check_derivatives", &check_python_derivatives);
  m.def("minimizer_names", &minimizer_names);
}

}  // namespace aspic::python
