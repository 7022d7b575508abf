// Helpers for materials whose stress is P = F S, S a polynomial in C = F'F.
#pragma once
#include "math/small.h"

namespace aspic {

// H += d(F S)/dF for dS = m dC: H(rc, qd) += S_cd [r = q] + m (F_rd F_qc + (F F')_rq [c = d]).
template <class T>
void add_product_hessian(const Mat3<T>& F, const Mat3<T>& S, const T& m, Mat9<T>& H) {
  const Mat3<T> mB = m * (F * transpose(F));
  for (int d = 0; d < 3; ++d)
    for (int q = 0; q < 3; ++q)
      for (int c = 0; c < 3; ++c)
        for (int r = 0; r < 3; ++r) {
          T h = m * F(r, d) * F(q, c);
          if (r == q) h = h + S(c, d);
          if (c == d) h = h + mB(r, q);
          H(r + 3 * c, q + 3 * d) = H(r + 3 * c, q + 3 * d) + h;
        }
}

}  // namespace aspic
