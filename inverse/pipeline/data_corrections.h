// Corrections of the data that depend on the fit: systematic errors, and weights of a robust loss.
#pragma once
#include <span>
#include <vector>

#include "pipeline/fit_model.h"

namespace aspic {

class DataCorrections {
 public:
  // Estimates errors and weights at p. Returns the largest change: of an error in standard deviations of its prior, or
  // of a weight.
  double estimate(FitModel& model, std::span<const double> p, const SimulatedData& simulated, bool is_robust);
  void apply(SimulatedData& simulated) const { simulated.correct(errors_, weights_); }

 private:
  std::vector<double> errors_, steps_;
  std::vector<CaseWeights> weights_;
};

// Estimates of the corrected errors at p. `posterior`: of the same fit; null: unknown.
std::vector<EstimatedError> estimated_errors(WithUncertainLayers& about_fit, std::span<const double> p,
                                             const SimulatedData& simulated, const Measured& measured,
                                             const Posterior* posterior);
// The same for common errors, from residuals r.
std::vector<FoundCommonError> common_errors(const SimulatedData& simulated, const WithUncertainLayers& about_fit,
                                            std::span<const double> r);
std::vector<Outlier> outliers(const SimulatedData& simulated, const DataSet& data);

}  // namespace aspic
