// The inverse of a small symmetric matrix whose variables have different units.
#pragma once
#include <span>
#include <vector>

namespace aspic {

struct ScaledInverse {
  std::vector<double> inverse;  // n x n; zero rows and columns for zero rows of A
  std::vector<double> weakest;  // smallest eigenvalue whose eigenvector involves each variable
};

enum class Weak { raised, dropped };  // eigenvalues below the floor: replaced by it, or left out of the inverse

// Inverts A = S C S with the diagonal S that makes the diagonal of C one. `floor`: smallest eigenvalue of C. A: n x n;
// variables with a diagonal entry that is not positive are ignored.
ScaledInverse scaled_inverse(int n, std::span<const double> A, double floor, Weak weak);

}  // namespace aspic
