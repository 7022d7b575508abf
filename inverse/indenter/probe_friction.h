// Coulomb friction of a sliding indenter, D(x) = sum over points in contact of mu N f(|T (p - a)|), which is a
// potential for lagged normal forces N and tangent planes T = I - n n' (see LaggedEnergy).
//   a      anchor: the place of the indenter that meets the point at rest if the indenter approaches along its axis.
//          It moves with the indenter.
//   f(y) = y^2 / e - y^3 / (3 e^2) for y < e, and y - e / 3 beyond, e = radius / 1000: points that stick creep by less
// Only the total slip counts, not its history: a path that reverses needs other models. At x with lagged coefficients
// of the same x, the friction of a point is the force q(p) = mu N f'(y) / y T (p - a).
#pragma once
#include "energy/lagged_product.h"
#include "indenter/probe.h"

namespace aspic {

class ProbeFriction : public Energy, public LaggedEnergy, public LaggedProduct {
 public:
  // `probe` of this indenter must outlive this and be a term of the same model.
  ProbeFriction(const TetMesh& mesh, const Probe& probe, const Indenter& indenter, const IndenterPose& touch);

  std::string_view name() const override { return "friction"; }
  void bind(const BlockPattern& pattern) override { pattern_ = &pattern; }
  std::unique_ptr<Context> make_context() const override;
  void begin_step(const StepContext& step, Context& context) const override;
  void update_lagged(Positions x, bool keeps_directions, Context& context) const override;
  bool relax_lagged(Context&) const override { return false; }
  double value(Positions x, const Context& context) const override;
  void add_gradient(Positions x, const Context& context, double scale, std::span<double> g) const override;
  int add_hessian(Positions x, const Context& context, double scale, const Projection& projection,
                  BlockSparse& H) const override;

  // The friction q at x: g += scale q, its wrench on the body, and their derivatives (see Probe).
  void add_friction(Positions x, double scale, std::span<double> g) const;
  Wrench wrench(Positions x) const;
  Wrench wrench_product(Positions x, std::span<const double> dx) const;
  void add_wrench_transposed(Positions x, const Wrench& wbar, double scale, std::span<double> xbar) const;
  // g += scale dq/dpose for a motion of the indenter with this velocity of its center and angular velocity.
  void add_pose_product(Positions x, const Vec3d& velocity, const Vec3d& turn, double scale, std::span<double> g) const;
  void add_lagged_product(Positions x, std::span<const double> dx, double scale, std::span<double> g) const override;
  void add_lagged_transposed(Positions x, std::span<const double> w, double scale,
                             std::span<double> xbar) const override;

 private:
  struct Slider;
  struct Sliders;
  struct Traction;
  Slider slider_of(const TouchedPoint& point) const;
  Traction traction_of(const TouchedPoint& point) const;
  Vec3d anchor(const TouchedPoint& point) const;

  const TetMesh& mesh_;
  const Probe& probe_;
  Indenter indenter_;
  PlacedIndenter touch_;
  double width_;  // e [m]
  const BlockPattern* pattern_ = nullptr;
};

}  // namespace aspic
