// The derivative of u' f(A) w for a symmetric A whose low eigenvalues f raises, as element Hessians are made definite
// (filter_eigenvalues in math/definite.h): d(u' f(A) w) = sum_k values[k] q_k' dA q_k.
#pragma once
#include "linalg/projection.h"
#include "math/pack.h"
#include "math/small.h"
#include "math/symmetric_eigen.h"

namespace aspic {

// Of the Daleckii-Krein theorem [Higham 2008, theorem 3.11]; f raises eigenvalues in all lanes, whether they need it or
// not. `kind` is clamped or absolute; eigenvalues that cross what f is cut at have no derivative.
SymmetricEigen<9, Pack> raised_product_derivative(const Mat9<Pack>& A, const Mat3<Pack>& u, const Mat3<Pack>& w,
                                                  Definiteness kind);

}  // namespace aspic
