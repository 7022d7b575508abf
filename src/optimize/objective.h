// What a minimizer sees: a function with derivatives. No physics here.
#pragma once
#include <cstdint>
#include <limits>
#include <span>

#include "linalg/block_sparse.h"
#include "linalg/projection.h"

namespace aspic {

// The value of a function, and the part of it that is round-off.
struct Evaluation {
  double value = 0;  // +inf where the function is not defined
  double round_off = 0;
};

// The sizes against which x, the last value and the last gradient are small or large, in their own units, and the part
// of the last gradient that is round-off. A plain function measures against 1.
struct ObjectiveScales {
  double x = 1, value = 1, gradient = 1;
  double gradient_unit = 1;  // what a gradient of one physical unit is
  double gradient_round_off = 0;
};

class Objective {
 public:
  virtual ~Objective() = default;
  virtual Evaluation evaluate(std::span<const double> x) = 0;
  double value(std::span<const double> x) { return evaluate(x).value; }
  virtual void gradient(std::span<const double> x, std::span<double> g) = 0;
  // Valid until the next one is asked for.
  const BlockSparse& hessian(std::span<const double> x, const Projection& projection) {
    ++hessians_made_;
    return evaluate_hessian(x, projection);
  }
  uint64_t hessians_made() const { return hessians_made_; }  // by whomever: whether the last one still is one's own
  int projected_elements() const { return projected_elements_; }  // of the last Hessian

  virtual ObjectiveScales scales() const { return {}; }
  // The largest feasible alpha along d.
  virtual double max_step(std::span<const double> /*x*/, std::span<const double> /*d*/) {
    return std::numeric_limits<double>::infinity();
  }
  // A minimizer has moved to x, where it evaluated the last value and the last gradient.
  virtual void note_iterate(std::span<const double> /*x*/) {}
  virtual double dot(std::span<const double> a, std::span<const double> b);  // a distributed objective sums over ranks

 protected:
  // Sets projected_elements_.
  virtual const BlockSparse& evaluate_hessian(std::span<const double> x, const Projection& projection) = 0;
  int projected_elements_ = 0;

 private:
  uint64_t hessians_made_ = 0;
};

// What an objective may offer besides: minimizers look for these interfaces among its base classes.

class HasMetric {
 public:
  virtual ~HasMetric() = default;
  // A constant positive definite matrix in which steps may be measured, such as the mass. Without one: the identity.
  virtual const BlockSparse& metric() = 0;
};

class HasPreconditioner {
 public:
  virtual ~HasPreconditioner() = default;
  // z = B^-1 r for a positive definite B, the same throughout a minimization. False: there is none.
  virtual bool precondition(std::span<const double> r, std::span<double> z) = 0;
};

// Round-off is as good as convergence only where it is this small beside what the gradient is made of.
inline constexpr double kResolved = 1e-3;

// A part of the variables that is judged by itself, such as one of several bodies.
struct GradientPart {
  double norm = 0;   // |g| over the part
  double scale = 1;  // against which that is small or large
};

// Parts that converge by themselves. Without this interface there is one, of all variables.
class HasParts {
 public:
  virtual ~HasParts() = default;
  virtual int part_count() const = 0;
  // g: the gradient that was evaluated last.
  virtual void measure_parts(std::span<const double> g, std::span<GradientPart> parts) = 0;
  // The part of |g| over one of them that is round-off, by the last Hessian.
  virtual double part_round_off(int part) const = 0;
  // How much of the forces that are known exactly, such as weight, is hidden in the gradient evaluated last at x: |g|
  // beside them where that is more than kResolved, at most 1; else 0.
  virtual double lost_accuracy(std::span<const double> x, std::span<const GradientPart> parts) = 0;
  // sqrt(-g.d / 2) against sqrt(scales().value), of parts the largest.
  virtual double relative_decrement(std::span<const double> g, std::span<const double> d) = 0;
};

// All variables of an objective as one part.
class WholePart : public HasParts {
 public:
  explicit WholePart(Objective& E) : E_(E) {}
  int part_count() const override { return 1; }
  void measure_parts(std::span<const double> g, std::span<GradientPart> parts) override;
  double part_round_off(int) const override { return E_.scales().gradient_round_off; }
  double lost_accuracy(std::span<const double>, std::span<const GradientPart>) override { return 0; }
  double relative_decrement(std::span<const double> g, std::span<const double> d) override;

 private:
  Objective& E_;
};

}  // namespace aspic
