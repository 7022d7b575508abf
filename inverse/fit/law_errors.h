// Uncertainty by the choice of the strain energy law: real tissue follows none exactly. Laws of equal Young's modulus and
// Poisson's ratio differ beyond small strains. The difference of the predictions by two of them is a common error of all
// readings with one standard normal factor, an approximation error [Kaipio and Somersalo 2007].
#pragma once
#include <span>
#include <string>
#include <vector>

#include "fit/misfit.h"

namespace aspic {

// A law without parameters of its own that couples shear and volume differently; empty: none.
std::string rival_of(const std::string& material);

struct LawErrors {
  std::vector<CommonError> cases;  // empty: unknown
  std::string failure;             // why; empty: the law has no rival
};

// Requires one parameter set per tet of the material's mesh.
LawErrors law_errors(const Experiment& experiment, const std::string& material,
                     std::span<const MaterialParameters> parameters, const EquilibriumOptions& options = {});

}  // namespace aspic
