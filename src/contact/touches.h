// Points of bodies that touch another surface, and the displacements that separate them.
#pragma once
#include <array>
#include <span>
#include <vector>

#include "contact/contact_mesh.h"
#include "contact/stencil_search.h"

namespace aspic {

// A point of a body has to move by at least `by` along the unit vector `away` to leave another surface.
struct Touch {
  int point;  // index in the ContactMesh
  Vec3d away;
  double by;                 // [m]
  std::array<int, 2> parts;  // ascending
};

// Returns the touches of features of different parts whose gap is at most kTouching mean edges. Gaps of sheets and rods
// may be negative by their thickness. A sheet that coincides with another one leaves it on the side of the normals of
// the first. `x`: positions of all
// points [m]. All of `by` together leave gaps of at least the reach, or of touching_reach() if that is smaller.
std::vector<Touch> touches(const ContactMesh& mesh, const ContactLaws& laws, const StencilSearch& search,
                           std::span<const Vec3d> x);

}  // namespace aspic
