// Where a tip touches a body: at a point of its surface, along the inward normal.
#pragma once
#include "energy/held_tip.h"
#include "viewer/surface.h"

namespace aspic::viewer {

// About a twelfth of the body, and wide enough for its triangles [m].
double usual_radius(const Surface& cage);
// A layer a hundred times as stiff as the body under the tip, which gives way by a hundredth of the depth [Pa/m].
double usual_layer(const Model& model, double radius);

// Of the boundary of the tets, at the positions x. The tip turns with the tet behind the triangle.
Touch touch_at(const Model& model, const Surface& cage, const SurfacePoint& point, const Tip& tip,
               std::span<const double> x);

TipPose pressed(const Touch& touch, double depth, const Vec3d& shift = {});  // as deep below where it began [m]

Vec3d rotation_vector(const Mat3d& R);  // axis times angle, in [0, pi]

}  // namespace aspic::viewer
