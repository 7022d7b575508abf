// Scenes of generated boxes, of which each rank makes its own part, so that none holds the whole mesh.
#pragma once
#include <string>

#include "distributed/rank_scene.h"
#include "scene/value.h"

namespace aspic::distributed {

// Whether all bodies are generated boxes, and nothing in the document needs a whole body. `document`: complete.
bool can_be_sliced(const Table& document);

struct MeshSize {
  double vertices = 0, tets = 0;
};
MeshSize size_of_boxes(const Table& document);

// Writes what a scene without slices adds to a document when it is built: the hashes of the meshes.
void resolve_boxes(Table& document);

// Requires can_be_sliced(), a vertex per rank and fewer than 2^31 vertices and tets. Collective.
RankScene make_box_slices(const Table& document);

}  // namespace aspic::distributed
