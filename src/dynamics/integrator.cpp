#include "dynamics/integrator.h"

#include "base/error.h"
#include "dynamics/simulation.h"

namespace aspic {
namespace {

struct Entry {
  std::string name;
  std::unique_ptr<Integrator> (*make)();
};

const std::vector<Entry>& entries() {
  static const std::vector<Entry> table = {
      {"backward_euler", make_backward_euler},     {"linearly_implicit_euler", make_linearly_implicit_euler},
      {"symplectic_euler", make_symplectic_euler}, {"forward_euler", make_forward_euler},
      {"quasi_static", make_quasi_static},
  };
  return table;
}

}  // namespace

std::vector<std::string> integrator_names() {
  std::vector<std::string> names;
  for (const Entry& entry : entries()) names.push_back(entry.name);
  return names;
}

std::unique_ptr<Integrator> make_integrator(std::string_view name) {
  for (const Entry& entry : entries())
    if (entry.name == name) return entry.make();
  throw InvalidInput("integrator = '" + std::string(name) + "' is unknown" + suggestion(name, integrator_names()));
}

}  // namespace aspic
