// E(q) = w/2 (q - q~)' M (q - q~) + f (V(q) + D(q)): its minimizer is the end of an implicit time step.
//   backward Euler: w = 1, f = h^2, q~ = q_t + h qdot_t          statics: w = 0, f = 1
// What pins hold is no variable: the gradient is zero along it, and the Hessian that of the identity (see pins.h).
#pragma once
#include <optional>
#include <span>
#include <vector>

#include "dynamics/model.h"
#include "dynamics/pins.h"
#include "optimize/objective.h"

namespace aspic {

class IncrementalPotential : public Objective, public HasMetric, public HasParts {
 public:
  IncrementalPotential(const Model& model, const Pins& pins);

  // Before begin_step: the step in which the terms of V, and those of D, are evaluated from now on.
  void tell_potential(const StepContext& step);
  void tell_damping(const StepContext& step);
  void begin_step(std::span<const double> predicted, double inertia /* w */, double factor /* f */);

  Evaluation evaluate(std::span<const double> q) override;
  void gradient(std::span<const double> q, std::span<double> g) override;
  const BlockSparse& evaluate_hessian(std::span<const double> q, const Projection& projection) override;
  void note_iterate(std::span<const double> q) override;
  const BlockSparse& metric() override;  // M, with the rows of the identity for pinned vertices
  double max_step(std::span<const double> q, std::span<const double> d) override;
  // x: the radius of the body. value: the energy of doubling the body in size, in the units of E: offsets of the
  // potential do not count. gradient_unit: g is a force times f.
  ObjectiveScales scales() const override {
    return {.x = radius_,
            .value = inertia_ * growth_inertia_ + factor_ * growth_stiffness_,
            .gradient = gradient_scale_,
            .gradient_unit = factor_,
            .gradient_round_off = gradient_round_off_};
  }
  int part_count() const override { return parts_.empty() ? 1 : static_cast<int>(parts_.size()); }
  void measure_parts(std::span<const double> g, std::span<GradientPart> parts) override;
  double part_round_off(int part) const override {
    return parts_.empty() ? gradient_round_off_ : parts_[part].round_off;
  }
  double lost_accuracy(std::span<const double> q, std::span<const GradientPart> parts) override;
  double relative_decrement(std::span<const double> g, std::span<const double> d) override;
  int part_of(int vertex) const { return part_of_.empty() ? 0 : part_of_[vertex]; }
  double growth_stiffness() const { return growth_stiffness_; }  // of V, see scales() [J]

  // The part of |g| at q, where the gradient was evaluated last, that is noise: of positions, by the stiffness of the
  // last Hessian or of the body at rest, and of the sum of forces.
  double gradient_noise(std::span<const double> q) const;
  // noise[k] += weight * that of part k [N].
  void add_part_noise(std::span<const double> q, double weight, std::span<double> noise) const;

  // What is known of the iterate at which a minimization ended: nothing there need be evaluated again. Empty elsewhere.
  std::span<const double> known_values(std::span<const double> q) const;  // of the terms of V [J]
  // gradient += weight dV/dx, damping += weight dD/dx [N]; false where they are not known.
  bool add_known_forces(std::span<const double> q, double weight, std::span<double> gradient,
                        std::span<double> damping) const;

  const std::vector<ActiveTerm>& potential() const { return potential_; }  // the terms of V: elasticity, then loads
  std::span<const ActiveTerm> loads() const { return std::span(potential_).subspan(model_.elasticity.size()); }
  const std::vector<ActiveTerm>& damping() const { return damping_; }
  const BlockPattern& pattern() const { return pattern_; }

 private:
  struct Parts {                            // of E, by terms
    std::vector<double> values;             // of V [J]
    std::vector<double> gradient, damping;  // f dV/dx and f dD/dx
  };
  // Sets the second derivative of V along a uniform growth of the body at rest, a modulus times the volume [J], its
  // moment of inertia about the center [kg m^2] and the largest distance from there [m]: the sizes by which errors are
  // judged.
  void measure(const TetMesh& mesh);
  // Divides the vertices into parts: bodies that no tet connects, and regions of a body whose moduli times edge
  // lengths differ by more than kSoft. Each is judged by its own sizes. `growth` is scratch.
  void measure_parts(const TetMesh& mesh, std::span<const double> modulus, std::span<double> growth);
  void add_part_norms(std::span<const double> v, bool is_exact);
  void add_term_gradient(const ActiveTerm& term, std::span<const double> q, std::span<double> g, std::span<double> sum);
  double free_norm(std::span<const double> v) const;
  double gradient_round_off_at(std::span<const double> q);

  struct Part {  // see measure(), for this part alone
    double growth_stiffness = 0, growth_inertia = 0, radius = 0, rest_stiffness = 0, mass_norm = 0;
    double scale = 0, round_off = 0;  // of the last gradient and Hessian
    double exact = 0;                 // the part of scale that is known to the last digit: inertia, weight, dead loads
    double sum = 0, largest = 0;      // scratch
  };

  const Model& model_;
  WholePart whole_{*this};  // where there is one part
  const Pins& pins_;
  std::vector<ActiveTerm> potential_, damping_;
  BlockPattern pattern_;
  BlockSparse H_;
  std::optional<BlockSparse> metric_;  // made when it is first asked for

  std::vector<Part> parts_;   // empty: there is one
  std::vector<int> part_of_;  // of each vertex, unless there is one
  std::vector<double> predicted_;
  std::vector<double> iterate_;  // empty: there is none yet
  Parts last_, of_iterate_;      // of what was evaluated last, wherever that was
  double inertia_ = 1, factor_ = 1;
  double growth_stiffness_ = 0, growth_inertia_ = 0, radius_ = 0;
  double rest_stiffness_ = 0, mass_norm_ = 0;  // of the diagonal blocks [N/m] and [kg]
  double exact_scale_ = 0;                     // see Part::exact
  double gradient_scale_ = 0, gradient_round_off_ = 0;
  // Scratch. offset: w (q - q~). term: one term's gradient; zero between terms. largest: |q| by chunks.
  std::vector<double> offset_, term_, largest_;
};

}  // namespace aspic
