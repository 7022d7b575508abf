// Cook's membrane in plane strain by other means than linear tets: biquadratic quadrilaterals on a graded grid.
#pragma once
#include <array>
#include <functional>

namespace aspic::verify {

// Derivatives of psi(I1, J), I1 = tr(F'F), J = det F in space.
struct InvariantDerivatives {
  double by_I, by_J, by_II, by_IJ, by_JJ;
};
using InvariantLaw = std::function<InvariantDerivatives(double I1, double J)>;

// mu/2 (I1 - 3) - mu ln J + lambda/2 (ln J)^2.
InvariantLaw logarithmic_law(double mu, double lambda);
// mu/2 (J^(-2/3) I1 - 3) + U(J); `volume` returns U' and U''.
InvariantLaw split_law(double mu, std::function<std::array<double, 2>(double J)> volume);

// How far (48, 52) moves up when the membrane (0, 0), (48, 44), (48, 60), (0, 44), clamped at x = 0, bears the dead
// traction (0, traction) at x = 48. cells x cells elements of nine nodes that crowd towards the clamped corners;
// Newton's method in five parts with a banded factorization of its own. Throws std::runtime_error when it does not
// converge.
double membrane_reference(const InvariantLaw& law, double traction, int cells);

}  // namespace aspic::verify
