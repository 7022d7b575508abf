// Substitution with a dense panel [L11; L21] of the factor: column-major, `rows` x `columns`, L11 lower triangular.
// Large panels are shared by all threads; the bits do not depend on how many there are.
#pragma once

namespace aspic {

// x becomes L11^-1 x, then y becomes y - L21 x.
void solve_forward(const double* L, int rows, int columns, double* x, double* y);
// x becomes L11^-T (x - L21' y); y stays.
void solve_backward(const double* L, int rows, int columns, double* x, const double* y);

}  // namespace aspic
