#include "data/apparent_stiffness.h"

#include <algorithm>
#include <cmath>

#include "data/case_table.h"
#include "math/vectors.h"

namespace aspic {
namespace {

constexpr double kPoisson = 0.4;  // the initial guess of a fit, see material_quantities()
// Contact radius of a sphere, relative to its radius, where the glue has half its strength:
// sqrt((1 + 3/4 kGlue)^2 - 1).
constexpr double kBondedFootprint = 0.94;

double footprint(const Indenter& indenter, double depth) {
  if (indenter.shape == IndenterShape::disc) return indenter.radius;
  if (indenter.contact == IndenterContact::bonded) return kBondedFootprint * indenter.radius;
  return std::sqrt(indenter.radius * std::min(depth, indenter.radius));
}

}  // namespace

std::optional<double> apparent_young(const LoadCase& load) {
  if (!load.indenter || !load.force) return std::nullopt;
  const double depth = load_size(load), force = norm(*load.force);
  if (!(depth > 0) || !(force > 0)) return std::nullopt;
  return force * (1 - kPoisson * kPoisson) / (2 * footprint(*load.indenter, depth) * depth);
}

std::optional<double> apparent_young(const Measured& experiment) {
  std::vector<double> values;
  for (const LoadCase& load : experiment.cases)
    if (const auto E = apparent_young(load)) values.push_back(*E);
  return values.empty() ? std::nullopt : std::optional(median(std::move(values)));
}

}  // namespace aspic
