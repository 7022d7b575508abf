#include "viewer/default_stiffness.h"

#include <algorithm>
#include <cmath>

#include "mesh/elements.h"
#include "viewer/fields.h"

namespace aspic::viewer {
namespace {

// The volume and Young's modulus of the elastic elements.
struct Elastic {
  int elements = 0;
  double volume = 0, logs = 0;  // [m^3], integral of log E

  double young() const { return std::exp(logs / volume); }
};

Elastic elastic_part(const Model& model) {
  Elastic part;
  const std::vector<double>* young = tet_field(model, "young");
  for (int t = 0; young && t < model.mesh.element_count(); ++t) {
    if (!((*young)[t] > 0)) continue;
    const double v = element_volume(model.mesh, t);
    part.logs += v * std::log((*young)[t]);
    part.volume += v;
    ++part.elements;
  }
  return part;
}

}  // namespace

std::optional<double> mean_young(const Model& model) {
  const Elastic part = elastic_part(model);
  return part.elements > 0 ? std::optional(part.young()) : std::nullopt;
}

double default_stiffness(const Model& model) {
  const Elastic part = elastic_part(model);
  if (part.elements > 0) return part.young() * std::cbrt(6 * std::sqrt(2.0) * part.volume / part.elements);
  // Without elasticity: an oscillation of about 2 Hz.
  double mass = 0;
  for (const double m : model.mass->vertex_mass()) mass += m;
  return std::max(100 * mass, 1e-9);
}

}  // namespace aspic::viewer
