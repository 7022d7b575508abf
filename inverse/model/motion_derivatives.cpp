// Derivatives with respect to the parameters of a motion, from those with respect to every tet and vertex.
#include "model/motion_parameters.h"

namespace aspic {

std::vector<double> MotionParameters::derivatives(std::span<const double> p, const TrajectoryGradient& gradient) const {
  std::vector<double> derivatives;
  for (int i = 0; i < size(); ++i) derivatives.push_back(derivative(entries_[i], slope(i, p[i]), p, gradient));
  return derivatives;
}

double MotionParameters::derivative(const Entry& entry, double slope, std::span<const double> p,
                                    const TrajectoryGradient& g) const {
  const Kind kind = entry.kind;
  double sum = 0;
  if (kind == Kind::young || kind == Kind::poisson) return material_derivative(entry, slope, p, g);
  if (kind == Kind::mass_damping) return slope * g.damping[0][0];
  if (kind == Kind::stiffness_damping) return slope * g.damping[0][1];
  if (kind == Kind::density || kind == Kind::viscosity) {
    const std::vector<double> values = kind == Kind::density ? density(p) : viscosity(p);
    const std::vector<double>& derivatives = kind == Kind::density ? g.density : g.damping.back();
    for (size_t t = 0; t < values.size(); ++t) sum += values[t] * derivatives[t];
    return sum;
  }
  for (int v = 0; v < static_cast<int>(g.qdot.size() / 3); ++v) {
    const Vec3d dv = point(g.qdot, v);
    sum += kind == Kind::velocity ? dv[entry.axis] : cross(arm(v), dv)[entry.axis];
  }
  return slope * sum;
}

// dmu/dE = mu / E and so on; E of a tet scales with its guess, so that dE/dp = E.
double MotionParameters::material_derivative(const Entry& entry, double slope, std::span<const double> p,
                                             const TrajectoryGradient& g) const {
  const std::vector<MaterialParameters> material = this->material(p);
  const size_t stride = g.elastic.size() / material.size();
  double sum = 0;
  for (size_t t = 0; t < material.size(); ++t) {
    const auto [mu, lambda] = material[t].lame;
    const double mu_bar = g.elastic[stride * t], lambda_bar = g.elastic[stride * t + 1];
    if (entry.kind == Kind::young) {
      sum += mu_bar * mu + lambda_bar * lambda;
    } else {
      const double E = young_modulus(material[t].lame), nu = poisson_ratio(material[t].lame);
      const double c = E / ((1 + nu) * (1 + nu));
      sum += slope * c * (-mu_bar / 2 + lambda_bar * (1 + 2 * nu * nu) / ((1 - 2 * nu) * (1 - 2 * nu)));
    }
  }
  return sum;
}

}  // namespace aspic
