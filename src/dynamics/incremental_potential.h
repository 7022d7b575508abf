// The incremental potential E(q) = w/2 (q - q~)' M (q - q~) + f (V(q) + D(q)) of a StepProblem. Its minimizer is the
// end of an implicit time step. Pinned degrees of freedom are not variables: their gradient is zero, and their Hessian
// rows are those of the identity (see pins.h). Positions q, directions d and gradients g have 3 entries per vertex.
// Units: q, d [m]; V, D [J]; E and g are an energy and a force times f.
#pragma once
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "dynamics/force_scales.h"
#include "dynamics/model.h"
#include "dynamics/pins.h"
#include "dynamics/step_problem.h"
#include "dynamics/step_terms.h"
#include "dynamics/term_rows.h"
#include "optimize/objective.h"

namespace aspic {

class IncrementalPotential : public Objective, public HasMetric, public HasStops {
 public:
  IncrementalPotential(const Model& model, const Pins& pins);  // both must outlive this

  // Evaluates this problem from now on, and discards what is known about the last one. Called before the first
  // evaluation.
  void at(const StepProblem& problem);

  // Returns E(q). Sums the magnitudes of its terms for the rounding error.
  Evaluation evaluate(std::span<const double> q) override;
  // Writes dE/dq, and keeps the gradient of each term for add_known_forces().
  void gradient(std::span<const double> q, std::span<double> g) override;
  // Computes w M + f (d2V/dq2 + d2D/dq2) and the rounding error of the gradient.
  const BlockSparse& evaluate_hessian(std::span<const double> q, const Projection& projection) override;
  // Keeps the values and forces of the last evaluation as those at q.
  void note_newton_step(std::span<const double> q, std::span<const double> d, double alpha) override {
    terms_.note_newton_step(q, d, alpha);
  }
  void note_iterate(std::span<const double> q) override;
  double dot(std::span<const double> a, std::span<const double> b) override;
  double largest(double value) override { return model_.share.max(value); }
  const BlockSparse& metric() override;  // M, with identity rows for pinned vertices
  // Returns the smallest bound of the terms of V.
  double max_step(std::span<const double> q, std::span<const double> d) override;
  double step_limit() const { return step_limit_; }  // last result of max_step(); infinity before one in this problem
  // Adds the stops of contact and friction, see HasStops.
  const BlockSparse* add_stops(std::span<const double> q, std::span<const double> d, double max_step,
                               std::span<double> g) override;
  ObjectiveScales scales() const override { return sizes_.scales(); }
  ObjectiveTraits traits() override;

  // Returns the values of the terms of V [J] at q, or nothing if q is not the iterate at which the last minimization
  // ended.
  std::span<const double> known_values(std::span<const double> q) const;
  // gradient += weight dV/dx, damping += weight dD/dx [N]. Returns false if they are not known at q.
  bool add_known_forces(std::span<const double> q, double weight, std::span<double> gradient,
                        std::span<double> damping) const;

  StepTerms& terms() { return terms_; }  // V and D
  const StepTerms& terms() const { return terms_; }
  const ForceScales& sizes() const { return sizes_; }
  const BlockPattern& pattern() const { return pattern_; }  // of the Hessian: one block row per vertex

 private:
  struct Sums {                             // E by terms
    std::vector<double> values;             // values of the terms of V [J]
    std::vector<double> gradient, damping;  // f dV/dx and f dD/dx
  };
  bool is_iterate(std::span<const double> q) const;  // whether the last minimization ended at q
  void add_term_gradient(const ActiveTerm& term, std::span<const double> q, std::span<double> g, std::span<double> sum);
  double squared_distance_to_prediction(std::span<const double> q) const;  // (q - q~)' M (q - q~)

  const Model& model_;
  const Pins& pins_;
  int own_;  // number of own vertices, see Share
  BlockPattern pattern_;
  StepTerms terms_;
  TermRows rows_;
  ForceScales sizes_;
  BlockSparse H_;
  std::optional<BlockSparse> metric_;  // computed on first use

  std::vector<double> predicted_;
  double inertia_ = 1, factor_ = 1;
  std::vector<double> iterate_;  // empty: none yet
  int iterate_lag_ = 0;          // StepTerms::lag_updates() then: later ones change its forces
  Sums last_, of_iterate_;       // at the last evaluation, and at the last iterate
  double step_limit_ = std::numeric_limits<double>::infinity();
  // Scratch. offset_: w (q - q~). term_: gradient of one term; zero between terms.
  std::vector<double> offset_, term_;
};

}  // namespace aspic
