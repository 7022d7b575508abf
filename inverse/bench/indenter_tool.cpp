#include "bench/indenter_tool.h"

#include "bench/indenter_place.h"
#include "dynamics/model.h"
#include "viewer/scene_json.h"

namespace aspic::bench {
namespace {

viewer::ToolMotion shared(const IndenterMotion& motion) {
  return motion.touch ? std::make_shared<const IndenterMotion>(motion) : nullptr;
}

IndenterMotion own(const viewer::ToolMotion& motion) {
  return motion ? *static_cast<const IndenterMotion*>(motion.get()) : IndenterMotion{};
}

HeldIndenter& add_load(Model& model) {
  auto load = std::make_unique<HeldIndenter>(model.mesh);
  HeldIndenter& added = *load;
  model.loads.push_back(std::move(load));
  return added;
}

}  // namespace

IndenterTool::IndenterTool(Model& model) : load_(add_load(model)) {}

double IndenterTool::depth_of(const IndenterPose& pose) const {
  return touch() ? dot(pose.center - touch()->begun.center, touch()->begun.axis) : 0;
}

double IndenterTool::force(Positions x) const { return dot(load_.wrench(x).force, pose().axis); }

void IndenterTool::touch(std::shared_ptr<const FirstContact> touch) {
  const IndenterMotion motion{touch, touch->begun, touch->begun};
  load_.set(motion);
  place_.return_to(motion);
}

void IndenterTool::press(double depth) { place_.move(pressed(*touch(), depth)); }

viewer::ToolMotion IndenterTool::resting(double time) const { return shared(place_.resting(time)); }
viewer::ToolMotion IndenterTool::acting(const viewer::Interval& step) const { return shared(place_.acting(step)); }
void IndenterTool::set(const viewer::ToolMotion& motion) { load_.set(own(motion)); }
void IndenterTool::return_to(const viewer::ToolMotion& resting) { place_.return_to(own(resting)); }

void IndenterTool::continue_from(const viewer::SideTool& before) {
  const auto& place = static_cast<const IndenterTool&>(before).place_;
  load_.set(place.held());
  place_ = place;
}

Json IndenterTool::state(std::span<const double> x) const {
  if (!touch()) return nullptr;
  Json json = indenter_json(touch()->indenter);
  json.update({{"begun", viewer::json_of(touch()->begun.center)},
               {"center", viewer::json_of(pose().center)},
               {"axis", viewer::json_of(pose().axis)},
               {"depth", depth()},
               {"wanted", wanted()},
               {"force", force(x)}});
  return json;
}

Json indenter_json(const Indenter& indenter) {
  return {{"shape", indenter.shape == IndenterShape::disc ? "disc" : "sphere"},
          {"contact", indenter.contact == IndenterContact::sliding ? "sliding" : "bonded"},
          {"radius", indenter.radius},
          {"stiffness", indenter.stiffness}};
}

}  // namespace aspic::bench
