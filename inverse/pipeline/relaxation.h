// Relaxation times of a data set with histories, after the fit of its material.
#pragma once
#include "pipeline/material_fit.h"

namespace aspic {

// Adds the branches to the outcome of a fit, and multiplies its stiffness by the factor that they imply.
void add_relaxation(const DataSet& data, const FitCallbacks& callbacks, MaterialFit& material_fit, FitOutcome& outcome);

// [[body.viscoelastic]] sections of a scene with the fitted branches.
std::string scene_text(const RelaxationFit& fit);

}  // namespace aspic
