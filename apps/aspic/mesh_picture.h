// Pictures of shaded meshes as PNG, drawn by the viewer's page in a headless browser.
#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "aspic/plot.h"
#include "base/stop_token.h"
#include "mesh/tet_mesh.h"

namespace aspic::cli {

enum class Wires { none, thin };

// One panel of a picture of meshes. Triangles that are not finite are omitted.
struct ShadedSurface {
  std::string caption;
  TriMesh surface;
  std::vector<double> values = {};  // one per triangle or one per vertex; gray where not finite; empty: one color
};

struct MeshPicture {
  std::string title;
  std::vector<ShadedSurface> panels;  // side by side, with the same scale and view
  Vec3d eye = {{0.6, -1, 0.45}};      // direction from the surfaces to the eye
  Vec3d up = {{0, 0, 1}};
  Wires wires = Wires::thin;
  std::string value_label = {};                          // label of the color bar, with the unit
  std::optional<double> value_min = {}, value_max = {};  // default: range of the values
  PictureSize size = {800, 480};                         // PNG has twice as many pixels; no taller than the panels
};

struct MeshDrawing {
  std::filesystem::path path;  // .png
  MeshPicture picture;
};

// Draws all pictures with one browser process. Writes each file atomically. Returns false if `stop` stopped it. Throws
// InvalidInput if a mesh has nothing to draw, there is no browser, or a file cannot be written.
bool draw(const std::vector<MeshDrawing>& drawings, const StopToken& stop = {});

}  // namespace aspic::cli
