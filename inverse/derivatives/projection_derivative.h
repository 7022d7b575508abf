// Derivative of u' f(A) w for a symmetric A, where f raises low eigenvalues as in modified element Hessians
// (filter_eigenvalues in math/definite.h): d(u' f(A) w) = sum_k values[k] q_k' dA q_k.
#pragma once
#include "linalg/projection.h"
#include "math/pack.h"
#include "math/small.h"
#include "math/symmetric_eigen.h"

namespace aspic {

// Uses the divided differences of the Daleckii-Krein theorem [Higham 2008, theorem 3.11]. Applies f to all lanes,
// including those with no low eigenvalue. `kind` is clamped or absolute. f is not differentiable at eigenvalues equal
// to its threshold.
SymmetricEigen<9, Pack> modified_product_derivative(const Mat9<Pack>& A, const Mat3<Pack>& u, const Mat3<Pack>& w,
                                                    Definiteness kind);

}  // namespace aspic
