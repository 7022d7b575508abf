// What the data do not say, by Laplace's approximation: the posterior of p about the fit is the normal distribution
// with the covariance (J'J + weight R'')^-1. docs/fitting.md says where that fails.
#pragma once
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "fit/least_squares.h"
#include "fit/marginals.h"
#include "fit/parameter_map.h"
#include "fit/regularizer.h"
#include "fit/spectrum.h"

namespace aspic {

struct Direction {
  double information = 0;  // prior variance / posterior variance - 1 along it: < 1 is unseen by the data
  double deviation = 0;    // posterior standard deviation along it: root mean square over the body, as it is fitted
  std::vector<double> p;   // of unit length in the prior's norm
  std::string words;       // "young of the whole body"
};

struct PosteriorOptions {
  SpectrumOptions spectrum;
  MarginalOptions marginals;
  int directions = 3;  // number of reported directions
};

struct Posterior {
  bool ok = false;                             // false: only `warnings` says something
  std::vector<std::vector<double>> deviation;  // of each unknown in each tet, as it is fitted (log E)
  std::vector<std::vector<double>> reduction;  // 1 - posterior / prior variance: 0 nothing was learnt, 1 all
  double deviation_error = 0;                  // largest relative standard error of `deviation`; 0: it is exact
  double informed = 0;                         // how many directions the data determine: sum of d / (1 + d)
  std::vector<Direction> seen, unseen;         // the best determined; those in which most uncertainty is left
  bool scale_is_unknown = false;               // no force, weight or pressure: only ratios of stiffness are known
  double noise_factor = 1;                     // scatter of the measurements relative to their standard deviations
  double applied_factor = 1;                   // by which the deviations were raised for that
  double suggested_weight = 0;                 // of the regularizer, by what was learnt; 0: none
  double log_evidence = 0;                     // of the data under the weight, up to a constant
  std::vector<std::string> warnings;           // in words, for people
  std::shared_ptr<PosteriorGaussian> belief;
};

// Evaluates and linearizes `data` at the p of the fit; with tips, a Misfit WithUncertainLayers, made for this. The
// posterior's `belief` refers to the prior.
Posterior posterior(LeastSquares& data, Regularizer& prior, double weight, const ParameterMap& map, const TetMesh& mesh,
                    std::span<const double> p, const PosteriorOptions& options = {});

inline constexpr double kDeviations95 = 1.959964;  // of a normal number, on both sides: 95 %

struct Interval {
  double lower = 0, upper = 0;  // SI units
};
// Where a quantity in a tet lies with the probability of +-`deviations` of a normal number.
Interval interval(const Posterior& posterior, const ParameterMap& map, std::span<const double> p, int unknown, int tet,
                  double deviations = kDeviations95);

// "young between 80 and 130 kPa", "poisson between 0.41 and 0.46".
std::string words_of_interval(const Unknown& unknown, const Interval& interval);

}  // namespace aspic
