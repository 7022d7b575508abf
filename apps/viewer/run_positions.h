// The positions in each frame of a run, read from its directory frame by frame, and the estimated error of the mesh.
#pragma once
#include <memory>
#include <vector>

#include "results/run_directory_layout.h"
#include "scene/scene.h"

namespace aspic::viewer {

class RunPositions {
 public:
  virtual ~RunPositions() = default;
  virtual std::vector<double> frame(int index) = 0;  // 3 coordinates per point [m]; throws InvalidInput with the file
  // The density of the estimated error of the mesh in each tet of the model [J/m^3]; empty: the frame has none.
  virtual std::vector<double> mesh_error(int index) = 0;
  // true: vertices of the model in the order of its mesh. false: vertices of the skins, without the interior.
  virtual bool are_of_model() const = 0;
};

// Reads the first `frames` frames of bodies or, if none were written, of skins. Throws InvalidInput without either.
std::unique_ptr<RunPositions> run_positions(const RunLayout& layout, const Scene& scene, int frames);

}  // namespace aspic::viewer
