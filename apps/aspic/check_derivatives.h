#pragma once
#include <filesystem>

#include "scene/scene.h"

namespace aspic::cli {

struct CheckDerivativesOptions {
  std::filesystem::path plot;  // empty: no plot
  double tolerance = 1e-6;
  bool json = false;
};

// Compares derivatives of every term of the scene's next step with differences. Prints, and returns the exit code.
int check_derivatives(const Scene& scene, const CheckDerivativesOptions& options);

}  // namespace aspic::cli
