// Where to poke next: for each candidate on the free surface, what its measurements would tell beyond those that exist,
//   gain = 1/2 log det(I + J C J')    [nats]
// with J the derivatives of the candidate's residuals at the fit, by their standard deviations, and C the posterior:
// the mutual information of the candidate and the material, exact for linear residuals [Lindley 1956; Chaloner 1995].
#pragma once
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "fit/misfit.h"
#include "fit/uncertainty.h"

namespace aspic {

struct NextPokeOptions {
  int sites = 24;          // candidates, as far from each other as can be
  std::optional<Tip> tip;  // else that of the experiment
  double depth = 0;        // how far the tip is pushed in [m]; 0: as far as the farthest so far
  SpectrumOptions spectrum{.dense = 64, .max_rank = 48};
};

struct PokeCandidate {
  int vertex = 0;
  Vec3d site{}, inward{};  // at rest [m]; of length 1
  LoadCase load;           // its tip, touch and pose, and what would be read; measured values are 0
  bool ok = false;
  std::string failure;                         // why nothing is known of it
  double gain = 0;                             // [nats]
  std::vector<std::vector<double>> deviation;  // of each unknown in each tet, after it
  std::string words;  // "at (0, 0.1, 0.02) m: young around ..., known within a factor of 1.9, would be within 1.2"
};

struct NextPoke {
  std::vector<PokeCandidate> candidates;  // the best first; then those that failed
  std::vector<double> gain;  // of each vertex of the surface, from the candidates around it [nats]; 0 inside
  std::vector<std::string> warnings;
};

// At the fit that `posterior` belongs to. `mesh`: of the map; that of the experiment, or what it was refined from.
// Throws InvalidInput without a tip.
NextPoke next_poke(const Experiment& experiment, const TetMesh& mesh, const ParameterMap& map, Posterior& posterior,
                   std::span<const double> p, const NextPokeOptions& options = {},
                   const EquilibriumOptions& equilibrium = {});

// Sites for a tip of that radius: vertices of the surface that are free, where the surface is about as flat as the tip
// is wide; `count` of them, each as far as can be from those before.
struct PokeSite {
  int vertex = 0;
  Vec3d inward{};
};
std::vector<PokeSite> poke_sites(const TetMesh& mesh, std::span<const int> fixed, double radius, int count);

}  // namespace aspic
