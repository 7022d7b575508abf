// Scenes of generated boxes and of binary .msh files, of which each rank makes or reads its own part, so that none
// holds the whole mesh.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "ranks/rank_scene.h"
#include "ranks/sliced_body.h"
#include "scene/scene_files.h"
#include "scene/value.h"

namespace aspic::distributed {

// Returns the bodies, if all can be sliced and nothing in the document needs a whole one; else nothing. `document`:
// complete.
using SlicedBodies = std::vector<std::unique_ptr<SlicedBody>>;
std::optional<SlicedBodies> sliced_bodies(const Table& document, const SceneFiles& files);

// Writes what a scene without slices adds to a document when it is built: names of copied files and the hashes of the
// meshes. Returns false, if a mesh must be read as a whole after all.
bool resolve_slices(const SlicedBodies& bodies, Table& document, SceneFiles& files);

// Requires a vertex per rank and fewer than 2^31 vertices and tets. Throws Refused if a part of a file has errors.
// Collective.
RankScene make_mesh_slices(const Table& document, const SlicedBodies& bodies);

}  // namespace aspic::distributed
