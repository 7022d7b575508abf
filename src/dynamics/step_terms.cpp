#include "dynamics/step_terms.h"

#include <algorithm>

#include "contact/barrier.h"

namespace aspic {

StepTerms::StepTerms(const Model& model, const BlockPattern& pattern)
    : contact_(model.contact), elastic_(model.elasticity.size()), internal_(model) {
  const auto add = [&pattern](Energy& term, std::vector<ActiveTerm>& terms) {
    term.bind(pattern);
    terms.emplace_back(term);
  };
  for (const auto& V : model.elasticity) add(*V, potential_);
  for (const auto& V : model.loads) add(*V, potential_);
  for (const auto& D : model.damping) add(*D, damping_);
  for (size_t k = 0; k < damping_.size(); ++k)
    if (const auto* rim = dynamic_cast<const PressureRim*>(&damping_[k].energy())) rims_.emplace_back(rim, k);
}

void StepTerms::begin(const StepContext& step) {
  begin_potential(step);
  begin_damping(step);
}

void StepTerms::begin_potential(const StepContext& step) {
  for (ActiveTerm& V : potential_) V.begin_step(step);
}

void StepTerms::begin_damping(const StepContext& step) {
  for (ActiveTerm& D : damping_) D.begin_step(step);
}

void StepTerms::move_obstacles(double time, std::optional<double> end) {
  for (ActiveTerm& V : potential_)
    if (&V.energy() == contact_) V.begin_step({.h = V.context().h, .time = time, .obstacle_end = end});
}

void StepTerms::add_rim_gradient(Positions q, double weight, std::span<double> g, const Energy* pressure) const {
  for (const auto& [rim, k] : rims_)
    if (!pressure || pressure == &rim->pressure()) damping_[k].add_gradient(q, weight, g);
}

void StepTerms::note_newton_step(std::span<const double> q, std::span<const double> d, double alpha) {
  for (auto* terms : {&potential_, &damping_})
    for (ActiveTerm& term : *terms) term.note_newton_step(q, d, alpha);
}

bool StepTerms::is_lagged() const {
  return std::any_of(damping_.begin(), damping_.end(), [](const ActiveTerm& D) { return D.is_lagged(); });
}

void StepTerms::update_lagged(std::span<const double> q, bool keeps_directions) {
  for (ActiveTerm& D : damping_) D.update_lagged(q, keeps_directions);
  if (is_lagged()) ++lag_updates_;
}

bool StepTerms::relax_lagged() {
  bool is_relaxed = false;
  for (ActiveTerm& D : damping_) is_relaxed = D.relax_lagged() || is_relaxed;
  if (is_relaxed) ++lag_updates_;
  return is_relaxed;
}

}  // namespace aspic
