// The predicted cost of a Cholesky factorization.
#pragma once
#include "linalg/block_sparse.h"

namespace aspic {

// Predicts the cost of a Cholesky factorization from the graph alone, in linear time and without an elimination order.
struct CostPrediction {
  double flops = 0;
  double entries = 0;                            // of the factor
  double bytes() const { return 18 * entries; }  // 8 per entry, and more for the update matrices of all subtrees
};
CostPrediction predict_cholesky(const BlockPattern& pattern);

}  // namespace aspic
