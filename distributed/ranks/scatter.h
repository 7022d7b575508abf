// Sends each rank its part of a scene that rank 0 has read.
#pragma once
#include "ranks/rank_scene.h"
#include "scene/scene_model.h"

namespace aspic::distributed {

// `whole`: on rank 0 the scene; null on other ranks. Requires linear tets and at least one vertex per rank. Collective.
RankScene scatter(const SceneModel* whole);

}  // namespace aspic::distributed
