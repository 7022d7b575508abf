// Smooth functions f(x, y) as objectives. Vectors are padded to one 3x3 block; the minimum is at z = 0.
#pragma once
#include <array>

#include "optimize/objective.h"

namespace aspic {

using Planar = std::array<double, 2>;  // a point of the plane, or a gradient

// Symmetric 2 x 2 matrix of second derivatives.
struct PlanarHessian {
  double xx = 0, xy = 0, yy = 0;
};

// Quadratic approximation of a function about a point, which Newton's method minimizes.
struct QuadraticModel {
  Planar center{};
  double value = 0;
  Planar gradient{};
  PlanarHessian hessian;
  double at(const Planar& p) const;  // value of the model at a point p of the plane
};

class PlanarFunction : public Objective {
 public:
  PlanarFunction();

  virtual double at(const Planar& p) const = 0;  // +-inf or NaN where undefined
  // Derivatives at p; NaN where undefined.
  virtual Planar gradient_at(const Planar& p) const = 0;
  virtual PlanarHessian hessian_at(const Planar& p) const = 0;
  // Returns the model about p, with the Hessian modified as by Projection.
  QuadraticModel model(const Planar& p, Definiteness kind = Definiteness::exact) const;

  Evaluation evaluate(std::span<const double> x) override;
  void gradient(std::span<const double> x, std::span<double> g) override;
  const BlockSparse& evaluate_hessian(std::span<const double> x, const Projection& projection) override;
  ObjectiveScales scales() const override { return {.gradient_round_off = gradient_round_off_}; }

 private:
  BlockPattern pattern_;
  BlockSparse H_;
  double gradient_round_off_ = 0;
};

}  // namespace aspic
