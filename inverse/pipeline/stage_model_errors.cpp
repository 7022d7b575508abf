#include "pipeline/fit_stages.h"

namespace aspic {
namespace {

void add_law_errors(FitState& state) {
  if (state.is_stopped()) return;
  state.begin(FitStage::mesh_errors, "differences between laws");
  const std::string failure = state.simulated.add_law_errors(state.plan, state.material);
  if (failure.empty()) return;
  state.warn("standard deviations do NOT include the choice of the law: with another one " + failure);
  state.plan.law_errors = false;
}

void subtract_mesh_errors(FitState& state) {
  if (state.is_stopped()) return;
  if (is_too_large_for_mesh_errors(state.simulated.mesh())) {
    state.warn("the discretization error was NOT computed: the simulated mesh has " +
               std::to_string(state.simulated.mesh().tet_count()) + " tets, and " +
               std::to_string(SimulatedData::kTooFine) +
               " are the maximum; the material includes this error (use a coarser mesh, or a smaller "
               "option refine)");
    state.plan.mesh_errors = false;
    return;
  }
  state.begin(FitStage::mesh_errors, "discretization error, by a mesh of eight times as many tets");
  const std::string failure = state.simulated.subtract_mesh_errors(state.plan, state.material);
  if (!failure.empty()) {
    state.warn("the discretization error was NOT computed: on the finer mesh " + failure);
    state.plan.mesh_errors = false;
    return;
  }
  state.outcome.has_mesh_errors = true;
  state.outcome.mesh_error = mesh_error(state.simulated);
}

}  // namespace

bool correct_model_errors(FitState& state) {
  if (state.plan.law_errors) add_law_errors(state);
  if (state.plan.mesh_errors) subtract_mesh_errors(state);
  return state.has_model_errors() && !state.is_stopped();
}

}  // namespace aspic
