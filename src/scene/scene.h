// Makes a simulation from a TOML scene, or from a mesh file alone.
#pragma once
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "dynamics/simulation.h"
#include "mesh/embed.h"
#include "mesh/triangle_uv.h"

namespace aspic {

// Output of a run: the table `output` of a scene.
struct OutputOptions {
  double every = 0;  // seconds of simulated time between frames; 0: every step
  // Formats of the frames, and report.html.
  bool vtu = true, obj = false, ply = false, pc2 = true, usd = true, report = true;
  bool double_precision = false;  // all numbers of the VTU frames; positions have it always
  bool mechanics = false;         // F, strains, principal stresses and reactions in the VTU frames
  double checkpoint_every = 1;    // seconds of wall time between checkpoints; 0: with every frame
};

// A surface to draw.
struct Skin {
  TriMesh rest;         // the fine surface, the boundary of the body, a sheet, or the vertices of a rod
  Embedding embedding;  // into the vertices of the model
  std::string body;     // name of its BodyRange
  bool is_sheet = false;
  std::vector<Segment> segments = {};  // of a rod, chain by chain
  double radius = 0;                   // of a rod [m]
  std::vector<TriangleUv> uv = {};     // of each triangle of `rest`; empty: the file has none
};

struct Table;  // see scene/value.h

struct Scene {
  std::string name;                // file name without extension
  std::string resolved;            // TOML with all defaults filled in; running it gives the same bits
  std::vector<std::string> notes;  // chosen defaults with reasons; last the warnings
  std::string start_warning;       // energy of contact at the start and its remedy; empty: none. One of the notes
  Simulation simulation;           // its model is renumbered; model().numbering leads back to the user's numbers
  std::vector<Skin> skins;         // one per body
  int steps = 0;                   // of the whole run
  std::vector<std::string> warnings;
  OutputOptions output;
  // The inputs of `resolved` by their names there ("inputs/bunny.msh"): files to copy, and meshes that were made from a
  // surface.
  std::vector<std::pair<std::string, std::string>> input_files = {};
  std::vector<std::pair<std::string, TetMesh>> generated_meshes = {};
  Vec3d gravity = {};              // [m/s^2]
  std::string mesh_error = "end";  // when to estimate the discretization error: "end", "frames" or "off"
};

// What a run needs beside its results to be repeated.
struct SceneInputs {
  const std::string& resolved;                                           // see Scene
  const std::vector<std::pair<std::string, std::string>>& files;         // see Scene::input_files
  const std::vector<std::pair<std::string, TetMesh>>& generated_meshes;  // see Scene
};
inline SceneInputs inputs_of(const Scene& scene) { return {scene.resolved, scene.input_files, scene.generated_meshes}; }

// Writes the inputs below `folder`, so that `resolved` can be run from there. Throws InvalidInput.
void write_inputs(const SceneInputs& inputs, const std::string& folder);
inline void write_inputs(const Scene& scene, const std::string& folder) { write_inputs(inputs_of(scene), folder); }

// Called before work that takes seconds, with a description: "checking 5821794 tets of body 'liver'".
using Announce = std::function<void(const std::string& what)>;

// The maximum number of tets of all bodies together.
struct TetLimit {
  double tets = 2e7;
  std::string why = "are generated";                               // after "at most 2e+07"
  bool counts_files = false;                                       // applies to meshes that are read, too
  std::int64_t memory = std::numeric_limits<std::int64_t>::max();  // maximum memory [bytes]
};

struct SceneOptions {
  std::vector<std::string> overrides = {};  // "material.young=2e5", "time.step=0.005", "body.bunny.scale=2"
  std::string mesher = {};                  // path of aspic-mesh; empty: searched
  bool allow_outside = false;               // read files from outside the scene's folder and the folder above it
  Announce announce = {};                   // empty: not called
  TetLimit limit = {};
  double mesher_seconds = 0;               // wall time after which filling a surface fails; 0: default of the mesher
  std::function<void(Model&)> amend = {};  // changes the model before it is simulated
  // Called with the document and its defaults before meshes are read. Throws InvalidInput for what the caller does not
  // support.
  std::function<void(const Table&)> require = {};
};

// A .toml file is a scene; any mesh file becomes one with sensible defaults. Throws InvalidInput with file, line,
// column, value, remedy and nearest known name.
Scene load_scene(const std::string& path, const SceneOptions& options = {});

// Returns the reference of all scene keys, docs/scene.md.
std::string scene_reference();

}  // namespace aspic
