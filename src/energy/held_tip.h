// A probe whose tip follows the user's hand. The touch and the motion may change between steps.
#pragma once
#include <memory>

#include "energy/probe.h"

namespace aspic {

struct Touch {
  Tip tip;
  TipPose rest;   // pose in which the tip touches the body at rest
  TipPose begun;  // pose in which the hand first applied the tip to the body
};

// Motion of the hand: the pose changes linearly from one time to another and is constant before and after. [m, rad, s]
struct Poke {
  std::shared_ptr<const Touch> touch;  // null: no tip
  TipPose from, to;
  double from_time = 0, to_time = 0;

  TipPose pose(double time) const;
};

class HeldTip : public Energy {
 public:
  // `mesh`: the model, whose boundary the tip may touch. Only its positions and boundary are copied.
  explicit HeldTip(const TetMesh& mesh);
  ~HeldTip() override;

  std::string_view name() const override { return "probe"; }

  // Throws InvalidInput for an invalid touch, like make_probe, and then changes nothing.
  void set(const Poke& poke);
  const Poke& poke() const { return poke_; }
  // At the end of the poke:
  double value(Positions x) const;        // [J]
  Wrench wrench(Positions x) const;       // force and moment of the tip on the body
  int touched_points(Positions x) const;  // number of surface points in contact; 0 without a tip

  double value(Positions x, const Context&) const override;
  void add_gradient(Positions x, const Context&, double scale, std::span<double> g) const override;
  void bind(const BlockPattern& pattern) override;
  int add_hessian(Positions x, const Context&, double scale, const Projection& projection,
                  BlockSparse& H) const override;

 private:
  std::unique_ptr<Probe> make(const Touch& touch) const;

  TetMesh mesh_;  // without tets
  std::vector<Triangle> surface_;
  Poke poke_;
  std::unique_ptr<Probe> probe_;  // energy of the tip; null without a tip
  const BlockPattern* pattern_ = nullptr;
};

}  // namespace aspic
