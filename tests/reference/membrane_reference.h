// Reference for Cook's membrane in plane strain: biquadratic quadrilaterals on a graded grid instead of linear tets.
#pragma once
#include <array>
#include <functional>

namespace aspic::verify {

// Derivatives of psi(I1, J), with I1 = tr(F'F) and J = det F in space.
struct InvariantDerivatives {
  double by_I, by_J, by_II, by_IJ, by_JJ;
};
using InvariantLaw = std::function<InvariantDerivatives(double I1, double J)>;

// mu/2 (I1 - 3) - mu ln J + lambda/2 (ln J)^2.
InvariantLaw logarithmic_law(double mu, double lambda);
// mu/2 (J^(-2/3) I1 - 3) + U(J); `volume` returns U' and U''.
InvariantLaw split_law(double mu, std::function<std::array<double, 2>(double J)> volume);

// Returns the vertical displacement of (48, 52) for the membrane (0, 0), (48, 44), (48, 60), (0, 44), clamped at x = 0,
// under the dead traction (0, traction) at x = 48. Uses cells x cells elements of nine nodes, graded toward the clamped
// corners, and Newton's method in five load steps with its own banded factorization. Throws std::runtime_error if it
// does not converge.
double membrane_reference(const InvariantLaw& law, double traction, int cells);

}  // namespace aspic::verify
