// Selects the next indentation: for each candidate on the free surface, the additional information of its measurements,
//   gain = 1/2 log det(I + J C J')    [nats]
// with J the derivatives of the candidate's residuals at the fit, over their standard deviations, and C the posterior
// covariance: their mutual information, exact for linear residuals [Lindley 1956; Chaloner 1995].
#pragma once
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "fit/misfit.h"
#include "fit/uncertainty.h"

namespace aspic {

struct NextIndentationOptions {
  int sites = 24;                    // candidates, as far apart as possible
  std::optional<Indenter> indenter;  // default: that of the experiment
  double depth = 0;                  // depth of the indentation [m]; 0: maximum so far
  SpectrumOptions spectrum{.dense = 64, .max_rank = 48};
  EquilibriumOptions equilibrium = {};
};

struct IndentationCandidate {
  int vertex = 0;
  Vec3d site{}, inward{};  // at rest [m]; unit vector
  LoadCase load;           // indenter, touch, pose and readings; measured values are 0
  bool ok = false;
  std::string failure;                     // why it has no result
  double gain = 0;                         // [nats]
  std::vector<std::vector<double>> sigma;  // sigma of each parameter in each tet, with this indentation
  std::string
      description;  // "at (0, 0.1, 0.02) m: young around ..., known within a factor of 1.9, would be within 1.2"
};

struct NextIndentation {
  std::vector<IndentationCandidate> candidates;  // best first, then failed ones
  std::vector<double> gain;                      // per surface vertex, from the candidates around it [nats]; 0 inside
  std::vector<std::string> warnings;
};

// At the fit of `posterior`. `mesh`: mesh of the map, which is that of the experiment or its unrefined mesh. Throws
// InvalidInput without an indenter.
NextIndentation next_indentation(const Experiment& experiment, const FittedField& fitted, Posterior& posterior,
                                 const NextIndentationOptions& options = {});

// `count` sites for an indenter of this radius: free surface vertices where the surface is about flat over its
// width, each as far as possible from the previous ones.
struct IndentationSite {
  int vertex = 0;
  Vec3d inward{};
};
std::vector<IndentationSite> indentation_sites(const TetMesh& mesh, std::span<const int> fixed, double radius,
                                               int count);

}  // namespace aspic
