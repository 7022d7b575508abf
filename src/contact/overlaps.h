// Overlap of surfaces at given positions.
#pragma once
#include <array>
#include <span>
#include <string>
#include <vector>

#include "contact/contact_mesh.h"

namespace aspic {

struct Overlaps {
  struct Pair {
    std::array<int, 2> parts;  // ascending
    Vec3d place;               // [m]
  };
  std::vector<Pair> pairs;  // one for each pair of parts, ascending
  size_t count = 0;         // number of pairs of triangles
  bool is_complete = true;  // false: more pairs may exist
};

// Returns the pairs of parts whose surfaces intersect. Includes triangles without area, and the axes of capsules.
// Excludes pairs of obstacles, and planes. `x`: positions of all points [m].
Overlaps overlaps(const ContactMesh& mesh, std::span<const Vec3d> x);

// A component of one part whose surface intersects no other, inside of another part.
struct Enclosed {
  int inner, outer;  // parts
  Vec3d place;       // a point of the inner part [m]
};

// Returns the parts that are wholly inside of a closed surface, such as an obstacle in a body or a body in a container.
// Requires that no surfaces intersect.
std::vector<Enclosed> enclosed_parts(const ContactMesh& mesh, std::span<const Vec3d> x);

}  // namespace aspic
