// Stages of a fit, in the order of fit_material(). Each computes from the state and stores its results there. Those
// that return a bool return false if no further stage is possible.
#pragma once
#include <span>
#include <string>
#include <vector>

#include "pipeline/fit_state.h"

namespace aspic {

// Directions of the fibres, as reference directions of the plan.
bool find_fibres(FitState& state);

// One value per quantity explains most of the data and is the initial guess of fields.
bool fit_single_values(FitState& state, const std::string& name);

// Errors of mesh and law for the last material. The data remain unchanged if they are unknown. False: none, or stopped.
bool correct_model_errors(FitState& state);

// The material of the plan with its results, or one value if the data do not support a field.
void fit_fields(FitState& state);

// Results of fit_fields().
void quantify_uncertainty(FitState& state);
// Values in parts if requested and supported by the data; otherwise those of the field.
std::vector<double> divided_into_parts(FitState& state);
// The material of p, its values for display, and predictions for the fitted cases.
void describe(FitState& state, FitModel& model, std::span<const double> p);
// Directions at p with their cones.
std::vector<FoundFibres> found_fibres(const FitState& state, const ParameterMap& map, std::span<const double> p);
void predict_left_out(FitState& state);
// Computes the jobs of the cross-validation, which other processes share.
void compute_held_out_jobs(FitState& state);
void cross_validate_groups(FitState& state);

}  // namespace aspic
