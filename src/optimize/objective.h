// What a minimiser sees: a function with derivatives. No physics here.
#pragma once
#include <cstdint>
#include <span>

#include "linalg/block_sparse.h"
#include "linalg/projection.h"

namespace aspic {

// Round-off is as good as convergence only where it is this small beside what the gradient is made of.
inline constexpr double kResolved = 1e-3;

// A part of the variables that is judged by itself, such as one of several bodies.
struct GradientPart {
  double norm = 0;   // |g| over the part
  double scale = 1;  // against which that is small or large
};

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

  // The parts that converge by themselves. By default there is one, of all variables.
  virtual int part_count() const { return 1; }
  // g: the gradient that was evaluated last.
  virtual void measure_parts(std::span<const double> g, std::span<GradientPart> parts);
  // The part of |g| over one of them that is round-off, by the last Hessian.
  virtual double part_round_off(int /*part*/) const { return gradient_round_off(); }
  // How much of the forces that are known exactly, such as weight, is hidden in the gradient evaluated last at x: |g|
  // beside them where that is more than kResolved, at most 1; else 0.
  virtual double lost_accuracy(std::span<const double> /*x*/, std::span<const GradientPart> /*parts*/) { return 0; }
  // sqrt(-g.d / 2) against sqrt(value_scale()), of parts the largest.
  virtual double relative_decrement(std::span<const double> g, std::span<const double> d);

  virtual double dot(std::span<const double> a,
                     std::span<const double> b);  // a distributed objective reduces over ranks

 protected:
  virtual const BlockSparse& evaluate_hessian(std::span<const double> x, const Projection& projection) = 0;

 private:
  uint64_t hessians_made_ = 0;
};

}  // namespace aspic
