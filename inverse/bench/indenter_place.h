// The place where an indenter touches a body, a point of its surface and the inward normal, and its default
// size.
#pragma once
#include "indenter/held_indenter.h"
#include "viewer/surface.h"

namespace aspic::bench {

using viewer::Surface, viewer::SurfacePoint;

// Default radius of an indenter: about a twelfth of the body, and wide enough for its triangles [m].
double default_radius(const Surface& cage);
// Default stiffness of the layer: 100 times that of the body under the indenter. It yields 1% of the depth [Pa/m].
double default_layer(const Model& model, double radius);

// `cage`: the boundary of the tets, at the positions x. The indenter turns with the tet behind the triangle.
FirstContact touch_at(const Model& model, const Surface& cage, const SurfacePoint& point, const Indenter& indenter,
                      std::span<const double> x);

IndenterPose pressed(const FirstContact& touch, double depth);  // depth below the first contact [m]

Vec3d rotation_vector(const Mat3d& R);  // axis times angle, in [0, pi]

}  // namespace aspic::bench
