// The skins and obstacles of a run as animated glTF.
#pragma once
#include <string>

#include "results/run_directory_layout.h"
#include "scene/scene.h"

namespace aspic {

struct RunGltf {
  std::string bytes;  // of a .glb file
  int frames = 0;     // in the file, evenly spaced frames of the run with the first one
  int frames_of_run = 0;
};

// Up to the latest checkpoint. Throws InvalidInput.
RunGltf run_glb(const RunLayout& layout, const Scene& scene);

}  // namespace aspic
