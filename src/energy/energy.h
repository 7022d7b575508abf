// One term V_k(x) of the potential energy. A call covers all the elements of the term.
#pragma once
#include <limits>
#include <memory>
#include <span>
#include <string_view>

#include "linalg/block_sparse.h"
#include "linalg/projection.h"

namespace aspic {

using Positions = std::span<const double>;  // x, 3 per vertex [m]
inline Vec3d point(Positions x, int vertex) { return {{x[3 * vertex], x[3 * vertex + 1], x[3 * vertex + 2]}}; }

// A step, or a stage of one: what an integrator says is a step from `start` that takes h, so that (x - start) / h is
// the velocity.
struct StepContext {
  Positions start;  // x at the start of the step
  double h = 0;     // length of the step [s]; 0 in statics
  double time = 0;  // of the forces: the end of the step [s], the start in explicit schemes
  // Where coefficients that depend on x are taken, when not at `start`, which may be extrapolated and inside out.
  Positions shape = {};
};

// Evaluations are functions of x and a context, and change nothing else: several threads may evaluate a term at once.
class Energy {
 public:
  // What an evaluation depends on besides x. A term that computes more for a step than its time and length derives its
  // own context; a context serves only the term that made it.
  struct Context {
    double time = 0;  // [s]
    double h = 0;     // length of the step [s]; 0 in statics
    virtual ~Context() = default;
  };

  virtual ~Energy() = default;
  virtual std::string_view name() const = 0;
  virtual bool has_constant_gradient() const { return false; }  // the same at all x, and so free of round-off

  // Before a Hessian or a context is asked for: which vertices share a 3x3 block, and where those blocks are stored.
  virtual void add_couplings(Couplings&) const {}
  virtual void bind(const BlockPattern&) {}

  virtual std::unique_ptr<Context> make_context() const { return std::make_unique<Context>(); }
  // Moving targets follow the time, damping remembers the start.
  virtual void begin_step(const StepContext& step, Context& context) const {
    context.time = step.time;
    context.h = step.h;
  }

  virtual double value(Positions x, const Context& context) const = 0;  // V(x) [J]; +inf where undefined
  // g += scale dV/dx
  virtual void add_gradient(Positions x, const Context& context, double scale, std::span<double> g) const = 0;
  // H += scale d2V/dx2; returns how many elements were projected.
  virtual int add_hessian(Positions x, const Context& context, double scale, const Projection& projection,
                          BlockSparse& H) const = 0;
  // The largest alpha for which x + alpha d is safe.
  virtual double max_step(Positions /*x*/, std::span<const double> /*d*/) const {
    return std::numeric_limits<double>::infinity();
  }
};

// A term that depends on x alone.
class SteadyEnergy : public Energy {
 public:
  using Energy::add_gradient, Energy::add_hessian, Energy::value;
  double value(Positions x) const { return value(x, {}); }
  void add_gradient(Positions x, double scale, std::span<double> g) const { add_gradient(x, {}, scale, g); }
  int add_hessian(Positions x, double scale, const Projection& projection, BlockSparse& H) const {
    return add_hessian(x, {}, scale, projection, H);
  }
};

// A term and a context of it: V as a function of x alone, until the next step begins. The term must live as long.
class ActiveTerm {
 public:
  explicit ActiveTerm(const Energy& energy) : energy_(&energy), context_(energy.make_context()) {}
  ActiveTerm(const Energy& energy, const StepContext& step) : ActiveTerm(energy) { begin_step(step); }

  void begin_step(const StepContext& step) { energy_->begin_step(step, *context_); }
  const Energy& energy() const { return *energy_; }
  const Energy::Context& context() const { return *context_; }
  std::string_view name() const { return energy_->name(); }

  double value(Positions x) const { return energy_->value(x, *context_); }
  void add_gradient(Positions x, double scale, std::span<double> g) const {
    energy_->add_gradient(x, *context_, scale, g);
  }
  int add_hessian(Positions x, double scale, const Projection& projection, BlockSparse& H) const {
    return energy_->add_hessian(x, *context_, scale, projection, H);
  }

 private:
  const Energy* energy_;
  std::unique_ptr<Energy::Context> context_;
};

}  // namespace aspic
