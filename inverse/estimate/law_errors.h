// Uncertainty by the choice of the strain energy law: real tissue follows none exactly. Laws of equal Young's modulus
// and Poisson's ratio differ beyond small strains, by the coupling of shear and volume and by stiffening. The
// differences of their predictions are common errors of all readings, with one standard normal factor each:
// approximation errors [Kaipio and Somersalo 2007].
#pragma once
#include <span>
#include <string>
#include <vector>

#include "model/predictions.h"

namespace aspic {

// Standard deviation of the stiffening b of mu/2 (x + b x^2), x = J^(-2/3) I1 - 3, about 0. Measurements of the tests
// and of capture_results.md have b = 0.3.
inline constexpr double kStiffening = 0.25;

bool has_law_errors(const std::string& material);  // a neo-Hookean law: others have parameters for their shape

struct LawErrors {
  std::vector<std::vector<CommonError>> cases;  // two per case; empty: unknown
  std::string failure;                          // why; empty: the law has none
};

// Requires one parameter set per tet of the material's mesh. Starts from the predictions for another material, which it
// replaces.
LawErrors law_errors(const Experiment& experiment, const std::string& material,
                     std::span<const MaterialParameters> parameters, const EquilibriumOptions& options = {},
                     ErrorPredictions* last = nullptr);

}  // namespace aspic
