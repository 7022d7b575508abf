// The incremental potential E(q) = w/2 (q - q~)' M (q - q~) + f (V(q) + D(q)). Its minimizer is the end of an implicit
// time step.
//   backward Euler: w = 1, f = h^2, q~ = q_t + h qdot_t          statics: w = 0, f = 1
// Pinned degrees of freedom are not variables: their gradient is zero, and their Hessian rows are those of the identity
// (see pins.h). Positions q, directions d and gradients g have 3 entries per vertex. Units: q, d [m]; V, D [J]; E and g
// are an energy and a force times f.
#pragma once
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "dynamics/internal_terms.h"
#include "dynamics/model.h"
#include "dynamics/pins.h"
#include "energy/pressure_rim.h"
#include "energy/stiff_energy.h"
#include "optimize/objective.h"

namespace aspic {

class IncrementalPotential : public Objective,
                             public HasMetric,
                             public HasParts,
                             public HasStops,
                             public HasStiffRows,
                             public HasLag {
 public:
  IncrementalPotential(const Model& model, const Pins& pins);  // both must outlive this

  // Set the step for subsequent evaluations of the terms of V and D. Called before begin_step().
  void set_potential_step(const StepContext& step);
  void set_damping_step(const StepContext& step);
  // Set internal variables at the start of the step and its duration [s], after set_damping_step() or instead of it for
  // terms without them. `z` must outlive the step.
  void set_internal(std::span<const double> z, double duration) { internal_.set(damping_, z, duration); }
  void set_internal_step(const StepContext& step, std::span<const double> z, double duration) {
    internal_.begin(damping_, step, z, duration);
  }
  InternalEnergies internal_energies(const InternalStep& step) const { return internal_.energies(damping_, step); }
  // Writes the internal variables at the end of a step that ends at q.
  void end_internal(std::span<const double> q, std::span<double> z) const { internal_.end(damping_, q, z); }
  // Sets the time of the obstacles [s], and that at the end of the next direction, see StepContext::obstacle_end.
  // Called after set_potential_step().
  void move_obstacles(double time, std::optional<double> end = {});
  // Sets q~ [m], w and f, and discards what is known about the last step. Called before the first evaluation.
  void begin_step(std::span<const double> predicted, double inertia /* w */, double factor /* f */);

  // Counts forces at pinned vertices among those in balance, see Criterion::scale: at rest, nothing else may balance
  // the motion of pins.
  void count_pinned_forces() { counts_pinned_ = true; }

  // Returns whether a term of D has lagged coefficients, see LaggedEnergy.
  bool is_lagged() const override;
  // Evaluates the lagged coefficients at q.
  void update_lagged(std::span<const double> q, bool keeps_directions) override;
  bool relax_lagged() override;

  // Returns E(q). Sums the magnitudes of its terms for the rounding error.
  Evaluation evaluate(std::span<const double> q) override;
  // Writes dE/dq, and keeps the gradient of each term for add_known_forces().
  void gradient(std::span<const double> q, std::span<double> g) override;
  // Computes w M + f (d2V/dq2 + d2D/dq2) and the rounding error of the gradient.
  const BlockSparse& evaluate_hessian(std::span<const double> q, const Projection& projection) override;
  // Keeps the values and forces of the last evaluation as those at q.
  void note_iterate(std::span<const double> q) override;
  double dot(std::span<const double> a, std::span<const double> b) override;
  double largest(double value) override { return model_.share.max(value); }
  const BlockSparse& metric() override;  // M, with identity rows for pinned vertices
  // Returns the smallest bound of the terms of V.
  double max_step(std::span<const double> q, std::span<const double> d) override;
  double step_limit() const { return step_limit_; }  // last result of max_step(); infinity before one in this step
  // Adds the stops of contact and friction, see HasStops.
  const BlockSparse* add_stops(std::span<const double> q, std::span<const double> d, double max_step,
                               std::span<double> g) override;
  const StiffRows& stiff_rows() const override { return stiff_rows_; }
  void note_newton_step(std::span<const double> q, std::span<const double> d) override;
  // x: radius of the body [m]. value: energy of doubling the size of the body, in units of E, without constant offsets
  // of the potential. gradient_unit: f, because g is a force times f.
  ObjectiveScales scales() const override {
    return {.x = radius_,
            .value = inertia_ * growth_inertia_ + factor_ * growth_stiffness_,
            .gradient = gradient_scale_,
            .gradient_unit = factor_,
            .gradient_round_off = gradient_round_off_};
  }
  // Parts are bodies that no tet connects, and regions of one body with very different stiffnesses.
  int part_count() const override { return parts_.empty() ? 1 : static_cast<int>(parts_.size()); }
  void measure_parts(std::span<const double> g, std::span<GradientPart> parts) override;
  double part_round_off(int part) const override {
    return parts_.empty() ? gradient_round_off_ : parts_[part].round_off;
  }
  double lost_accuracy(std::span<const double> q, std::span<const GradientPart> parts) override;
  double relative_decrement(std::span<const double> g, std::span<const double> d) override;
  // Index of the part of a vertex, see HasParts.
  int part_of(int vertex) const { return part_of_.empty() ? 0 : part_of_[vertex]; }
  double growth_stiffness() const { return growth_stiffness_; }  // growth stiffness of V, see scales() [J]

  // Returns the rounding error of |g| at q [units of g], where the gradient was evaluated last. It includes the
  // rounding of positions, amplified by the stiffness of the last Hessian or of the body at rest, and of the sum of
  // forces.
  double total_gradient_round_off(std::span<const double> q) const;
  // round_offs[k] += weight * rounding error of part k [N].
  void add_part_round_off(std::span<const double> q, double weight, std::span<double> round_offs) const;

  // Returns the values of the terms of V [J] at q, or nothing if q is not the iterate at which the last minimization
  // ended.
  std::span<const double> known_values(std::span<const double> q) const;
  // gradient += weight dV/dx, damping += weight dD/dx [N]. Returns false if they are not known at q.
  bool add_known_forces(std::span<const double> q, double weight, std::span<double> gradient,
                        std::span<double> damping) const;

  const std::vector<ActiveTerm>& potential() const { return potential_; }  // terms of V: elasticity, then loads
  // The terms of V after elasticity, and those of D, in the order of the model.
  std::span<const ActiveTerm> loads() const { return std::span(potential_).subspan(model_.elasticity.size()); }
  const std::vector<ActiveTerm>& damping() const { return damping_; }  // terms of D
  // Adds the forces of the terms of D that are rims of pressures: of all, or of one pressure.
  void add_rim_gradient(Positions q, double weight, std::span<double> g, const Energy* pressure = nullptr) const;
  bool has_rims() const { return !rims_.empty(); }
  const InternalTerms& internal() const { return internal_; }  // terms of D with internal variables
  const BlockPattern& pattern() const { return pattern_; }     // of the Hessian: one block row per vertex

 private:
  struct Terms {                            // E by terms
    std::vector<double> values;             // values of the terms of V [J]
    std::vector<double> gradient, damping;  // f dV/dx and f dD/dx
  };
  // Computes characteristic sizes: the second derivative of V for a uniform growth of the body at rest, which is a
  // modulus times the volume [J]; the moment of inertia about the center [kg m^2]; and the radius [m].
  void measure(const TetMesh& mesh);
  // Divides the vertices into parts with their own sizes: bodies that no tet connects, and regions of a body whose
  // moduli times edge lengths differ by more than kSoft. `growth` is scratch.
  void measure_parts(const TetMesh& mesh, std::span<const double> modulus, std::span<double> growth);
  void add_part_norms(std::span<const double> v, bool is_exact);
  bool is_iterate(std::span<const double> q) const;          // whether the last minimization ended at q
  void sum_parts();                                          // adds Part::sum of all processes
  double largest_position(std::span<const double> q) const;  // largest |q| of all vertices
  void add_term_gradient(const ActiveTerm& term, std::span<const double> q, std::span<double> g, std::span<double> sum);
  double squared_distance_to_prediction(std::span<const double> q) const;  // (q - q~)' M (q - q~)
  double free_norm(std::span<const double> v) const;
  Vec3d counted_part(int i, const Vec3d& force) const { return counts_pinned_ ? force : pins_.free_part(i, force); }
  double gradient_round_off_at(std::span<const double> q);

  struct Part {  // characteristic sizes of a part, see measure()
    double growth_stiffness = 0, growth_inertia = 0, radius = 0, rest_stiffness = 0, mass_norm = 0;
    double scale = 0, round_off = 0;  // values for the last gradient and Hessian
    double exact = 0;                 // share of `scale` without rounding error: inertia, weight, dead loads
    double sum = 0, largest = 0;      // scratch
  };

  const Model& model_;
  WholePart whole_{*this};  // used if there is one part
  const Pins& pins_;
  int own_;  // number of own vertices, see Share
  std::vector<ActiveTerm> potential_, damping_;
  InternalTerms internal_;
  std::vector<std::pair<const StiffEnergy*, size_t>> stiff_;  // with the index in potential_
  std::vector<std::pair<const PressureRim*, size_t>> rims_;   // with the index in damping_
  StiffRows stiff_rows_;
  BlockPattern pattern_;
  BlockSparse H_;
  std::optional<BlockSparse> metric_;  // computed on first use

  bool counts_pinned_ = false;
  std::vector<Part> parts_;   // empty: a single part
  std::vector<int> part_of_;  // part of each vertex; empty: a single part
  std::vector<double> predicted_;
  std::vector<double> iterate_;  // empty: none yet
  Terms last_, of_iterate_;      // at the last evaluation, and at the last iterate
  double inertia_ = 1, factor_ = 1;
  double growth_stiffness_ = 0, growth_inertia_ = 0, radius_ = 0;
  double rest_stiffness_ = 0, mass_norm_ = 0;  // norms of the diagonal blocks [N/m] and [kg]
  double exact_scale_ = 0;                     // see Part::exact
  double gradient_scale_ = 0, gradient_round_off_ = 0;
  double step_limit_ = std::numeric_limits<double>::infinity();
  // Scratch. offset_: w (q - q~). term_: gradient of one term; zero between terms. largest_: |q| by chunks.
  std::vector<double> offset_, term_, largest_;
};

}  // namespace aspic
