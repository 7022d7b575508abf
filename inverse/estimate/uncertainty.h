// Uncertainty of a fit by Laplace's approximation: the posterior of p is normal about the fit with covariance (J'J +
// weight R'')^-1. Limits: inverse/docs/fitting.md.
#pragma once
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "estimate/spectrum.h"
#include "model/least_squares.h"
#include "model/parameter_map.h"
#include "model/regularizer.h"

namespace aspic {

struct MarginalOptions {
  int exact = 3000;   // maximum number of values with one solve each
  int samples = 256;  // otherwise: samples of the undetermined part
  unsigned seed = 2;
};

// Prior and posterior variances of the fitted quantities in every tet.
struct Marginals {
  std::vector<std::vector<double>> prior,
      posterior;              // sigma of each parameter in each tet, on the fitted scale (log E)
  double relative_error = 0;  // largest standard error of a standard deviation; 0: exact
};

Marginals marginals(PosteriorGaussian& gaussian, const ParameterMap& map, const MarginalOptions& options = {});

struct PosteriorOptions {
  SpectrumOptions spectrum;
  MarginalOptions marginals;
};

struct Posterior {
  bool ok = false;                             // false: only `warnings` are valid
  std::vector<std::vector<double>> sigma;      // sigma of each parameter in each tet, on the fitted scale (log E)
  std::vector<std::vector<double>> reduction;  // 1 - posterior / prior variance: 0 no information, 1 complete
  double sigma_error = 0;                      // largest relative standard error of `sigma`; 0: exact
  double informed = 0;                         // number of directions determined by the data: sum of d / (1 + d)
  bool scale_is_unknown = false;               // no force, weight or pressure: only ratios of stiffness are determined
  double noise_factor = 1;                     // scatter of the measurements relative to their standard deviations
  double applied_factor = 1;                   // applied factor of the standard deviations
  double suggested_weight = 0;                 // weight of the regularizer supported by the data; 0: none
  double log_evidence = 0;                     // log evidence of the weight, up to a constant
  std::vector<std::string> warnings;           // messages for users
  // The entries of `warnings` about the misfit and about the weight of the regularizer; empty: none.
  std::string misfit_warning, weight_warning;
  std::shared_ptr<PosteriorGaussian> gaussian;
};

// Evaluates and linearizes `data` at the p of the fit; with indenters, data must be a Misfit WithUncertainLayers, made
// for this call. The posterior's `gaussian` refers to the prior.
Posterior posterior(LeastSquares& data, Regularizer& prior, double weight, const FittedField& fitted,
                    const PosteriorOptions& options = {});

inline constexpr double kSigmas95 = 1.959964;  // quantile of the normal distribution: 95 %, two-sided

struct TetQuantity {
  int parameter, tet;
};

struct Interval {
  double lower = 0, upper = 0;  // SI units
};
// Interval of a quantity in a tet with the probability of +-`sigmas` standard deviations.
Interval interval(const Posterior& posterior, const ParameterMap& map, std::span<const double> p, const TetQuantity& of,
                  double sigmas = kSigmas95);

}  // namespace aspic
