// From a TOML file, or from a mesh alone, to a simulation that is ready to run.
#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "dynamics/simulation.h"
#include "mesh/embed.h"

namespace aspic {

struct OutputOptions {
  double every = 0;  // seconds of simulated time between frames; 0: every step
  bool vtu = true, obj = false, ply = false, pc2 = true, usd = true, report = true;
  bool double_precision = false;  // all numbers of the VTU frames; positions have it always
  double checkpoint_every = 1;    // seconds of wall time between checkpoints; 0: with every frame
};

struct Skin {
  TriMesh rest;         // the fine surface, or the boundary of the body
  Embedding embedding;  // into the vertices of the model
  std::string body;
};

struct Scene {
  std::string name;                // file name without extension
  std::string resolved;            // TOML with every default filled in: rerunning it gives the same bits
  std::vector<std::string> notes;  // each default that was chosen, with its reason; warnings of the doctor
  Simulation simulation;           // its model is renumbered; model().numbering leads back to the user's numbers
  std::vector<Skin> skins;         // one per body
  int steps = 0;                   // of the whole run
  OutputOptions output;
  // What `resolved` refers to, by the names it uses there ("inputs/bunny.msh"): files to copy, and meshes that were
  // made from a surface.
  std::vector<std::pair<std::string, std::filesystem::path>> input_files = {};
  std::vector<std::pair<std::string, TetMesh>> generated_meshes = {};
};

// Puts them below `folder`, beside which `resolved` can be run again. Throws InvalidInput.
void write_inputs(const Scene& scene, const std::filesystem::path& folder);

// Told what is about to be done when that takes more than a moment: "checking 5821794 tets of body 'liver'".
using Announce = std::function<void(const std::string& what)>;

// How many tets all bodies together may have.
struct TetLimit {
  double tets = 2e7;
  std::string why = "are generated";  // after "at most 2e+07"
  bool counts_files = false;          // meshes that are read, too, not only those that are generated
  std::int64_t memory = std::numeric_limits<std::int64_t>::max();  // [bytes] to be taken, however much more is free
};

struct SceneOptions {
  std::vector<std::string> overrides = {};  // "material.young=2e5", "time.step=0.005", "body.bunny.scale=2"
  std::filesystem::path mesher = {};        // aspic-mesh; empty: found by itself
  bool allow_outside = false;               // read files from outside the scene's folder and the folder above it
  Announce announce = {};                   // empty: nobody listens
  TetLimit limit = {};
  double mesher_seconds = 0;               // wall time after which filling a surface fails; 0: the mesher's default
  std::function<void(Model&)> amend = {};  // adds to the model what no scene can name; called before it is simulated
};

// A .toml file is a scene; any mesh file becomes one with sensible defaults. Throws InvalidInput with file, line,
// column, value, remedy and nearest known name.
Scene load_scene(const std::filesystem::path& path, const SceneOptions& options = {});

// The same schema as a page: docs/scene.md is this text.
std::string scene_reference();

}  // namespace aspic
