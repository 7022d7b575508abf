#include "model/predictions.h"

#include "base/parallel.h"
#include "model/load_case.h"
#include "model/unloaded_shape.h"

namespace aspic {

Predictions predicted(const Experiment& given, const std::string& material,
                      std::span<const MaterialParameters> parameters, const EquilibriumOptions& options,
                      const Predictions& start) {
  Predictions result;
  const UnloadedShape shape = unloaded(given, material, parameters, options);
  if (!shape.experiment) return {{}, shape.failure};
  const Experiment& experiment = *shape.experiment;
  const int count = static_cast<int>(experiment.cases.size());
  result.cases.resize(count);
  std::vector<std::string> failures(count);
  std::vector<int> begin;
  for (int c = 0; c < count; ++c)
    if (c == 0 || experiment.cases[c].group.empty() || experiment.cases[c].group != experiment.cases[c - 1].group)
      begin.push_back(c);
  begin.push_back(count);
  parallel_for(static_cast<int>(begin.size()) - 1, [&](int g) {
    std::vector<double> last;
    for (int c = begin[g]; c < begin[g + 1]; ++c) {
      LoadedBody body(experiment, experiment.cases[c], material, parameters, options);
      const bool has_start = c < static_cast<int>(start.cases.size()) && !start.cases[c].x.empty();
      if (!body.solve(parameters, has_start ? start.cases[c].x : last)) {
        failures[c] = body.failure();
        return;
      }
      result.cases[c] = body.prediction();
      last = result.cases[c].x;
    }
  });
  for (const std::string& failure : failures)
    if (!failure.empty()) result.failure += (result.failure.empty() ? "" : "; ") + failure;
  return result;
}

}  // namespace aspic
