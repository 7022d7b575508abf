// A probe whose indenter follows the user's hand. The touch and the motion may change between steps.
#pragma once
#include <memory>

#include "indenter/probe.h"

namespace aspic {

struct FirstContact {
  Indenter indenter;
  IndenterPose rest;   // pose in which the indenter touches the body at rest
  IndenterPose begun;  // pose in which the hand first applied the indenter to the body
};

// Motion of the hand: the pose changes linearly from one time to another and is constant before and after. [m, rad, s]
struct IndenterMotion {
  std::shared_ptr<const FirstContact> touch;  // null: no indenter
  IndenterPose from, to;
  double from_time = 0, to_time = 0;

  IndenterPose pose(double time) const;
};

class HeldIndenter : public Energy {
 public:
  // `mesh`: the model, whose boundary the indenter may touch. Only its positions and boundary are copied.
  explicit HeldIndenter(const TetMesh& mesh);
  ~HeldIndenter() override;

  std::string_view name() const override { return "probe"; }

  // Throws InvalidInput for an invalid touch, like make_probe, and then changes nothing.
  void set(const IndenterMotion& poke);
  const IndenterMotion& poke() const { return poke_; }
  // At the end of the poke:
  double value(Positions x) const;        // [J]
  Wrench wrench(Positions x) const;       // force and moment of the indenter on the body
  int touched_points(Positions x) const;  // number of surface points in contact; 0 without an indenter

  double value(Positions x, const Context&) const override;
  void add_gradient(Positions x, const Context&, double scale, std::span<double> g) const override;
  void bind(const BlockPattern& pattern) override;
  int add_hessian(Positions x, const Context&, double scale, const Projection& projection,
                  BlockSparse& H) const override;

 private:
  std::unique_ptr<Probe> make(const FirstContact& touch) const;

  TetMesh mesh_;  // without tets
  std::vector<Triangle> surface_;
  IndenterMotion poke_;
  std::unique_ptr<Probe> probe_;  // energy of the indenter; null without an indenter
  const BlockPattern* pattern_ = nullptr;
};

}  // namespace aspic
