// Modified Hessians of energies and functions written in Python.
#pragma once
#include <vector>

#include "linalg/projection.h"

namespace aspic::python {

// Raises the negative eigenvalues of the symmetric matrix A (n x n) to a small positive number, or replaces them by
// their absolute values. Returns false if there is none; A is then unchanged.
bool modify_eigenvalues(int n, std::vector<double>& A, Definiteness kind);

}  // namespace aspic::python
