// The terms of V and D of a model, each with its context in the current step.
#pragma once
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "dynamics/internal_terms.h"
#include "dynamics/model.h"
#include "energy/pressure_rim.h"
#include "optimize/objective.h"

namespace aspic {

class StepTerms : public HasLag {
 public:
  StepTerms(const Model& model, const BlockPattern& pattern);  // both must outlive this

  const std::vector<ActiveTerm>& potential() const { return potential_; }  // terms of V: elasticity, then loads
  std::span<const ActiveTerm> loads() const {
    return std::span(potential_).subspan(elastic_);
  }                                                                    // in the order of the model
  const std::vector<ActiveTerm>& damping() const { return damping_; }  // terms of D
  const InternalTerms& internal() const { return internal_; }          // terms of D with internal variables

  // Begin a step.
  void begin(const StepContext& step);
  void begin_potential(const StepContext& step);
  void begin_damping(const StepContext& step);
  // Sets the time of the obstacles [s], and that at the end of the next direction, see StepContext::obstacle_end.
  void move_obstacles(double time, std::optional<double> end = {});

  // Set internal variables at the start of the step and its duration [s], after a step of D has begun or, for terms
  // without variables, instead of it. `z` must outlive the step.
  void set_internal(std::span<const double> z, double duration) { internal_.set(damping_, z, duration); }
  void begin_internal(const StepContext& step, std::span<const double> z, double duration) {
    internal_.begin(damping_, step, z, duration);
  }
  InternalEnergies internal_energies(const InternalStep& step) const { return internal_.energies(damping_, step); }
  // Writes the internal variables at the end of a step that ends at q.
  void end_internal(Positions q, std::span<double> z) const { internal_.end(damping_, q, z); }

  bool has_rims() const { return !rims_.empty(); }
  // Adds the forces of the terms of D that are rims of pressures: of all, or of one pressure.
  void add_rim_gradient(Positions q, double weight, std::span<double> g, const Energy* pressure = nullptr) const;

  void note_newton_step(std::span<const double> q, std::span<const double> d, double alpha);

  bool is_lagged() const override;
  void update_lagged(std::span<const double> q, bool keeps_directions) override;
  bool relax_lagged() override;
  int lag_updates() const { return lag_updates_; }  // number of changes of lagged coefficients

 private:
  const Energy* contact_;
  size_t elastic_;  // number of elastic terms
  std::vector<ActiveTerm> potential_, damping_;
  InternalTerms internal_;
  std::vector<std::pair<const PressureRim*, size_t>> rims_;  // with the index in damping_
  int lag_updates_ = 0;
};

}  // namespace aspic
