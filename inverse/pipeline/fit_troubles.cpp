#include "pipeline/fit_troubles.h"

#include <algorithm>
#include <cmath>

#include "estimate/fit_run.h"
#include "model/limits.h"
#include "scene/value.h"

namespace aspic {
namespace {

constexpr double kSoftest = 1e-2, kStiffest = 1e13;  // Young's moduli [Pa]: below weak gels, above diamond

}  // namespace

std::string describe_runaway(const DataSet& data, const MaterialParameters& material) {
  const double young = young_modulus(material.lame);
  if (young >= kSoftest && young <= kStiffest) return "";
  const std::vector<LoadCase>& cases = data.experiment.cases;
  const bool has_positions =
      std::any_of(cases.begin(), cases.end(), [](const LoadCase& c) { return !c.positions.empty(); });
  return "the readings do not determine the stiffness: it is " + three_digits(young) + " Pa; check the units of " +
         (has_positions ? "lengths and forces" : "lengths and forces, and give positions of some markers") +
         ", and that loads and readings belong to the same body";
}

std::string describe_failure(const DataSet& data, const FitReport& report, const std::string& why) {
  const auto is_named = [&](const LoadCase& c) {
    return why.starts_with(c.name + ",") || why.starts_with(c.name + ":");
  };
  const std::vector<LoadCase>& cases = data.experiment.cases;
  const auto found = std::find_if(cases.begin(), cases.end(), is_named);
  if (found == cases.end())
    return report.message + (why.empty() ? "" : " (" + why + ")") + "; aspic check lists suspicious rows";
  return report.message + "\n" + data.source.load_case(static_cast<int>(found - cases.begin())) + ": " +
         why.substr(0, why.find("; ")) + "; check its load and its pose, or remove the row";
}

std::string describe_worst_row(const DataSet& data, const std::vector<std::string>& left_out, const Misfit& misfit,
                               std::span<const double> r) {
  const double count = static_cast<double>(r.size()), typical = dot(r, r) / count;
  if (!(typical > std::max(kTooManySquares, 1 + 5 * std::sqrt(2 / count)))) return "";
  double worst = 0;
  int worst_case = 0, fitted = 0;
  for (size_t c = 0; c < data.experiment.cases.size(); ++c) {
    if (is_left_out(left_out, data.experiment.cases[c])) continue;
    const auto [first, number] = misfit.residuals_of(fitted++);
    const std::span<const double> own = r.subspan(first, number);
    const double mean = number > 0 ? dot(own, own) / number : 0;
    if (mean > worst) worst = mean, worst_case = static_cast<int>(c);
  }
  return data.source.load_case(worst_case) + " ('" + data.experiment.cases[worst_case].name +
         "') has the worst fit: its readings are missed by " + std::to_string(std::lround(std::sqrt(worst))) +
         " standard deviations; check this row, or give standard deviations that cover the errors of mesh and model";
}

}  // namespace aspic
