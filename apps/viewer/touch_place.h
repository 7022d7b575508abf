// The place where a tip touches a body: a point of its surface and the inward normal.
#pragma once
#include "energy/held_tip.h"
#include "viewer/surface.h"

namespace aspic::viewer {

// Default radius of a tip: about a twelfth of the body, and wide enough for its triangles [m].
double usual_radius(const Surface& cage);
// Default stiffness of the layer: 100 times that of the body under the tip. It yields 1% of the depth [Pa/m].
double usual_layer(const Model& model, double radius);

// `cage`: the boundary of the tets, at the positions x. The tip turns with the tet behind the triangle.
Touch touch_at(const Model& model, const Surface& cage, const SurfacePoint& point, const Tip& tip,
               std::span<const double> x);

TipPose pressed(const Touch& touch, double depth, const Vec3d& shift = {});  // depth below the first contact [m]

Vec3d rotation_vector(const Mat3d& R);  // axis times angle, in [0, pi]

}  // namespace aspic::viewer
