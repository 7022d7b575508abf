// A virtual bench: synthetic measurements of a body with known material. Simulates indentations on a finer mesh than
// that of the fit.
#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "data/data_set.h"
#include "scene/material_file.h"
#include "scene/scene.h"

namespace aspic {

// Throws InvalidInput for a pin of only some directions: in captured data vertices are held in all directions.
void require_full(const Pin& pin);

struct SynthesisOptions {
  int indentations = 8, depths = 3;
  double deepest = 0.1;        // relative to the size of the body, the cube root of its volume
  double indenter_radius = 0;  // [m]; 0: 8 % of the size
  IndenterShape shape = IndenterShape::sphere;
  IndenterContact contact = IndenterContact::bonded;
  int markers = 100;
  double noise = 0.01;        // standard deviation of positions, relative to the largest motion
  double force_noise = 0.01;  // noise of forces and torques, relative to the largest
  bool forces = true, torques = false;
  bool regions = false;        // label the tets of the data by true value, as for known anatomy
  std::vector<Vec3d> gravity;  // one case per direction, 9.81 m/s^2
  // Further indentations with names, indenter, touch, pose and gravity, group by group, each from the smallest depth
  // on.
  std::vector<LoadCase> cases = {};
  std::optional<TetMesh> mesh;   // rest mesh of the data set, in the position of the body; empty: a coarser one is made
  std::filesystem::path mesher;  // aspic-mesh; empty: searched automatically
  uint64_t seed = 1;
  StopToken stop = {};  // polled after every case; finished cases are kept
};

struct SynthesisStep {
  int done = 0, of = 0;  // finished and total cases
  std::string name;
  Wrench wrench;
  int iterations = 0;
  std::string failure;  // empty: equilibrium found
};
using SynthesisObserver = std::function<void(const SynthesisStep&)>;

struct Synthesis {
  DataSet data;
  FittedMaterial truth;  // on the mesh of the scene, in the user's numbering
  std::vector<std::string> notes;
  int failed = 0;  // omitted cases without equilibrium
  bool interrupted = false;
};

// Measures the single body of a scene, held where its pins hold it. Throws InvalidInput if there is nothing to measure.
Synthesis synthesize(const Scene& scene, const SynthesisOptions& options, const SynthesisObserver& observe = {});

// Material of the single body of a scene, in the user's numbering. Throws InvalidInput.
FittedMaterial true_material(const Scene& scene);

// Mesh of the same body with edges about 1.5 times as long: regenerated shape, or surface filled by aspic-mesh. Empty
// if neither is possible; the notes give the reason.
std::optional<TetMesh> coarser_mesh(const Scene& scene, const std::filesystem::path& mesher,
                                    std::vector<std::string>& notes);

}  // namespace aspic
