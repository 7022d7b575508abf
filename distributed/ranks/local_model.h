// Makes the model of one rank from its part of a scene.
#pragma once
#include "dynamics/share.h"
#include "dynamics/state.h"
#include "ranks/rank_scene.h"
#include "scene/scene_files.h"
#include "scene/value.h"

namespace aspic::distributed {

struct LocalModel {
  Model model;
  State start;
  std::vector<std::string> notes;
};

struct LocalSource {
  RankScene& scene;  // its mesh, density and parameters move to the result
  Table& document;   // of the whole scene
  SceneFiles files;
};

// `share` must outlive the result. Throws Refused on all ranks if the document is invalid. Collective.
LocalModel make_local_model(LocalSource source, const Share& share);

}  // namespace aspic::distributed
