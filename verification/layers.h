// Bodies of one layer of cells, for plane problems.
#pragma once
#include <functional>

#include "verification/models.h"

namespace aspic::verify {

// V = k/2 sum (z - Z)^2 over all or the given vertices holds them in their planes z = const, or those of another axis.
// A stiffness k far above that of the cells gives plane strain.
std::unique_ptr<Energy> make_plane_hold(const TetMesh& mesh, double stiffness, int axis = 2,
                                        std::vector<int> vertices = {});

// length x height cells of equal size, one cell thick, mapped from [0, 1]^2 by `place`; thickness `thickness`.
TetMesh make_layer(int length, int height, double thickness,
                   const std::function<std::array<double, 2>(double, double)>& place);

// Moduli for which plane strain equals plane stress with E and nu.
struct PlaneModuli {
  double young, poisson;
};
PlaneModuli plane_stress(double young, double poisson);

}  // namespace aspic::verify
