// The recorded part of a model: the surfaces to show, and the points and mean values that they depend on.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "viewer/surface.h"

namespace aspic::viewer {

struct RecordedSurface {
  std::string name;              // "skin" or "cage"
  Surface surface;               // `carrier` has indices of points
  std::vector<uint32_t> tet;     // user's number of the tet behind each triangle
  std::vector<uint32_t> vertex;  // user's number of each vertex; kNoVertex for a point of a fine skin
  std::vector<uint32_t> place;   // index of the place whose value each vertex has
};

struct RecordedBody {
  std::vector<int> source;      // vertex of each point, in the model or in the sequence of the skins
  std::vector<TubePoint> tube;  // points after those of `source`, if they are vertices of the model
  std::vector<Vec3d> rest;      // rest position of each point [m]
  std::vector<double> mass;     // share of each point in the mass of its tets [kg]
  std::vector<uint8_t> is_pinned;
  std::vector<RecordedSurface> surfaces;  // the first one is the default
  // A surface without triangles that has one vertex per recorded value: a vertex of the boundary, or a tet whose value
  // the vertices of a fine skin share. Empty if the run has no interior.
  Surface places;
};

// Returns the boundary of the tets and the fine skin, if any.
RecordedBody body_with_interior(const Scene& scene);
// Returns the skins alone. Their vertices are the points.
RecordedBody body_of_skins(const Scene& scene);

}  // namespace aspic::viewer
