// Describes in which part of a body a direction of the parameters acts.
#pragma once
#include <span>
#include <string>

#include "model/parameter_map.h"

namespace aspic {

// "young of the whole body", "young around (0.01, 0, 0.02) m (8 % of the body)", "young around A against around B".
// Omits quantities and places with a small part of dp; ignores its sign.
std::string describe_direction(const TetMesh& mesh, const ParameterMap& map, std::span<const double> dp);

// "around (0.01, 0, 0.02) m (8 % of the body)": region where a field, one value per tet, is large.
std::string describe_place(const TetMesh& mesh, std::span<const double> field);

std::string describe_point(const Vec3d& x);  // "(0.01, 0, 0.02) m"

}  // namespace aspic
