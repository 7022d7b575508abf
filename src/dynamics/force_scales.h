// Characteristic sizes of the forces in a step, for convergence tests, and estimates of their rounding errors: of all
// vertices, and of parts, which converge separately. Parts are bodies that no tet connects, and regions of one body
// with very different stiffnesses.
#pragma once
#include <span>
#include <vector>

#include "dynamics/pins.h"
#include "dynamics/step_problem.h"
#include "dynamics/step_terms.h"
#include "optimize/objective.h"

namespace aspic {

class ForceScales : public HasParts {
 public:
  // All must outlive this.
  ForceScales(Objective& E, const Model& model, const Pins& pins) : whole_(E), E_(E), model_(model), pins_(pins) {}
  // Measures the model at rest. Sets rest_modulus of the pattern, which H has.
  void measure(std::span<const ActiveTerm> potential, BlockPattern& pattern, BlockSparse& H);

  // Adding up the norms of the forces whose sum is the gradient, in units of g = force times f.
  void begin(const StepProblem& problem);
  void begin_gradient();
  void add_inertia(std::span<const double> force);
  // is_exact: without round-off. A norm is added together with those of parts.
  void add_part_norms(std::span<const double> force, bool is_exact);
  void add_norm(double norm, bool is_exact);
  Vec3d counted_part(int vertex, const Vec3d& force) const {
    return counts_pinned_ ? force : pins_.free_part(vertex, force);
  }
  void note_hessian(std::span<const double> q, const BlockSparse& H);

  // x: radius of the body [m]. value: energy of doubling the size of the body, in units of E, without constant offsets
  // of the potential. gradient_unit: f, because g is a force times f.
  ObjectiveScales scales() const {
    return {.x = radius_,
            .value = inertia_ * growth_inertia_ + factor_ * growth_stiffness_,
            .gradient = gradient_scale_,
            .gradient_unit = factor_,
            .gradient_round_off = gradient_round_off_};
  }
  // Second derivative of V for a uniform growth of the body at rest: a modulus times the volume [J].
  double growth_stiffness() const { return growth_stiffness_; }
  int part_of(int vertex) const { return part_of_.empty() ? 0 : part_of_[vertex]; }
  // round_offs[k] += weight * rounding error of part k at q, where the gradient was evaluated last [N]. It includes the
  // rounding of positions, amplified by the stiffness of the last Hessian or of the body at rest, and of the sum of
  // forces.
  void add_part_round_off(std::span<const double> q, double weight, std::span<double> round_offs) const;

  int part_count() const override { return parts_.empty() ? 1 : static_cast<int>(parts_.size()); }
  void measure_parts(std::span<const double> g, std::span<GradientPart> parts) override;
  double part_round_off(int part) const override {
    return parts_.empty() ? gradient_round_off_ : parts_[part].round_off;
  }
  double lost_accuracy(std::span<const double> q, std::span<const GradientPart> parts) override;
  double relative_decrement(std::span<const double> g, std::span<const double> d) override;

 private:
  struct Part {  // characteristic sizes of a part, see measure()
    double growth_stiffness = 0, growth_inertia = 0, radius = 0, rest_stiffness = 0, mass_norm = 0;
    double scale = 0, round_off = 0;  // values for the last gradient and Hessian
    double exact = 0;                 // share of `scale` without rounding error: inertia, weight, dead loads
    double sum = 0, largest = 0;      // scratch
  };
  // Returns the moduli of the rows, given the unit stiffness of the vertices. Rows of angles have that of a vertex.
  std::vector<double> moduli(std::span<const double> unit, const BlockSparse& H) const;
  // Divides the rows into parts. `growth` is scratch.
  void measure_parts(std::span<const double> modulus, const BlockSparse& H, std::span<double> growth);
  int own() const { return model_.own_rows(); }  // see Share
  double free_norm(std::span<const double> v) const;
  double largest_position(std::span<const double> q) const;  // largest |q| of all vertices
  double round_off_at(std::span<const double> q, const BlockSparse& H);
  void sum_parts();  // adds Part::sum of all processes

  WholePart whole_;  // used if there is one part
  Objective& E_;
  const Model& model_;
  const Pins& pins_;
  bool counts_pinned_ = false;
  double inertia_ = 1, factor_ = 1;
  std::vector<Part> parts_;   // empty: a single part
  std::vector<int> part_of_;  // part of each row; empty: a single part
  // growth_inertia_: moment of inertia about the center [kg m^2].
  double growth_stiffness_ = 0, growth_inertia_ = 0, radius_ = 0;
  double rest_stiffness_ = 0, mass_norm_ = 0;  // norms of the diagonal blocks [N/m] and [kg]
  double exact_scale_ = 0;                     // see Part::exact
  double gradient_scale_ = 0, gradient_round_off_ = 0;
  std::vector<double> largest_;  // scratch: |q| by chunks
};

}  // namespace aspic
