#include "dynamics/internal_terms.h"

#include <algorithm>

#include "base/error.h"
#include "dynamics/integrator_facts.h"
#include "energy/bending_density.h"

namespace aspic {

InternalTerms::InternalTerms(const Model& model) {
  for (size_t k = 0; k < model.damping.size(); ++k) {
    const auto* variables = dynamic_cast<const InternalVariables*>(model.damping[k].get());
    if (!variables) continue;
    terms_.push_back({variables, k, std::string(model.damping[k]->name()), size_});
    size_ += variables->internal_range().size();
  }
}

std::vector<std::string> InternalTerms::names() const {
  std::vector<std::string> names;
  for (const Term& term : terms_) names.push_back(term.name);
  return names;
}

std::vector<double> InternalTerms::initial(Positions x) const {
  std::vector<double> z(size_);
  for (const Term& term : terms_) term.variables->write_initial(x, part(term, std::span(z)));
  return z;
}

void InternalTerms::begin(std::span<ActiveTerm> damping, const StepContext& step, std::span<const double> z,
                          double duration) const {
  for (const Term& term : terms_) damping[term.index].begin_step(step);
  set(damping, z, duration);
}

void InternalTerms::set(std::span<const ActiveTerm> damping, std::span<const double> z, double duration) const {
  for (const Term& term : terms_)
    term.variables->begin_internal(part(term, z), duration, damping[term.index].context());
}

void InternalTerms::end(std::span<const ActiveTerm> damping, Positions x, std::span<double> z) const {
  for (const Term& term : terms_) term.variables->end_internal(x, damping[term.index].context(), part(term, z));
}

InternalEnergies InternalTerms::energies(std::span<const ActiveTerm> damping, const InternalStep& step) const {
  InternalEnergies sum;
  for (const Term& term : terms_) {
    const InternalEnergies own = term.variables->internal_energies({step.start, step.end, part(term, step.z_end)},
                                                                   damping[term.index].context());
    sum.work += own.work;
    sum.gain += own.gain;
    sum.loss += own.loss;
  }
  return sum;
}

void InternalTerms::append_stored(std::span<const double> z, std::vector<double>& energies) const {
  for (const Term& term : terms_) energies.push_back(term.variables->stored_energy(part(term, z)));
}

// The tets of a body are consecutive in both orders.
template <class Copy>
void InternalTerms::for_each_tet(const Renumbering& tet, const Copy& copy) const {
  for (const Term& term : terms_) {
    const InternalRange range = term.variables->internal_range();
    for (int t = range.first_tet; t < range.first_tet + range.tet_count; ++t) {
      const auto place = [&](int own) {
        return term.first + static_cast<size_t>(own - range.first_tet) * range.per_tet;
      };
      copy(place(tet.to_user(t)), place(t), static_cast<size_t>(range.per_tet));
    }
  }
}

std::vector<double> InternalTerms::to_user(std::span<const double> z, const Renumbering& tet) const {
  std::vector<double> user(z.size());
  if (!z.empty())
    for_each_tet(tet, [&](size_t to, size_t from, size_t count) { std::copy_n(&z[from], count, &user[to]); });
  return user;
}

std::vector<double> InternalTerms::from_user(std::span<const double> z, const Renumbering& tet) const {
  std::vector<double> stored(z.size());
  if (!z.empty())
    for_each_tet(tet, [&](size_t from, size_t to, size_t count) { std::copy_n(&z[from], count, &stored[to]); });
  return stored;
}

void InternalTerms::require_support(const IntegratorFacts& integrator) const {
  if (empty() || integrator.is_backward_euler || integrator.is_static()) return;
  throw InvalidInput("integrator = '" + std::string(integrator.name) +
                     "' does not advance the internal variables of '" + terms_[0].name +
                     "'; choose backward_euler, or quasi_static without inertia");
}

void InternalTerms::add_bending_density(Positions x, std::span<const double> z, std::span<double> density) const {
  for (const Term& term : terms_)
    if (const auto* bending = dynamic_cast<const BendingElements*>(term.variables))
      bending->add_bending_density(x, part(term, z), density);
}

std::vector<double> bending_density(const Model& model, Positions x, std::span<const double> z) {
  if (model.mesh.element_count() == model.mesh.tet_count()) return {};
  std::vector<double> density(model.mesh.element_count(), 0.0);
  for (const auto& V : model.elasticity)
    if (const auto* bending = dynamic_cast<const BendingElements*>(V.get()))
      bending->add_bending_density(x, {}, density);
  InternalTerms(model).add_bending_density(x, z, density);
  return density;
}

}  // namespace aspic
