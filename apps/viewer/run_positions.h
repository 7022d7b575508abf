// The positions in each frame of a run, read from its directory frame by frame, and the estimated error of the mesh.
#pragma once
#include <memory>
#include <string_view>
#include <vector>

#include "results/run_directory_layout.h"
#include "scene/scene.h"

namespace aspic::viewer {

class RunPositions {
 public:
  virtual ~RunPositions() = default;
  virtual std::vector<double> frame(int index) = 0;  // 3 coordinates per point [m]; throws InvalidInput with the file
  // Values of each element of the model; empty: the frame has no such field.
  virtual std::vector<double> cell_field(int index, std::string_view name) = 0;
  // true: vertices of the model in the order of its mesh. false: vertices of the skins, without the interior.
  virtual bool are_of_model() const = 0;
};

// Reads the first `frames` frames of bodies or, if none were written, of skins. Throws InvalidInput without either.
std::unique_ptr<RunPositions> run_positions(const RunLayout& layout, const Scene& scene, int frames);

}  // namespace aspic::viewer
