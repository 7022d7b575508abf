// A probe whose tip a hand holds: which tip, where it touched the body at rest, and where the hand moves it may change
// between steps.
#pragma once
#include <memory>

#include "energy/probe.h"

namespace aspic {

struct Touch {
  Tip tip;
  TipPose rest;   // pose in which the tip touches the body at rest
  TipPose begun;  // pose in which the hand first put the tip on the body
};

// What the hand does. The pose changes along a line from one time to another, and rests before and after. [m, rad, s]
struct Poke {
  std::shared_ptr<const Touch> touch;  // null: there is no tip
  TipPose from, to;
  double from_time = 0, to_time = 0;

  TipPose pose(double time) const;
};

class HeldTip : public Energy {
 public:
  // `mesh`: of the model, whose boundary the tip may touch; nothing of it is kept but positions.
  explicit HeldTip(const TetMesh& mesh);
  ~HeldTip() override;

  std::string_view name() const override { return "probe"; }

  // Throws InvalidInput for a touch as make_probe does; nothing has changed then.
  void set(const Poke& poke);
  const Poke& poke() const { return poke_; }
  // Where the poke ends:
  double value(Positions x) const;        // [J]
  Wrench wrench(Positions x) const;       // force and moment of the tip on the body
  int touched_points(Positions x) const;  // number of surface points that the tip touches; 0 without a tip

  double value(Positions x, const Context&) const override;
  void add_gradient(Positions x, const Context&, double scale, std::span<double> g) const override;
  void bind(const BlockPattern& pattern) override;
  int add_hessian(Positions x, const Context&, double scale, const Projection& projection,
                  BlockSparse& H) const override;

 private:
  std::unique_ptr<Probe> made(const Touch& touch) const;

  TetMesh mesh_;  // without tets
  std::vector<Triangle> surface_;
  Poke poke_;
  std::unique_ptr<Probe> probe_;  // energy of the poke; null without a tip
  const BlockPattern* pattern_ = nullptr;
};

}  // namespace aspic
