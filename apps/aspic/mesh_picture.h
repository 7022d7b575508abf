// Pictures of shaded meshes as PNG, drawn by the viewer's page in a browser without a window.
#pragma once
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "aspic/plot.h"
#include "base/stop_token.h"
#include "mesh/tet_mesh.h"

namespace aspic::cli {

enum class Wires { none, thin };

// One panel of a picture of meshes. What is not finite of it is left out.
struct ShadedSurface {
  std::string caption;
  TriMesh surface;
  std::vector<double> values = {};  // one per triangle or one per vertex; gray where not finite; empty: one color
};

struct MeshPicture {
  std::string title;
  std::vector<ShadedSurface> panels;  // side by side, in one scale and from one direction
  Vec3d eye = {{0.6, -1, 0.45}};      // direction from the surfaces to the eye
  Vec3d up = {{0, 0, 1}};
  Wires wires = Wires::thin;
  std::string value_label = {};                          // of the color bar, with the unit
  std::optional<double> value_min = {}, value_max = {};  // found from the values where not given
  PictureSize size = {800, 480};                         // twice as many pixels; no higher than the panels need
};

struct MeshDrawing {
  std::filesystem::path path;  // .png
  MeshPicture picture;
};

// Draws all pictures with one start of the browser. Each file appears whole or not at all. Returns false if `stop`
// stopped it. Throws InvalidInput if a mesh has nothing to draw, there is no browser, or a file cannot be written.
bool draw(const std::vector<MeshDrawing>& drawings, const StopToken& stop = {});

}  // namespace aspic::cli
