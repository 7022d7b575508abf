// Binary glTF 2.0 (.glb) [Khronos]: one mesh whose frames are morph targets, one after another, as Blender, browsers
// and game engines read them. Lengths are in meters, Y is up.
#pragma once
#include <span>
#include <string>
#include <vector>

#include "mesh/tet_mesh.h"

namespace aspic {

struct GltfMesh {
  std::string name;
  std::span<const Triangle> triangles;
  std::vector<std::vector<float>> frames;  // at least one; 3 per vertex [m]
  std::vector<double> times;               // of each frame, ascending [s]
};

// Positions between two frames are interpolated linearly. The size grows with the square of the number of frames, but
// only by 4 bytes for each pair.
std::string glb(const GltfMesh& mesh);

}  // namespace aspic
