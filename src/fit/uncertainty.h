// What the data do not say, by Laplace's approximation: the posterior of p about the fit is the normal distribution
// with the covariance (J'J + weight R'')^-1.
#pragma once
#include <span>
#include <string>
#include <vector>

#include "fit/least_squares.h"
#include "fit/parameter_map.h"
#include "fit/regularizer.h"

namespace aspic {

struct Direction {
  double information = 0;  // eigenvalue of the data's Hessian against the prior's: < 1 is unseen by the data
  std::vector<double> p;   // of unit length in the prior's norm
  std::string words;       // "log E of all tets together"
};

struct Posterior {
  std::vector<std::vector<double>> deviation;  // of each unknown in each tet, as it is fitted (log E)
  std::vector<std::vector<double>> reduction;  // 1 - posterior / prior variance: 0 nothing was learnt, 1 all
  double informed = 0;                         // how many directions the data determine: sum of d / (1 + d)
  std::vector<Direction> seen, unseen;         // the best determined, the least
  bool scale_is_unknown = false;               // no force, weight or pressure: only ratios of stiffness are known
  std::vector<std::string> warnings;           // in words, for people
};

// At the p of the fit, where `misfit` is linearised.
Posterior posterior(LeastSquares& misfit, Regularizer& prior, double weight, const ParameterMap& map,
                    std::span<const double> p);

}  // namespace aspic
