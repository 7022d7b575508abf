// A body of few materials, each of one stiffness, whose places are not known: what the data say of both, about a point
// where the model is linearized. Samples are drawn by Gibbs' method [Geman and Geman 1984] from
//   exp(-|r|^2 / 2 - surface * sum over faces between unlike tets of (area / mean area)),
// |r|^2 in the directions that the data see. Their mean is the best estimate in mean square; tets near an interface get
// a value between those of both sides, and a deviation that says so.
#pragma once
#include <span>
#include <vector>

#include "fit/spectrum.h"
#include "mesh/tet_mesh.h"

namespace aspic {

struct PartsOptions {
  int passes = 3;        // linearizations
  int rank = 400;        // directions of the last one, at most; a quarter as many of those before
  int sweeps = 1000;     // over all tets, per linearization, after a quarter as many that are thrown away
  double surface = 1.2;  // per face between unlike tets, of mean area [nats]: a speck of one tet costs four of these
  unsigned seed = 3;
};

struct PartsEstimate {
  std::vector<double> levels;              // of z, ascending: mean over the samples
  std::vector<std::vector<double>> share;  // of each part in each tet: how often it belonged to it
  std::vector<double> mean, deviation;     // of z in each tet
};

// The values about which z gathers, by volume, ascending: k-means in one dimension. Fewer, where some coincide.
std::vector<double> gathered_levels(std::span<const double> z, std::span<const double> volume, int count);

// `spectrum` and `gradient` (J'r) where the model was linearized; z are the entries from `first` on there, one per tet,
// and all else stays. `noise_factor`: by which standard deviations are raised.
PartsEstimate sample_parts(const TetMesh& mesh, const Spectrum& spectrum, std::span<const double> gradient, int first,
                           std::span<const double> z, std::vector<double> levels, double noise_factor,
                           const PartsOptions& options);

}  // namespace aspic
