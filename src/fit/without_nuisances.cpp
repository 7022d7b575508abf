#include "fit/without_nuisances.h"

#include <cmath>

namespace aspic {

bool WithoutNuisances::linearize() {
  if (!data_.linearize()) return false;
  directions_ = Columns(residual_count());
  std::vector<double> dr(residual_count());
  for (int k = 0; k < data_.nuisance_count(); ++k) {
    data_.nuisance(k, dr);
    const double length = std::sqrt(dot(dr, dr));
    for (int pass = 0; pass < 2; ++pass) project(dr);
    const double rest = std::sqrt(dot(dr, dr));
    if (!(rest > 1e-10 * length)) continue;
    for (double& value : dr) value /= rest;
    directions_.push_back(dr);
  }
  return true;
}

void WithoutNuisances::multiply(std::span<const double> dp, std::span<double> dr) {
  data_.multiply(dp, dr);
  project(dr);
}

void WithoutNuisances::multiply_transposed(std::span<const double> w, std::span<double> pbar) {
  std::vector<double> rest(w.begin(), w.end());
  project(rest);
  data_.multiply_transposed(rest, pbar);
}

void WithoutNuisances::project(std::span<double> r) const {
  add_product(directions_, product_transposed(directions_, r), -1, r);
}

}  // namespace aspic
