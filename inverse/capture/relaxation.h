// Relaxation times of a data set with histories, after the fit of its material.
#pragma once
#include "capture/fit_run.h"

namespace aspic {

// Multiplies the stiffness of a result, with its predictions. Returns false without an equilibrium.
using MultiplyStiffness = std::function<bool(double factor, FitOutcome& outcome)>;

// Adds the branches to the outcome, and multiplies its stiffness by the factor that they imply.
void add_relaxation(const DataSet& data, const FitCallbacks& callbacks, const MultiplyStiffness& multiply_stiffness,
                    FitOutcome& outcome);

// [[body.viscoelastic]] sections of a scene with the fitted branches.
std::string scene_text(const RelaxationFit& fit);

}  // namespace aspic
