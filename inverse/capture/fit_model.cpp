#include "capture/fit_model.h"

namespace aspic {

FitModel::FitModel(const Experiment& data, const Experiment& simulated, const FitPlan& plan,
                   std::vector<FitParameter> parameters, const StoredModel& stored)
    : map(data.mesh, plan.model, known_parameters(plan, data), std::move(parameters)),
      prior(make_regularizer(data.mesh, map, plan.regularizer)),
      misfit(simulated, map, plan.equilibrium) {
  const FitMemory& memory = stored.memory;
  if (!memory.folder.empty()) {
    const ModelState state{[this] { return misfit.state(); },
                           [this](std::span<const double> x) { misfit.set_state(x); }};
    journal.emplace(misfit, state, memory.folder / stored.name, stored.fingerprint, memory.start);
  }
  with_layers.emplace(recorded());
}

}  // namespace aspic
