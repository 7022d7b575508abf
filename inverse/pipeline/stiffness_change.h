// Change of a fitted material by a factor of the stiffness that histories determine after the fit of static cases.
#pragma once
#include <optional>
#include <vector>

#include "estimate/uncertainty.h"
#include "model/misfit.h"

namespace aspic {

// To first order, histories measure the combination s = g'p of the parameters, a change of log stiffness. With the
// posterior covariance C of the static cases, p changes by C g / (g'C g) per unit of s, and the standard deviation of s
// is (g'C g)^(1/2).
struct StiffnessChange {
  std::vector<double> g;
  std::vector<double> p;  // per unit of s
  double sigma = 0;       // of s, before the histories

  // Whether g differs by more than 5 %.
  bool differs_from(const StiffnessChange& other) const;
};

// g is the gradient of the common factor of all stiffnesses that has the most similar effect on the readings of `ends`,
// the last states of the histories. Returns nothing if they do not depend on the stiffness or have no equilibrium.
std::optional<StiffnessChange> stiffness_change(const Experiment& ends, const FittedField& fitted, Gaussian& posterior,
                                                const EquilibriumOptions& equilibrium);

// Reduces the standard deviations of the posterior: after the histories, that of s is `sigma`.
void narrow(const StiffnessChange& change, const ParameterMap& map, double sigma, Posterior& posterior);

}  // namespace aspic
