#pragma once
#include <filesystem>

#include "scene/scene.h"

namespace aspic::cli {

struct CheckDerivativesOptions {
  std::filesystem::path plot;  // empty: none
  double tolerance = 1e-6;
  bool json = false;
};

// Prints how the derivatives of every term of the scene's next step compare with differences. Returns the exit code.
int check_derivatives(const Scene& scene, const CheckDerivativesOptions& options);

}  // namespace aspic::cli
