// Substitution with a dense panel [L11; L21] of the factor: column-major, `rows` x `columns`, L11 lower triangular. All
// threads share large panels; the result is bit-reproducible for any number of threads.
#pragma once

namespace aspic {

// Replaces x by L11^-1 x, then y by y - L21 x.
void solve_forward(const double* L, int rows, int columns, double* x, double* y);
// Replaces x by L11^-T (x - L21' y); y is unchanged.
void solve_backward(const double* L, int rows, int columns, double* x, const double* y);

}  // namespace aspic
