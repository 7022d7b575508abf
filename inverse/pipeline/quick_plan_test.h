// Measurements of a block and a plan that fits them quickly.
#pragma once
#include <string>
#include <vector>

#include "pipeline/fit_run.h"
#include "pipeline/indented_block_test.h"

namespace aspic {

inline const DataSet& block() {
  static const DataSet data = measured_block(3);
  return data;
}

inline FitPlan quick_plan(const std::vector<std::string>& parameters = {"young=regions"}) {
  FitPlan plan;
  for (const std::string& text : parameters) plan.parameters.push_back(parse_parameter(text));
  plan.known = {{"poisson", 0.4}};
  plan.uncertainty = plan.cross_validation = false;
  return plan;
}

}  // namespace aspic
