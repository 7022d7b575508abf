// The uncertainty of a field between its handles, about which the fitted values say nothing.
#pragma once
#include <vector>

#include "model/field_basis.h"

namespace aspic {

// Variance, in every tet, of the difference between a field and its interpolation sum_j w_j z(c_j) from the centers c_j
// of the basis, relative to the variance of the field. The correlation at the distance d is exp(-d / l), l = V^(1/3) /
// 2: that of parts that are divided by random planes [Switzer 1965]. Empty for a basis without centers.
std::vector<double> handle_gaps(const TetMesh& mesh, const FieldBasis& basis);

}  // namespace aspic
