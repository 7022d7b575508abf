// Where everything was in each frame of a run, read from its directory one frame at a time.
#pragma once
#include <memory>
#include <vector>

#include "scene/run_directory_layout.h"
#include "scene/scene.h"

namespace aspic::viewer {

class RunPositions {
 public:
  virtual ~RunPositions() = default;
  virtual std::vector<double> frame(int index) = 0;  // 3 per point [m]; throws InvalidInput naming the file
  // Of the model, in the order of its mesh; else of the skins, one after another: all that is known of the interior.
  virtual bool are_of_model() const = 0;
};

// The first `frames` frames, of bodies where they were written, else of skins. Throws InvalidInput: neither was.
std::unique_ptr<RunPositions> run_positions(const RunLayout& layout, const Scene& scene, int frames);

}  // namespace aspic::viewer
