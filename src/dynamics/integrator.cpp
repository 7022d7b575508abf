#include "dynamics/integrator.h"

#include <array>

#include "base/error.h"
#include "dynamics/advance_boundary.h"
#include "dynamics/runge_kutta_tables.h"
#include "dynamics/simulation.h"

namespace aspic {
namespace {

template <const Tableau& scheme>
std::unique_ptr<Integrator> runge_kutta() {
  return make_runge_kutta(scheme);
}

// All integrators, in the order of help texts.
// clang-format off
constexpr std::array kSchemes = {
    make_backward_euler,
    make_linearly_implicit_euler,
    make_bdf2,
    runge_kutta<kTrBdf2>,
    runge_kutta<kMidpoint>,
    runge_kutta<kTrapezoid>,
    make_symplectic_euler,
    make_forward_euler,
    runge_kutta<kRk4>,
    make_quasi_static,
};
// clang-format on

// Returns the rank of a status, from best to worst.
int rank_of(Status status) {
  constexpr std::array kOrder = {Status::converged, Status::round_off,  Status::budget,    Status::iteration_limit,
                                 Status::stuck,     Status::no_descent, Status::undefined, Status::interrupted};
  int rank = 0;
  for (const Status s : kOrder) {
    if (s == status) break;
    ++rank;
  }
  return rank;
}

}  // namespace

void StepForces::reset(size_t size) {
  for (auto* v : {&gradient, &damping, &rims, &acceleration}) v->assign(size, 0.0);
  for (auto* v : {&thresholds, &round_offs}) std::fill(v->begin(), v->end(), 0.0);
}

void StepForces::resize_bounds(const IncrementalPotential& E) {
  for (auto* v : {&thresholds, &round_offs}) v->resize(E.sizes().part_count());
}

void StepForces::add_round_off(const IncrementalPotential& E, double round_off) {
  resize_bounds(E);
  for (double& r : round_offs) r += round_off;
}

void StepForces::add_bounds(const SolveTools& tools, ResidualBound bound, double weight, Positions x) {
  resize_bounds(tools.E);
  tools.E.sizes().add_part_round_off(x, weight, round_offs);
  if (bound == ResidualBound::none || tests_direction(tools.options.criterion)) return;
  const std::span<const double> bounds = tools.minimizer.thresholds();
  for (size_t k = 0; k < thresholds.size(); ++k) thresholds[k] += weight * (bounds[k] / tools.E.scales().gradient_unit);
}

void StepForces::add(const IncrementalPotential& E, double weight, Positions x, std::span<const double> acc,
                     Work& work) {
  if (!E.add_known_forces(x, weight, gradient, damping)) {
    ++work.gradients;
    for (const ActiveTerm& V : E.terms().potential()) V.add_gradient(x, weight, gradient);
    for (const ActiveTerm& D : E.terms().damping()) D.add_gradient(x, weight, damping);
  }
  E.terms().add_rim_gradient(x, weight, rims);
  for (size_t i = 0; i < acc.size(); ++i) acceleration[i] += weight * acc[i];
}

bool StepSolve::add(const MinimizeReport& stage) {
  add_work(stage, work);
  work.value = stage.value;
  work.gradient_norm = stage.gradient_norm;
  work.lost_accuracy = std::max(work.lost_accuracy, stage.lost_accuracy);
  if (rank_of(stage.status) > rank_of(work.status)) work.status = stage.status;
  return stage.status != Status::undefined && stage.status != Status::interrupted;
}

namespace {

template <class Predicate>
std::vector<std::string> names_where(const Predicate& holds) {
  std::vector<std::string> names;
  for (const auto& make : kSchemes)
    if (const IntegratorFacts facts = make()->facts(); holds(facts)) names.emplace_back(facts.name);
  return names;
}

}  // namespace

std::vector<std::string> integrator_names() {
  return names_where([](const IntegratorFacts&) { return true; });
}

std::vector<std::string> adaptive_integrator_names() {
  return names_where([](const IntegratorFacts& i) { return !i.is_static() && !i.is_multistep; });
}

std::unique_ptr<Integrator> make_integrator(std::string_view name) {
  for (const auto& make : kSchemes)
    if (auto integrator = make(); integrator->facts().name == name) return integrator;
  throw InvalidInput("integrator = '" + std::string(name) + "' is unknown" + suggestion(name, integrator_names()));
}

void Integrator::set_pin_velocity(const Pins& pins, double h, State& state) const {
  std::vector<double> next = state.q;
  pins.place(state.time + h, next);
  for (size_t i = 0; i < next.size(); ++i) next[i] = (next[i] - state.q[i]) / h;
  pins.copy_held(next, state.qdot);
}

}  // namespace aspic
