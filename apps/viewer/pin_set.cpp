#include "viewer/pin_set.h"

namespace aspic::viewer {

PinSet::PinSet(const Model& model)
    : of_scene_(std::make_shared<const std::vector<Pin>>(model.pins)), pinned_(model.mesh.vertex_count()) {
  set(of_scene_);
}

void PinSet::set(Shared pins) {
  now_ = std::move(pins);
  pinned_.assign(pinned_.size(), 0);
  for (const Pin& pin : *now_)
    for (const int v : pin.vertices)
      if (v < static_cast<int>(pinned_.size())) pinned_[v] = 1;
}

std::vector<Pin> PinSet::painted(const std::vector<int>& vertices, bool pinned, Positions x) const {
  std::vector<char> chosen(pinned_.size(), 0);
  for (const int v : vertices) chosen[v] = 1;
  std::vector<Pin> pins;
  for (const Pin& old : *now_) {
    Pin kept = old;
    if (!pinned) std::erase_if(kept.vertices, [&](int v) { return v < static_cast<int>(chosen.size()) && chosen[v]; });
    if (!kept.vertices.empty()) pins.push_back(std::move(kept));
  }
  for (int v = 0; pinned && v < static_cast<int>(chosen.size()); ++v) {
    if (!chosen[v] || pinned_[v]) continue;
    const Vec3d here = point(x, v);
    pins.push_back({"by hand", {v}, [here](const Vec3d&, double) { return here; }});
  }
  return pins;
}

}  // namespace aspic::viewer
