// Relaxation times of a data set with histories, after the fit of its material.
#pragma once
#include "pipeline/fit_state.h"

namespace aspic {

// Adds the branches to the outcome of a fit, and multiplies its stiffness by the factor that they imply.
void add_relaxation(FitState& state);

// [[body.viscoelastic]] sections of a scene with the fitted branches.
std::string scene_text(const RelaxationFit& fit);

}  // namespace aspic
