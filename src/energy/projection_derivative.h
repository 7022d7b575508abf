// The derivative of u' f(A) w for a symmetric A whose low eigenvalues f raises, as in modified element Hessians
// (filter_eigenvalues in math/definite.h): d(u' f(A) w) = sum_k values[k] q_k' dA q_k.
#pragma once
#include "linalg/projection.h"
#include "math/pack.h"
#include "math/small.h"
#include "math/symmetric_eigen.h"

namespace aspic {

// The divided differences of the Daleckii-Krein theorem [Higham 2008, theorem 3.11]; f raises eigenvalues in all lanes,
// whether they need it or not. `kind` is clamped or absolute; eigenvalues at the threshold of f have no derivative.
SymmetricEigen<9, Pack> raised_product_derivative(const Mat9<Pack>& A, const Mat3<Pack>& u, const Mat3<Pack>& w,
                                                  Definiteness kind);

}  // namespace aspic
