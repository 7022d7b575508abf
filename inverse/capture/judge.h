// A fitted material against the true one, which synthetic data come with.
#pragma once
#include <string>
#include <vector>

#include "scene/material_file.h"

namespace aspic {

// Where the truth has one value.
struct Phase {
  double share = 0;   // of the body's volume
  double truth = 0;   // [SI]
  double fitted = 0;  // the mean over the tets that lie wholly in it (else partly), geometric for positive quantities
};

// Over the tets of the fit, by volume, of z = log q for positive quantities and z = q for Poisson's ratio. In a tet
// where the truth varies, it is the mean of its z.
struct Judgment {
  std::string quantity;
  double error = 0;            // root mean square of z - truth: 0.15 is 15 % of E
  double relative_error = -1;  // that by the root mean square of the truth about its mean; < 0: the truth is uniform
  double largest = 0;          // |z - truth|
  double level = 0;            // mean of z - truth
  double coverage = -1;        // of the tets, those whose 95 % interval holds the truth; < 0: no intervals
  std::vector<Phase> phases;   // by ascending truth; empty: the truth varies smoothly
  double overlap = -1;         // intersection over union, of the smaller of two phases; < 0: there are not two

  // The highest phase by the lowest; 1 where there are not two.
  double contrast() const { return phases.size() < 2 ? 1 : phases.back().fitted / phases.front().fitted; }
  double true_contrast() const { return phases.size() < 2 ? 1 : phases.back().truth / phases.front().truth; }
};

// The values of which a piecewise constant field is made, ascending; empty: it has more than a few.
std::vector<double> levels_of(std::vector<double> values);

// Of each quantity that both have, except the density. The fitted inclusion is separated from the rest of the body by
// the threshold of [Otsu 1979], which does not know the truth.
std::vector<Judgment> judge(const FittedMaterial& fitted, const FittedMaterial& truth);

}  // namespace aspic
