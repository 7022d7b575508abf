// Projection onto the surface of a body.
#pragma once
#include <vector>

#include "mesh/surface_locator.h"
#include "mesh/tet_mesh.h"
#include "model/misfit.h"

namespace aspic {

// Chosen: scans and markers are placed within some percent of the size of a body.
inline constexpr double kFarOff = 0.1;  // fraction of the size of a body; markers farther from its surface are errors
inline constexpr double kOffSurface = 0.02;  // the same for a finding

struct ProjectedPoint {
  SurfacePoint point;
  Vec3d position{};  // [m]
  Vec3d normal{};    // outward unit normal of the triangle
  double distance = 0;
};

class SurfaceProjection {
 public:
  explicit SurfaceProjection(const TetMesh& mesh);  // stores a reference to the mesh

  const std::vector<Triangle>& triangles() const { return triangles_; }  // boundary triangles, outward oriented
  ProjectedPoint nearest(const Vec3d& p) const;
  Vec3d center(const Triangle& t) const { return (1.0 / 3) * (mesh_.rest[t[0]] + mesh_.rest[t[1]] + mesh_.rest[t[2]]); }

 private:
  const TetMesh& mesh_;
  std::vector<Triangle> triangles_;
  SurfaceLocator locator_;
};

Vec3d position(const SurfacePoint& point, const std::vector<Vec3d>& X);

}  // namespace aspic
