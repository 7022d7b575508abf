// A virtual bench: measurements of a body whose material is known, made by simulating the pokes on a mesh that is finer
// than the one that a fit is given.
#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "capture/data_set.h"
#include "scene/material_file.h"
#include "scene/scene.h"

namespace aspic {

// Throws InvalidInput for a pin that holds some directions only: captured data know vertices that are held in all.
void require_full(const Pin& pin);

struct SynthesisOptions {
  int pokes = 8, depths = 3;
  double deepest = 0.1;   // relative to the size of the body, the cube root of its volume
  double tip_radius = 0;  // [m]; 0: 8 % of the size
  TipShape shape = TipShape::sphere;
  TipContact contact = TipContact::bonded;
  int markers = 100;
  double noise = 0.01;        // standard deviation of positions, relative to the largest motion
  double force_noise = 0.01;  // of forces and torques, relative to the largest
  bool forces = true, torques = false;
  bool regions = false;  // where the truth has one value, the tets of the data have one label: the anatomy is known
  std::vector<Vec3d> gravity;    // a case for each direction, 9.81 m/s^2
  std::optional<TetMesh> mesh;   // of the data set, at rest, in the place of the body; none: a coarser one is made
  std::filesystem::path mesher;  // aspic-mesh; empty: found by itself
  uint64_t seed = 1;
  StopToken stop = {};  // polled after every case; the cases so far are kept
};

struct SynthesisStep {
  int done = 0, of = 0;  // cases
  std::string name;
  Wrench wrench;
  int iterations = 0;
  std::string failure;  // empty: an equilibrium was found
};
using SynthesisObserver = std::function<void(const SynthesisStep&)>;

struct Synthesis {
  DataSet data;
  FittedMaterial truth;  // on the mesh of the scene, by the user's numbers
  std::vector<std::string> notes;
  int failed = 0;  // cases without an equilibrium, which are left out
  bool interrupted = false;
};

// Of the one body of a scene, held where its pins hold it. Throws InvalidInput when there is nothing to measure.
Synthesis synthesize(const Scene& scene, const SynthesisOptions& options, const SynthesisObserver& observe = {});

// Of the one body of a scene, by the user's numbers. Throws InvalidInput.
FittedMaterial true_material(const Scene& scene);

// A mesh of the same body with edges about one and a half times as long: its shape generated anew, or its surface
// filled by aspic-mesh. None: neither is possible; the reason is among the notes.
std::optional<TetMesh> coarser_mesh(const Scene& scene, const std::filesystem::path& mesher,
                                    std::vector<std::string>& notes);

}  // namespace aspic
