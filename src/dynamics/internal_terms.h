// The damping terms of a model with internal variables (energy/internal_variables.h). State::internal holds those of
// one term after the other.
#pragma once
#include <span>
#include <string>
#include <vector>

#include "dynamics/model.h"
#include "dynamics/state.h"
#include "energy/internal_variables.h"

namespace aspic {

struct IntegratorFacts;

class InternalTerms {
 public:
  explicit InternalTerms(const Model& model);  // the model must outlive this

  bool empty() const { return terms_.empty(); }
  size_t size() const { return size_; }            // number of internal variables
  std::vector<std::string> names() const;          // of the terms
  std::vector<double> initial(Positions x) const;  // at the start of a simulation at x

  // `damping`: the terms of Model::damping with their contexts.
  void begin(std::span<ActiveTerm> damping, const StepContext& step, std::span<const double> z, double duration) const;
  // Sets the values at the start of a step that has begun.
  void set(std::span<const ActiveTerm> damping, std::span<const double> z, double duration) const;
  void end(std::span<const ActiveTerm> damping, Positions x, std::span<double> z) const;
  InternalEnergies energies(std::span<const ActiveTerm> damping, const InternalStep& step) const;  // sums
  void append_stored(std::span<const double> z, std::vector<double>& energies) const;              // one per term [J]

  // Adds the energy of bending of terms that are BendingElements to the density of each element [J/m^3].
  void add_bending_density(Positions x, std::span<const double> z, std::span<double> density) const;

  // Reorder the internal variables of a state.
  std::vector<double> to_user(std::span<const double> z, const Renumbering& tet) const;
  std::vector<double> from_user(std::span<const double> z, const Renumbering& tet) const;

  // Throws InvalidInput if there are terms and the integrator does not advance internal variables.
  void require_support(const IntegratorFacts& integrator) const;

 private:
  struct Term {
    const InternalVariables* variables;
    size_t index;  // in Model::damping
    std::string name;
    size_t first;  // in State::internal
  };
  template <class T>
  static std::span<T> part(const Term& term, std::span<T> z) {
    return z.empty() ? z : z.subspan(term.first, term.variables->internal_range().size());
  }
  // Calls copy(user, stored, count) for the first internal variable of each tet in both orders.
  template <class Copy>
  void for_each_tet(const Renumbering& tet, const Copy& copy) const;

  std::vector<Term> terms_;
  size_t size_ = 0;
};

// Returns the energy of bending and twist per volume at rest of each element [J/m^3], 0 for tets; empty if there are
// neither sheets nor rods. `z`: State::internal at x.
std::vector<double> bending_density(const Model& model, Positions x, std::span<const double> z);

}  // namespace aspic
