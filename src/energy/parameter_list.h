// The parameters of the tets of a term, without the entries of MaterialParameters::extra that its material does not
// use: most materials use none.
#pragma once
#include <algorithm>
#include <span>
#include <vector>

#include "base/check.h"
#include "material/registry.h"

namespace aspic {

class ParameterList {
 public:
  // per_tet: mu, lambda and the used entries of `extra`
  ParameterList(std::span<const MaterialParameters> parameters, int per_tet)
      : width_(static_cast<size_t>(per_tet)), values_(width_ * parameters.size()) {
    set(parameters);
  }

  size_t size() const { return values_.size() / width_; }
  MaterialParameters operator[](size_t tet) const {
    const double* own = &values_[width_ * tet];
    MaterialParameters p{{own[0], own[1]}};
    std::copy(own + 2, own + width_, p.extra.begin());
    return p;
  }
  std::vector<MaterialParameters> all() const {
    std::vector<MaterialParameters> list;
    list.reserve(size());
    for (size_t t = 0; t < size(); ++t) list.push_back((*this)[t]);
    return list;
  }

  // One per tet, as at the construction.
  void set(std::span<const MaterialParameters> parameters) {
    ASPIC_CHECK(parameters.size() == size());
    double* own = values_.data();
    for (const MaterialParameters& p : parameters) {
      own[0] = p.lame.mu, own[1] = p.lame.lambda;
      std::copy_n(p.extra.begin(), width_ - 2, own + 2);
      own += width_;
    }
  }

 private:
  size_t width_;
  std::vector<double> values_;
};

}  // namespace aspic
