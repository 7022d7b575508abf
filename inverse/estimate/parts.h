// Divides a field into parts: a few values and their locations.
#pragma once
#include <span>
#include <vector>

#include "estimate/spectrum.h"
#include "mesh/tet_mesh.h"
#include "model/least_squares.h"
#include "model/parameter_map.h"

namespace aspic {

// Posterior of a body of a few materials, each of one stiffness, with unknown locations, for a linearized model. Gibbs
// sampling [Geman and Geman 1984] of
//   exp(-|r|^2 / 2 - penalty * A),  A = sum over faces between unlike tets of (area / mean area),
// with |r|^2 in the directions determined by the data. The mean is the best estimate in mean square. Tets near an
// interface get intermediate values and larger standard deviations.
//
// Data often determine the product of stiffness and volume of an inclusion far better than either factor. Then the
// penalty on A makes inclusions too small and too stiff. A quarter of the samples therefore uses a second prior, which
// penalizes only the excess of A over that of the same shape at another size; it makes inclusions too large and too
// soft. The mean lies between both, and their difference is part of the standard deviation.
struct PartsOptions {
  int passes = 5;     // linearizations
  int rank = 400;     // maximum directions of the last one; a quarter of that before
  int sweeps = 1000;  // over all tets, per linearization and prior, after a quarter as many for burn-in
  unsigned seed = 3;
};

struct PartsEstimate {
  // Mean and sigma of z in each part, ascending: over the samples, weighted by the volume of the part. Without weights,
  // samples of tiny parts of extreme stiffness would count as much as those of large ones.
  std::vector<double> levels, level_sigma;
  double contrast_sigma = 0;               // standard deviation of levels.back() - levels.front()
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

struct Parts {
  bool ok = false;  // false: no equilibrium, or the field clusters at fewer values
  PartsEstimate estimate;
  std::vector<double> p;  // for the field's map, with `estimate.mean`
  double squares = 0;     // |r|^2 there
};

// Finds `count` parts of `parameter`, a value per tet, starting from the clusters of the field p. Each pass linearizes
// the model at the mean of the previous samples; the change of the last pass increases all standard deviations.
Parts find_parts(LeastSquares& model, const FittedField& field, int parameter, int count,
                 const PartsOptions& options = {});

// Whether the parts fit the measurements about as well as the field, with |r|^2 = `field_squares`, or within the noise.
bool are_as_good(const Parts& parts, double field_squares, int residuals);

}  // namespace aspic
