#include "optimize/solver.h"

#include "base/error.h"
#include "linalg/linear_solver.h"
#include "optimize/gradient_descent.h"
#include "optimize/newton.h"

namespace aspic {
namespace {

struct NamedDefiniteness {
  std::string name;
  NewtonDefiniteness value;
};
const std::vector<NamedDefiniteness>& definiteness_table() {
  static const std::vector<NamedDefiniteness> table = {{"auto", NewtonDefiniteness::on_demand},
                                                       {"on_demand", NewtonDefiniteness::on_demand},
                                                       {"exact", NewtonDefiniteness::exact},
                                                       {"clamped", NewtonDefiniteness::clamped},
                                                       {"absolute", NewtonDefiniteness::absolute}};
  return table;
}

NewtonDefiniteness definiteness_named(const std::string& name) {
  for (const NamedDefiniteness& entry : definiteness_table())
    if (entry.name == name) return entry.value;
  throw InvalidInput("definiteness = '" + name + "' is unknown" + suggestion(name, definiteness_names()));
}

}  // namespace

std::vector<std::string> minimizer_names() { return {"newton", "gradient_descent"}; }

std::vector<std::string> definiteness_names() {
  std::vector<std::string> names;
  for (const NamedDefiniteness& entry : definiteness_table()) names.push_back(entry.name);
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

std::unique_ptr<SearchDirection> make_search_direction(const SolverOptions& options) {
  if (options.method == "newton")
    return std::make_unique<Newton>(make_linear_solver(options.linear), definiteness_named(options.definiteness));
  if (options.method == "gradient_descent") return std::make_unique<GradientDescent>();
  throw InvalidInput("method = '" + options.method + "' is unknown" + suggestion(options.method, minimizer_names()));
}

}  // namespace aspic
