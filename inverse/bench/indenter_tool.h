// The indenter on the body of one side: the tool of the bench.
#pragma once
#include <memory>

#include "indenter/held_indenter.h"
#include "viewer/held_tool.h"

namespace aspic::bench {

using viewer::Json;

class IndenterTool : public viewer::SideTool {
 public:
  explicit IndenterTool(Model& model);  // adds its load to the model

  const std::shared_ptr<const FirstContact>& touch() const { return place_.held().touch; }  // null: no indenter
  double depth() const { return depth_of(place_.place()); }    // below the first contact [m]
  double wanted() const { return depth_of(place_.wanted()); }  // at the end of the next step [m]
  const IndenterPose& pose() const { return place_.place(); }
  double force(Positions x) const;  // of the indenter on the body, along its axis [N]

  void touch(std::shared_ptr<const FirstContact> touch);  // throws InvalidInput, and then changes nothing
  void press(double depth);                               // [m]; requires an indenter
  void lift() { return_to(nullptr); }

  viewer::ToolMotion resting(double time) const override;
  viewer::ToolMotion acting(const viewer::Interval& step) const override;
  void finish_step() override { place_.finish_step(); }
  void set(const viewer::ToolMotion& motion) override;
  void return_to(const viewer::ToolMotion& resting) override;
  void continue_from(const viewer::SideTool& before) override;
  double energy(std::span<const double> x) const override { return load_.value(x); }
  Json state(std::span<const double> x) const override;  // null: no indenter

 private:
  double depth_of(const IndenterPose& pose) const;

  viewer::HeldTool<IndenterMotion, IndenterPose> place_;
  HeldIndenter& load_;  // in the model
};

Json indenter_json(const Indenter& indenter);  // {"shape", "contact", "radius", "stiffness"}

}  // namespace aspic::bench
