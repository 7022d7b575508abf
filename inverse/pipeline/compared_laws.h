// Laws of a comparison, and the plans of their fits.
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "pipeline/fit_plan.h"
#include "pipeline/law_choice.h"

namespace aspic {

// An own parameter of a law: prior mean and its standard deviation on the fitted scale, and initial guesses.
struct OwnParameter {
  std::string name;
  double mean, sigma;
  std::vector<double> guesses;
};

struct Law {
  std::string name;
  std::vector<OwnParameter> own;
  std::vector<std::pair<std::string, double>> known;
};

const std::vector<Law>& compared_laws();

FitPlan with_law(FitPlan plan, const Law& law);

// The plan of the comparison: fields per tet and at handles become one value, or one per region. `what`, if not null:
// what replaces them; unchanged without fields.
FitPlan simplified(FitPlan plan, const TetMesh& mesh, std::string* what = nullptr);

// Plan of the fit with the chosen law.
FitPlan plan_with_law(const FitPlan& plan, const LawChoice& choice);

}  // namespace aspic
