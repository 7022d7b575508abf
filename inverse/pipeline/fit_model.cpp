#include "pipeline/fit_model.h"

#include <utility>

#include "model/condensed_readings.h"

namespace aspic {

FitModel::FitModel(const Measured& data, const SimulatedData& simulated, const FitPlan& plan,
                   std::vector<FitParameter> parameters, const StoredModel& stored)
    : map(data.mesh, plan.model, known_parameters(plan, data), std::move(parameters)),
      prior(make_regularizer(data.mesh, map, plan.regularizer)),
      is_condensed(!plan.robust && has_dense_readings(simulated.fitted())),
      condensed(is_condensed ? aspic::condensed(simulated.fitted()) : Condensed{}),
      misfit(is_condensed ? static_cast<const Experiment&>(condensed) : simulated.fitted(), map, plan.equilibrium),
      simulated_(simulated),
      equilibrium_(plan.equilibrium) {
  if (const std::vector<double> x = simulated.equilibria(); !x.empty()) misfit.set_state(x);
  const FitMemory& memory = stored.memory;
  if (!memory.folder.empty()) {
    const ModelState state{[this] { return misfit.state(); },
                           [this](std::span<const double> x) { misfit.set_state(x); }};
    journal.emplace(misfit, state, memory.folder / (memory.prefix + stored.name), stored.fingerprint, memory.start);
  }
  with_layers.emplace(recorded());
}

Misfit& FitModel::of_all_readings() {
  if (!is_condensed) return misfit;
  whole_.emplace(simulated_.fitted(), map, equilibrium_);
  whole_->set_state(misfit.state());
  return *whole_;
}

}  // namespace aspic
