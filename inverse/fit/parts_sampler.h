// Posterior of a body of a few materials, each of one stiffness, with unknown locations, for a linearized model. Gibbs
// sampling [Geman and Geman 1984] of
//   exp(-|r|^2 / 2 - surface * sum over faces between unlike tets of (area / mean area)),
// with |r|^2 in the directions determined by the data. The mean is the best estimate in mean square. Tets near an
// interface get intermediate values and larger standard deviations.
#pragma once
#include <span>
#include <vector>

#include "fit/spectrum.h"
#include "mesh/tet_mesh.h"

namespace aspic {

struct PartsOptions {
  int passes = 3;        // linearizations
  int rank = 400;        // maximum directions of the last one; a quarter of that before
  int sweeps = 1000;     // over all tets, per linearization, after a quarter as many for burn-in
  double surface = 1.2;  // penalty per face of mean area between unlike tets [nats]; a single tet has four
  unsigned seed = 3;
};

struct PartsEstimate {
  std::vector<double> levels;              // values of z, ascending: mean over the samples
  std::vector<std::vector<double>> share;  // share of each part in each tet: relative frequency
  std::vector<double> mean, sigma;         // mean and sigma of z in each tet
};

// Clusters of z by volume, ascending: k-means in one dimension. Fewer if some coincide.
std::vector<double> gathered_levels(std::span<const double> z, std::span<const double> volume, int count);

// A field of one value per tet and its linearized model. All other parameters are constant.
struct LinearizedField {
  const TetMesh& mesh;
  const Spectrum& spectrum;          // spectrum of the linearization
  std::span<const double> gradient;  // J'r
  int first;                         // entry of the parameters at which the field begins
  std::span<const double> z;         // the field, one value per tet
  double noise_factor;               // multiplies standard deviations
};

// Samples labels and levels from the initial `levels`.
PartsEstimate sample_parts(const LinearizedField& field, std::vector<double> levels, const PartsOptions& options);

}  // namespace aspic
