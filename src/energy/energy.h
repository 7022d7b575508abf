// One term V_k(x) of the potential energy, or one dissipation potential. Each call processes all elements of the term.
#pragma once
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string_view>

#include "linalg/block_sparse.h"
#include "linalg/projection.h"

namespace aspic {

struct TetMesh;

using Positions = std::span<const double>;  // x, 3 per vertex [m]
inline Vec3d point(Positions x, int vertex) { return {{x[3 * vertex], x[3 * vertex + 1], x[3 * vertex + 2]}}; }

// A time step or a stage of it, with the velocity (x - start) / h.
struct StepContext {
  Positions start;  // x at the start of the step; integrators may extrapolate it
  double h = 0;     // length of the step [s]; 0 in statics
  double time = 0;  // time at which forces act [s]: the end of the step, or its start in explicit schemes
  // Positions at which coefficients that depend on x are evaluated. Empty: `start`.
  Positions shape = {};
  std::optional<double> obstacle_time = {};  // time of moving obstacles at the start [s]; empty: time - h
  // Time of the obstacles one step before the start [s], if `start` is extrapolated as x + (x - x of that time) / 3.
  std::optional<double> obstacle_before = {};
  // Time to which moving obstacles advance along the next direction [s], see Barrier. Empty: `time`.
  std::optional<double> obstacle_end = {};
};

// An energy is a function of the positions x and of a context. Evaluations change neither the energy nor the context,
// so several threads may evaluate the same term. Positions, gradients and directions have 3 entries per vertex.
class Energy {
 public:
  // Inputs of an evaluation besides x. A term that needs more than the time and the length of the step derives its own
  // context. A context may be used only with the term that made it.
  struct Context {
    double time = 0;                     // [s]
    double h = 0;                        // length of the step [s]; 0 in statics
    std::optional<double> obstacle_end;  // see StepContext
    virtual ~Context() = default;
  };

  virtual ~Energy() = default;
  virtual std::string_view name() const = 0;  // in reports, such as "gravity"
  // Returns whether dV/dx is independent of x. Such a gradient has no round-off.
  virtual bool has_constant_gradient() const { return false; }

  // Appends the vertex pairs that share a 3x3 block of the Hessian.
  virtual void add_couplings(Couplings&) const {}
  // Stores the slots of these blocks in the pattern. Called before the first Hessian and the first context.
  virtual void bind(const BlockPattern&) {}

  // Returns a context of this term at time 0. Called after bind().
  virtual std::unique_ptr<Context> make_context() const { return std::make_unique<Context>(); }
  // Prepares the context for a step. Overrides update targets to step.time or store step.start for damping.
  virtual void begin_step(const StepContext& step, Context& context) const {
    context.time = step.time;
    context.h = step.h;
    context.obstacle_end = step.obstacle_end;
  }

  virtual double value(Positions x, const Context& context) const = 0;  // V(x) [J]; +inf where V is undefined
  // g += scale dV/dx  [N]
  virtual void add_gradient(Positions x, const Context& context, double scale, std::span<double> g) const = 0;
  // H += scale d2V/dx2 [N/m], with element Hessians modified according to `projection`. Returns the number of modified
  // elements.
  virtual int add_hessian(Positions x, const Context& context, double scale, const Projection& projection,
                          BlockSparse& H) const = 0;
};

// Optional interfaces of a term. ActiveTerm looks for them once.

// A term with lagged coefficients, such as the normal forces in friction.
class LaggedEnergy {
 public:
  virtual ~LaggedEnergy() = default;
  // Evaluates them at x. keeps_directions: not the directions, where they are known from earlier in the step.
  virtual void update_lagged(Positions x, bool keeps_directions, Energy::Context& context) const = 0;
  // Scales the last update if the last two alternate or repeat. Returns whether it did.
  virtual bool relax_lagged(Energy::Context& context) const = 0;
};

// A term whose forces vary much between iterates, but little between their linearizations.
class PredictingEnergy {
 public:
  virtual ~PredictingEnergy() = default;
  // Notes Newton's step alpha d from x. Until the next call or step, Hessians and lagged coefficients may use forces
  // that are linearized at x instead of those at the next x: Newton's method for both positions and forces, which needs
  // fewer iterations. Empty spans: none.
  virtual void note_newton_step(Positions x, std::span<const double> d, double alpha,
                                Energy::Context& context) const = 0;
};

// A term that is not defined beyond some steps, such as a barrier.
class StepLimitingEnergy {
 public:
  virtual ~StepLimitingEnergy() = default;
  // Returns an upper bound of the step lengths alpha for which the term allows the path from x to x + alpha d.
  virtual double max_step(Positions x, const Energy::Context& context, std::span<const double> d) const = 0;
};

// A term in the tets of a body besides its elasticity, such as fibres.
class TetEnergy {
 public:
  virtual ~TetEnergy() = default;
  virtual int first_tet() const = 0;  // of its consecutive tets in the mesh
  // Returns the energy of the same tets of another mesh, such as one of quadratic tets.
  virtual std::unique_ptr<Energy> on(const TetMesh& mesh) const = 0;
};

// The quadratic model scale (g'd + d'Hd / 2) of V around x; g and H include the scale.
struct ScaledModel {
  double scale;
  std::span<double> g;
  BlockSparse& H;
};

// A term that keeps the minimizer of a quadratic model from bounds of the steps and from kinks of V.
class StoppingEnergy {
 public:
  virtual ~StoppingEnergy() = default;
  // Adds springs of energy S along the given d: g += scale dS/dd at d = 0, H += scale d2S/dd2. Returns their number.
  virtual int add_stops(Positions x, const Energy::Context& context, std::span<const double> d,
                        const ScaledModel& model) const = 0;
};

// A term that depends only on x.
class SteadyEnergy : public Energy {
 public:
  using Energy::add_gradient, Energy::add_hessian, Energy::value;
  double value(Positions x) const { return value(x, {}); }
  void add_gradient(Positions x, double scale, std::span<double> g) const { add_gradient(x, {}, scale, g); }
  int add_hessian(Positions x, double scale, const Projection& projection, BlockSparse& H) const {
    return add_hessian(x, {}, scale, projection, H);
  }
};

// A term with its context, which its functions pass to those of the same name. Between two calls of begin_step(), V is
// a function of x alone. The term must outlive it.
class ActiveTerm {
 public:
  explicit ActiveTerm(const Energy& energy)
      : energy_(&energy),
        lagged_(dynamic_cast<const LaggedEnergy*>(&energy)),
        limit_(dynamic_cast<const StepLimitingEnergy*>(&energy)),
        stops_(dynamic_cast<const StoppingEnergy*>(&energy)),
        predicts_(dynamic_cast<const PredictingEnergy*>(&energy)),
        context_(energy.make_context()) {}
  ActiveTerm(const Energy& energy, const StepContext& step) : ActiveTerm(energy) { begin_step(step); }

  // Prepares the context for a step.
  void begin_step(const StepContext& step) { energy_->begin_step(step, *context_); }
  bool is_lagged() const { return lagged_; }
  void update_lagged(Positions x, bool keeps_directions) {
    if (lagged_) lagged_->update_lagged(x, keeps_directions, *context_);
  }
  bool relax_lagged() { return lagged_ && lagged_->relax_lagged(*context_); }
  void note_newton_step(Positions x, std::span<const double> d, double alpha) {
    if (predicts_) predicts_->note_newton_step(x, d, alpha, *context_);
  }
  const Energy& energy() const { return *energy_; }
  const Energy::Context& context() const { return *context_; }
  std::string_view name() const { return energy_->name(); }

  double value(Positions x) const { return energy_->value(x, *context_); }
  void add_gradient(Positions x, double scale, std::span<double> g) const {
    energy_->add_gradient(x, *context_, scale, g);
  }
  double max_step(Positions x, std::span<const double> d) const {
    return limit_ ? limit_->max_step(x, *context_, d) : std::numeric_limits<double>::infinity();
  }
  int add_hessian(Positions x, double scale, const Projection& projection, BlockSparse& H) const {
    return energy_->add_hessian(x, *context_, scale, projection, H);
  }
  int add_stops(Positions x, std::span<const double> d, const ScaledModel& model) const {
    return stops_ ? stops_->add_stops(x, *context_, d, model) : 0;
  }

 private:
  const Energy* energy_;
  const LaggedEnergy* lagged_;  // null: the term lacks the interface
  const StepLimitingEnergy* limit_;
  const StoppingEnergy* stops_;
  const PredictingEnergy* predicts_;
  std::unique_ptr<Energy::Context> context_;
};

}  // namespace aspic
