// Methods compared on one time step.
#include <pybind11/stl.h>

#include "base/error.h"
#include "bindings.h"
#include "dynamics/method_comparison.h"
#include "simulation.h"

namespace aspic::python {
namespace {

// The scene with the [solver] of each method.
using NamedSources = std::vector<std::pair<std::string, std::shared_ptr<SceneSource>>>;

py::dict trace_of(const std::vector<WorkPoint>& work) {
  const auto column = [&](auto member) {
    std::vector<double> values;
    for (const WorkPoint& point : work) values.push_back(static_cast<double>(point.*member));
    return to_array(values, {static_cast<py::ssize_t>(values.size())});
  };
  py::dict trace;
  trace["index"] = column(&WorkPoint::iteration);
  trace["value"] = column(&WorkPoint::value);
  trace["gradient_norm"] = column(&WorkPoint::gradient_norm);
  trace["gradients"] = column(&WorkPoint::gradients);
  trace["hessians"] = column(&WorkPoint::hessians);
  trace["seconds"] = column(&WorkPoint::seconds);
  return trace;
}

py::list compare(const SceneSource& source, const NamedSources& methods, int step, double max_seconds) {
  if (step < 1) throw InvalidInput("step: must be at least 1");
  const auto callbacks = std::make_shared<Callbacks>();
  ComparisonOptions options{.step = step, .max_seconds = max_seconds, .stop = callbacks->token()};
  for (const auto& [name, with_method] : methods) {
    if (!with_method) throw InvalidInput("methods: a scene is None");
    options.methods.push_back({name, with_method->model(callbacks).options.solver});
  }
  Scene scene = source.scene(callbacks);
  Comparison comparison;
  {
    const ReleasedGil free;
    comparison = compare_methods(scene.simulation, options);
  }
  callbacks->rethrow();
  py::list results;
  for (const MethodResult& result : comparison.results) {
    py::dict entry;
    entry["name"] = result.method;
    entry["report"] = named(result.report, scene.simulation);
    entry["trace"] = trace_of(result.work);
    entry["seconds"] = result.seconds;
    entry["distance"] = result.distance;
    entry["excess"] = result.excess;
    entry["same_minimizer"] = result.same_minimizer;
    entry["description"] = result.description;
    results.append(entry);
  }
  return results;
}

}  // namespace

void bind_compare(py::module_& m) {
  m.def(
      "compare",
      [](const std::shared_ptr<SceneSource>& source, const NamedSources& methods, int step, double max_seconds) {
        return compare(*source, methods, step, max_seconds);
      },
      py::arg().none(false), py::arg(), py::arg(), py::arg());
}

}  // namespace aspic::python
