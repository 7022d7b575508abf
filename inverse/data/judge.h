// Compares a fitted material with the truth of synthetic data.
#pragma once
#include <string>
#include <vector>

#include "scene/material_file.h"

namespace aspic {

// Part of the body with one true value.
struct Phase {
  double share = 0;   // fraction of the body's volume
  double truth = 0;   // [SI]
  double fitted = 0;  // mean over the tets inside it (or partly inside, if none is), geometric for positive quantities
};

// Errors by volume over the tets of the fit, of z = log q for positive quantities and z = q for Poisson's ratio. In a
// tet with varying truth, z is averaged.
struct Judgment {
  std::string quantity;
  bool is_log = true;          // errors are those of log q
  double error = 0;            // root mean square of z - truth: 0.15 is 15 % of E
  double relative_error = -1;  // error over the root mean square of the truth about its mean; < 0: the truth is uniform
  double largest = 0;          // |z - truth|
  double level = 0;            // mean of z - truth
  double coverage = -1;        // fraction of tets whose 95 % interval contains the truth; < 0: no intervals
  std::vector<Phase> phases;   // by ascending truth; empty: the truth varies smoothly
  double overlap = -1;         // intersection over union for the smaller of two phases; < 0: not two phases

  // Ratio of the highest to the lowest phase; 1 unless there are two or more.
  double contrast() const { return phases.size() < 2 ? 1 : phases.back().fitted / phases.front().fitted; }
  double true_contrast() const { return phases.size() < 2 ? 1 : phases.back().truth / phases.front().truth; }
};

// Values of a piecewise constant field, ascending; empty if there are more than a few.
std::vector<double> levels_of(std::vector<double> values);

// Compares each quantity in both materials, except the density. The threshold of [Otsu 1979] separates the fitted
// inclusion from the rest of the body, without using the truth.
std::vector<Judgment> judge(const FittedMaterial& fitted, const FittedMaterial& truth);

}  // namespace aspic
