#include "dynamics/share.h"

#include <algorithm>
#include <cmath>

namespace aspic {

double Share::sum(double own) const {
  sum({&own, 1});
  return own;
}

double Share::max(double own) const {
  if (is_whole()) return own;
  const std::vector<double> all = ranks_->gather({&own, 1});  // in one order, so that NaN has the same effect on all
  return *std::max_element(all.begin(), all.end());
}

double Share::min(double own) const { return is_whole() ? own : -max(-own); }

double Share::norm(double own) const { return is_whole() ? own : std::sqrt(sum(own * own)); }

void Share::sum(std::span<double> own) const {
  if (is_whole()) return;
  const std::vector<double> all = ranks_->gather(own);
  std::fill(own.begin(), own.end(), 0.0);
  for (size_t i = 0; i < all.size(); ++i) own[i % own.size()] += all[i];
}

void Share::find_largest(double& value, int& vertex) const {
  if (is_whole()) return;
  const double own[] = {value, vertex < 0 ? -1.0 : in_whole(vertex)};
  const std::vector<double> all = ranks_->gather(own);
  value = 0, vertex = -1;
  for (size_t i = 0; i < all.size(); i += 2)
    if (all[i + 1] >= 0 && (vertex < 0 || all[i] > value)) value = all[i], vertex = static_cast<int>(all[i + 1]);
}

}  // namespace aspic
