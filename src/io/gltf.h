// Binary glTF 2.0 (.glb) [Khronos]: meshes whose frames are morph targets, for Blender, browsers and game engines.
// Lengths are in meters, Y is up.
#pragma once
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "io/camera.h"
#include "mesh/tet_mesh.h"

namespace aspic {

struct GltfMesh {
  std::string name;
  std::span<const Triangle> triangles;
  std::vector<std::vector<float>> frames = {};  // one, or one per time; 3 per vertex [m]
  std::span<const Segment> segments = {};       // not empty: lines instead of triangles
  std::vector<float> uv = {};                   // texture coordinates, 2 per vertex with v downward; may be empty
};

struct GltfScene {
  std::vector<GltfMesh> meshes;
  std::vector<double> times;  // time of each frame, ascending [s]
  std::optional<Camera> camera = {};
};

// The material is two-sided, for sheets. There are no normals, so that players compute those of the moved triangles.
// Players interpolate linearly between frames. The size grows quadratically with the number of frames, but only by 4
// bytes per pair.
std::string glb(const GltfScene& scene);

}  // namespace aspic
