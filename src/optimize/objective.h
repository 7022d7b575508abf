// The function to minimize, with its derivatives.
#pragma once
#include <cstdint>
#include <limits>
#include <span>

#include "linalg/block_sparse.h"
#include "linalg/dense_rows.h"
#include "linalg/projection.h"
#include "linalg/stiff_rows.h"

namespace aspic {

// A value of the function.
struct Evaluation {
  double value = 0;      // +inf where the function is undefined
  double round_off = 0;  // bound of the rounding error of `value`
};

// Characteristic sizes of x, of the last value and of the last gradient, in their own units. Tolerances are relative to
// them. The defaults suit a plain function.
struct ObjectiveScales {
  double x = 1, value = 1, gradient = 1;
  double gradient_unit = 1;       // norm of a gradient of one physical unit, such as one newton
  double gradient_round_off = 0;  // norm of the rounding error of the last gradient
};

class HasMetric;
class HasParts;
class HasStops;
class HasStiffRows;
class HasDenseRows;
class HasLag;

// The optional interfaces of an objective, see below; null: without it.
struct ObjectiveTraits {
  HasMetric* metric = nullptr;
  HasParts* parts = nullptr;
  HasStops* stops = nullptr;
  HasStiffRows* stiff_rows = nullptr;
  HasDenseRows* dense_rows = nullptr;
  HasLag* lag = nullptr;
};

// A function E of n variables, stored as n / 3 block rows of 3. Evaluations may use scratch data, so an objective must
// not be used by several threads at once.
class Objective {
 public:
  virtual ~Objective() = default;
  virtual Evaluation evaluate(std::span<const double> x) = 0;  // E(x)
  double value(std::span<const double> x) { return evaluate(x).value; }
  virtual void gradient(std::span<const double> x, std::span<double> g) = 0;  // g = dE/dx, n entries
  // Returns the Hessian at x, modified according to `projection`. The reference is valid until the next call.
  const BlockSparse& hessian(std::span<const double> x, const Projection& projection) {
    ++hessians_made_;
    return evaluate_hessian(x, projection);
  }
  uint64_t hessians_made() const { return hessians_made_; }       // number of calls of hessian()
  int projected_elements() const { return projected_elements_; }  // modified elements of the last Hessian

  virtual ObjectiveScales scales() const { return {}; }  // at the last evaluations
  virtual ObjectiveTraits traits() { return {}; }
  // Returns an upper bound of the feasible step lengths alpha along d.
  virtual double max_step(std::span<const double> /*x*/, std::span<const double> /*d*/) {
    return std::numeric_limits<double>::infinity();
  }
  // Called when the minimizer has moved to x, where it evaluated the last value and the last gradient.
  virtual void note_iterate(std::span<const double> /*x*/) {}
  // Called before the minimizer moves by alpha d from x, where d is a Newton direction. Up to the next call, Hessians
  // and lagged coefficients may use forces that are linearized at x. Empty: none are known.
  virtual void note_newton_step(std::span<const double> /*x*/, std::span<const double> /*d*/, double /*alpha*/) {}
  // Overrides of these two combine the results of the processes that share x.
  virtual double dot(std::span<const double> a, std::span<const double> b);
  virtual double largest(double value) { return value; }  // the maximum of the values of these processes

 protected:
  // Computes the Hessian and sets projected_elements_.
  virtual const BlockSparse& evaluate_hessian(std::span<const double> x, const Projection& projection) = 0;
  int projected_elements_ = 0;

 private:
  uint64_t hessians_made_ = 0;
};

// Optional interfaces of an objective, see ObjectiveTraits.

// Interface for objectives that define the norm of steps.
class HasMetric {
 public:
  virtual ~HasMetric() = default;
  // Returns a constant positive definite matrix that defines the norm of steps, such as the mass matrix. The default
  // for objectives without this interface is the identity.
  virtual const BlockSparse& metric() = 0;
};

// Interface for objectives that approximate the inverse of their Hessian.
class HasPreconditioner {
 public:
  virtual ~HasPreconditioner() = default;
  // Computes z = B^-1 r for a positive definite B that is constant during a minimization. Returns false if there is
  // none.
  virtual bool precondition(std::span<const double> r, std::span<double> z) = 0;
};

// Minimum feasible step length at which a Newton direction needs no stops.
inline constexpr double kUsefulStep = 0.5;

// Interface for objectives with step bounds or kinks in their gradients, such as contact and friction.
class HasStops {
 public:
  virtual ~HasStops() = default;
  // Adds springs to the last Hessian and to g, such that the minimizer of g'd + d'Hd / 2 stops at kinks that the given
  // d crosses and, if max_step < kUsefulStep, before the bounds of the steps along d. max_step: largest feasible step
  // length from x along d. Returns the Hessian, or null if nothing was added.
  virtual const BlockSparse* add_stops(std::span<const double> x, std::span<const double> d, double max_step,
                                       std::span<double> g) = 0;
};

// Interface for objectives whose Hessian has stiff rows.
class HasStiffRows {
 public:
  virtual ~HasStiffRows() = default;
  virtual const StiffRows& stiff_rows() const = 0;  // of the last Hessian
};

// Interface for objectives whose Hessian has rank-one parts that couple many variables.
class HasDenseRows {
 public:
  virtual ~HasDenseRows() = default;
  virtual const DenseRows& dense_rows() const = 0;  // of the last Hessian, which does not contain them
};

// Interface for objectives with lagged coefficients, such as the normal forces in friction.
class HasLag {
 public:
  virtual ~HasLag() = default;
  virtual bool is_lagged() const = 0;  // whether there are any
  // Evaluates them at x, or estimates them there, see Objective::note_newton_step(). keeps_directions: not the
  // directions of forces, where they are known from earlier updates.
  virtual void update_lagged(std::span<const double> x, bool keeps_directions) = 0;
  // Scales the last update if the last two alternate or repeat. Returns whether it did.
  virtual bool relax_lagged() = 0;
};

// Round-off counts as convergence only below this fraction of the forces that the gradient sums.
inline constexpr double kResolved = 1e-3;

// A subset of the variables with its own convergence test, such as one of several bodies.
struct GradientPart {
  double norm = 0;   // |g| over the part
  double scale = 1;  // characteristic size of this norm
};

// Interface for objectives whose parts converge separately. Without it, all variables form one part.
class HasParts {
 public:
  virtual ~HasParts() = default;
  virtual int part_count() const = 0;  // at least 1
  // Writes norm and scale of each part. g: the gradient evaluated last.
  virtual void measure_parts(std::span<const double> g, std::span<GradientPart> parts) = 0;
  // Returns the rounding error of |g| of the part, estimated from the last Hessian.
  virtual double part_round_off(int part) const = 0;
  // Returns |g| at x, where it was evaluated last, relative to the exactly known forces, such as weight: at most 1, and
  // 0 if it is below kResolved.
  virtual double lost_accuracy(std::span<const double> x, std::span<const GradientPart> parts) = 0;
  // Returns the largest of sqrt(-g.d / 2) / sqrt(scales().value) over the parts.
  virtual double relative_decrement(std::span<const double> g, std::span<const double> d) = 0;
};

// Treats all variables of an objective as one part.
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
