#include "optimize/solver.h"

#include <algorithm>

#include "base/error.h"
#include "linalg/linear_solver.h"
#include "optimize/fallback_chain.h"
#include "optimize/gradient_descent.h"
#include "optimize/lbfgs.h"
#include "optimize/newton.h"
#include "optimize/nonlinear_cg.h"
#include "optimize/preconditioner.h"

namespace aspic {
namespace {

using Direction = std::unique_ptr<SearchDirection>;

struct Method {
  std::string name;
  Direction (*make)(const SolverOptions&);
  bool estimates_minimizer = false, solves_systems = false, uses_definiteness = false;
  std::optional<PreconditionerKind> preconditioner = {};  // the default, if the method uses one
};
const Method* method_named(const std::string& name);

// Returns the given preconditioner, or the default of the method.
Preconditioner preconditioner(const SolverOptions& options, const std::string& method) {
  PreconditionerKind chosen = *method_named(method)->preconditioner;
  for (const PreconditionerKind kind : all_preconditioners())
    if (to_string(kind) == options.preconditioner) chosen = kind;
  return Preconditioner(chosen, options.linear);
}

Direction make_newton(const SolverOptions& options) {
  return std::make_unique<Newton>(make_linear_solver(options.linear), definiteness_of(options));
}
Direction make_truncated_newton(const SolverOptions& options) { return make_newton_cg(definiteness_of(options)); }
Direction make_lbfgs(const SolverOptions& options) { return std::make_unique<LBFGS>(preconditioner(options, "lbfgs")); }
Direction make_nonlinear_cg(const SolverOptions& options) {
  return std::make_unique<NonlinearCG>(preconditioner(options, "nonlinear_cg"));
}
Direction make_gradient_descent(const SolverOptions& options) {
  return std::make_unique<GradientDescent>(preconditioner(options, "gradient_descent"));
}

const std::vector<Method>& methods() {
  using enum PreconditionerKind;
  static const std::vector<Method> table = {
      {.name = "newton",
       .make = make_newton,
       .estimates_minimizer = true,
       .solves_systems = true,
       .uses_definiteness = true},
      {.name = "newton_cg", .make = make_truncated_newton, .estimates_minimizer = true, .uses_definiteness = true},
      {.name = "lbfgs", .make = make_lbfgs, .preconditioner = hessian},
      {.name = "nonlinear_cg", .make = make_nonlinear_cg, .preconditioner = hessian},
      {.name = "gradient_descent", .make = make_gradient_descent, .preconditioner = none},
  };
  return table;
}

const Method* method_named(const std::string& name) {
  for (const Method& method : methods())
    if (method.name == name) return &method;
  return nullptr;
}

std::string quoted(const std::string& option, const std::string& value) { return option + " = '" + value + "'"; }

std::optional<SolverConflict> unknown_name(const std::string& option, const std::string& value,
                                           const std::vector<std::string>& known) {
  if (std::find(known.begin(), known.end(), value) != known.end()) return std::nullopt;
  return SolverConflict{option, quoted(option, value) + " is unknown" + suggestion(value, known)};
}

bool factorizes(const Method& method, const SolverOptions& options) {
  if (!method.preconditioner) return method.solves_systems;
  if (options.preconditioner != "auto") return options.preconditioner == to_string(PreconditionerKind::hessian);
  return method.preconditioner == PreconditionerKind::hessian;
}

// Requires that one of the selected methods uses this value of the option.
template <class Uses>
std::optional<SolverConflict> unused(const std::string& option, const std::string& value,
                                     const std::vector<const Method*>& chosen, const Uses& uses) {
  if (value == "auto" || std::any_of(chosen.begin(), chosen.end(), uses)) return std::nullopt;
  std::string others;
  for (const Method& method : methods())
    if (uses(&method)) others += (others.empty() ? "" : ", ") + method.name;
  return SolverConflict{option, quoted(option, value) + " has no effect on " + chosen.front()->name +
                                    "; methods that use it: " + others + " (or leave it at 'auto')"};
}

std::optional<SolverConflict> criterion_conflict(const SolverOptions& options,
                                                 const std::vector<const Method*>& chosen) {
  if (!tests_direction(options.minimize.criterion)) return std::nullopt;
  for (const Method* method : chosen)
    if (!method->estimates_minimizer)
      return SolverConflict{"criterion", quoted("criterion", std::string(to_string(options.minimize.criterion))) +
                                             " needs the method newton or newton_cg: directions of " + method->name +
                                             " do not estimate the distance to the minimum (try 'scale')"};
  return std::nullopt;
}

}  // namespace

std::vector<std::string> minimizer_names() {
  std::vector<std::string> names;
  for (const Method& method : methods()) names.push_back(method.name);
  return names;
}

std::vector<std::string> preconditioner_names() {
  std::vector<std::string> names = {"auto"};
  for (const PreconditionerKind kind : all_preconditioners()) names.emplace_back(to_string(kind));
  return names;
}

NewtonDefiniteness definiteness_of(const SolverOptions& options) {
  for (const NewtonDefiniteness d : all_definiteness())
    if (to_string(d) == options.definiteness) return d;
  return NewtonDefiniteness::on_demand;
}

std::vector<std::string> definiteness_names() {
  std::vector<std::string> names = {"auto"};
  for (const NewtonDefiniteness d : all_definiteness()) names.emplace_back(to_string(d));
  return names;
}

std::vector<std::string> criterion_names() {
  std::vector<std::string> names;
  for (const Criterion criterion : all_criteria()) names.emplace_back(to_string(criterion));
  return names;
}

std::vector<std::string> decrease_test_names() { return {"textbook", "slide", "none"}; }

Criterion criterion_named(const std::string& name) {
  for (const Criterion criterion : all_criteria())
    if (to_string(criterion) == name) return criterion;
  throw InvalidInput("criterion = '" + name + "' is unknown" + suggestion(name, criterion_names()));
}

DecreaseTest decrease_test_named(const std::string& name) {
  if (name == "textbook") return DecreaseTest::textbook;
  if (name == "slide") return DecreaseTest::slide;
  if (name == "none") return DecreaseTest::none;
  throw InvalidInput("test = '" + name + "' is unknown" + suggestion(name, decrease_test_names()));
}

std::optional<SolverConflict> find_conflict(const SolverOptions& options) {
  if (auto wrong = unknown_name("method", options.method, minimizer_names())) return wrong;
  std::vector<const Method*> chosen = {method_named(options.method)};
  for (const std::string& name : options.fallback) {
    if (auto wrong = unknown_name("fallback", name, minimizer_names())) return wrong;
    chosen.push_back(method_named(name));
  }
  if (auto wrong = unknown_name("preconditioner", options.preconditioner, preconditioner_names())) return wrong;
  if (auto wrong = unknown_name("linear", options.linear, linear_solver_names())) return wrong;
  if (auto wrong = unknown_name("definiteness", options.definiteness, definiteness_names())) return wrong;
  if (auto wrong = unused("preconditioner", options.preconditioner, chosen,
                          [](const Method* m) { return m->preconditioner.has_value(); }))
    return wrong;
  if (auto wrong = unused("linear", options.linear, chosen, [&](const Method* m) { return factorizes(*m, options); }))
    return wrong;
  if (auto wrong =
          unused("definiteness", options.definiteness, chosen, [](const Method* m) { return m->uses_definiteness; }))
    return wrong;
  return criterion_conflict(options, chosen);
}

bool estimates_minimizer(const std::string& method) {
  const Method* known = method_named(method);
  return known && known->estimates_minimizer;
}

std::unique_ptr<SearchDirection> make_search_direction(const SolverOptions& options) {
  if (const auto conflict = find_conflict(options)) throw InvalidInput(conflict->reason);
  if (options.fallback.empty()) return method_named(options.method)->make(options);
  std::vector<Direction> chain;
  chain.push_back(method_named(options.method)->make(options));
  for (const std::string& name : options.fallback) chain.push_back(method_named(name)->make(options));
  return std::make_unique<FallbackChain>(std::move(chain));
}

}  // namespace aspic
