// Flops per tet for the kernels of each material, by the formulas in element_flops.cpp.
#pragma once
#include <string>

namespace aspic::bench {

struct ElementFlops {
  double value = 0, gradient = 0, hessian = 0, definite_test = 0;
};
ElementFlops element_flops(const std::string& material);

}  // namespace aspic::bench
