// What a minimiser sees: a function with derivatives. No physics here.
#pragma once
#include <cstdint>
#include <span>

#include "linalg/block_sparse.h"
#include "linalg/projection.h"

namespace aspic {

class Objective {
 public:
  virtual ~Objective() = default;
  virtual double value(std::span<const double> x) = 0;  // +inf where it is not defined
  virtual void gradient(std::span<const double> x, std::span<double> g) = 0;
  // Valid until the next one is asked for.
  const BlockSparse& hessian(std::span<const double> x, const Projection& projection) {
    ++hessians_made_;
    return evaluate_hessian(x, projection);
  }
  uint64_t hessians_made() const { return hessians_made_; }  // by whomever: whether the last one still is one's own
  // A minimiser has moved to x, where it evaluated the last value and the last gradient.
  virtual void note_iterate(std::span<const double> /*x*/) {}
  virtual int projected_elements() const { return 0; }  // of the last Hessian
  virtual double max_step(std::span<const double>, std::span<const double>) {
    return 1e300;
  }  // largest feasible alpha along d

  // A constant positive definite matrix in which steps may be measured, such as the mass; null: the identity.
  virtual const BlockSparse* metric() { return nullptr; }

  // z = B^-1 r for a positive definite B of the objective's own, the same throughout a minimisation. False: it has
  // none.
  virtual bool precondition(std::span<const double> /*r*/, std::span<double> /*z*/) { return false; }

  // Which vertices interact, for methods that move one vertex at a time; null: ask the Hessian.
  virtual const BlockPattern* coupling() { return nullptr; }
  // g[k] = dE/dx_v and H[k] = d2E/dx_v^2 (3 x 3, perhaps indefinite) for v = vertices[k], no two of which interact.
  // False: not offered; whole gradients and Hessians serve instead.
  virtual bool vertex_systems(std::span<const double> /*x*/, std::span<const int> /*vertices*/, std::span<Vec3d> /*g*/,
                              std::span<Mat3d> /*H*/) {
    return false;
  }

  // The sizes against which x, the last value and the last gradient are small or large, in their own units, and the
  // part of the last two that is round-off. A plain function measures against 1.
  virtual double x_scale() const { return 1; }
  virtual double value_scale() const { return 1; }
  virtual double gradient_scale() const { return 1; }
  virtual double gradient_unit() const { return 1; }  // what a gradient of one physical unit is
  virtual double value_round_off() const { return 0; }
  virtual double gradient_round_off() const { return 0; }

  virtual double dot(std::span<const double> a,
                     std::span<const double> b);  // a distributed objective reduces over ranks

 protected:
  virtual const BlockSparse& evaluate_hessian(std::span<const double> x, const Projection& projection) = 0;

 private:
  uint64_t hessians_made_ = 0;
};

}  // namespace aspic
