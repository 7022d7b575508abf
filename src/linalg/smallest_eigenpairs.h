// Smallest eigenvalues of K u = lambda M u for large sparse symmetric K and M.
#pragma once
#include <functional>
#include <span>
#include <vector>

namespace aspic {

// The eigenproblem in a subspace of admissible vectors, on which M and K + shift M are positive definite. The functions
// read and write vectors of `size` entries and are never called concurrently. Their exceptions propagate to the caller.
struct ShiftedPencil {
  int size = 0;
  int dimension = 0;  // dimension of the subspace
  double shift = 0;
  std::function<void(std::span<double> x)> project;                                   // projection onto the subspace
  std::function<void(std::span<const double> x, std::span<double> y)> multiply_mass;  // y = M x
  std::function<void(std::span<const double> b, std::span<double> x)> solve;          // (K + shift M) x = b
};

struct Eigenpairs {
  bool converged = false;
  std::vector<double> values;                // ascending
  std::vector<std::vector<double>> vectors;  // u_i' M u_j = delta_ij; the entry of largest magnitude is positive
};

// Returns the `count` smallest eigenpairs, or all if the subspace has a smaller dimension. Repeated eigenvalues occur
// with their multiplicity. Uses Lanczos iteration on (K + shift M)^-1 M with a fixed start vector [Lehoucq1998], by
// Spectra. It is repeated with the known eigenvectors removed until no smaller eigenvalue remains. Small subspaces use
// a dense solver.
Eigenpairs smallest_eigenpairs(const ShiftedPencil& pencil, int count);

}  // namespace aspic
