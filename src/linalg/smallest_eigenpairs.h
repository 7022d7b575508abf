// The smallest eigenvalues of K u = lambda M u for large sparse symmetric K and M.
#pragma once
#include <functional>
#include <span>
#include <vector>

namespace aspic {

// The problem in a subspace of admissible vectors, where M and K + shift M are positive definite. The functions read
// and write vectors of `size` entries and are called one after another; what one of them throws, the caller receives.
struct ShiftedPencil {
  int size = 0;
  int dimension = 0;  // dimension of the subspace
  double shift = 0;
  std::function<void(std::span<double> x)> project;                                   // onto the subspace
  std::function<void(std::span<const double> x, std::span<double> y)> multiply_mass;  // y = M x
  std::function<void(std::span<const double> b, std::span<double> x)> solve;          // (K + shift M) x = b
};

struct Eigenpairs {
  bool converged = false;
  std::vector<double> values;                // ascending
  std::vector<std::vector<double>> vectors;  // u_i' M u_j = delta_ij; the entry of the largest size is positive
};

// Returns `count` eigenpairs, or all where the subspace has fewer dimensions. Repeated eigenvalues are found as often
// as they occur. Lanczos iteration on (K + shift M)^-1 M from a fixed start [Lehoucq1998], by Spectra, repeated with
// the eigenvectors found so far removed until no smaller eigenvalue is left; a dense solver for small subspaces.
Eigenpairs smallest_eigenpairs(const ShiftedPencil& pencil, int count);

}  // namespace aspic
