// What a recording keeps of a model: the surfaces that can be shown, and the points and mean values they depend on.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "viewer/surface.h"

namespace aspic::viewer {

struct RecordedSurface {
  std::string name;              // "skin" or "cage"
  Surface surface;               // carried by the points: `carrier` has their numbers
  std::vector<uint32_t> tet;     // behind each triangle, by the user's numbers
  std::vector<uint32_t> vertex;  // the user's number of each vertex; kNoVertex for a point of a fine skin
  std::vector<uint32_t> place;   // whose value each vertex has
};

struct RecordedBody {
  std::vector<int> source;   // what each point is: a vertex of the model, or of the skins one after another
  std::vector<Vec3d> rest;   // of each point [m]
  std::vector<double> mass;  // of each point: its share of its tets [kg]
  std::vector<uint8_t> is_pinned;
  std::vector<RecordedSurface> surfaces;  // the first is shown first
  // Where values are: a vertex of the boundary, or a tet that carries vertices of a fine skin, which share its value.
  // As a surface without triangles; empty where the interior is not known.
  Surface places;
};

// The boundary of the tets and, where there is a fine one, the skin.
RecordedBody body_with_interior(const Scene& scene);
// The skins alone, whose vertices are the points.
RecordedBody body_of_skins(const Scene& scene);

}  // namespace aspic::viewer
