#include "aspic/method_text.h"

#include <algorithm>
#include <sstream>
#include <vector>

#include "base/error.h"
#include "linalg/linear_solver.h"

namespace aspic::cli {
namespace {

void set_option(const std::string& option, SolverOptions& solver) {
  if (contains(definiteness_names(), option)) {
    solver.definiteness = option;
  } else if (contains(linear_solver_names(), option)) {
    solver.linear = option;
  } else if (contains(preconditioner_names(), option)) {
    solver.preconditioner = option;
  } else {
    std::vector<std::string> known = definiteness_names();
    for (const auto& names : {linear_solver_names(), preconditioner_names()})
      for (const std::string& name : names)
        if (!contains(known, name)) known.push_back(name);
    throw InvalidInput("method option '" + option + "' is unknown" + suggestion(option, known));
  }
}

}  // namespace

bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

SolverOptions method_named(const std::string& text, const SolverOptions& base) {
  SolverOptions solver;
  solver.minimize = base.minimize;
  std::istringstream words(text);
  std::getline(words, solver.method, ':');
  if (!contains(minimizer_names(), solver.method))
    throw InvalidInput("method '" + solver.method + "' is unknown" + suggestion(solver.method, minimizer_names()));
  for (std::string option; std::getline(words, option, ':');) set_option(option, solver);
  make_search_direction(solver);  // throws if they are incompatible
  return solver;
}

}  // namespace aspic::cli
