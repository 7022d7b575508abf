// A beam of unlike tets under its weight, and changes of their parameters.
#pragma once
#include <cmath>

#include "dynamics/models_test.h"
#include "material/registry.h"
#include "model/taylor_test.h"

namespace aspic::testing_models {

// A beam of unlike tets that sags by a sixth of its length.
struct Sagging {
  Model model = beam(2, {.gravity = {{0, -9.81, 0.5}}});
  std::string material;
  std::vector<MaterialParameters> parameters;
  std::vector<double> rest = at_rest(model.mesh).q;
  int count = 0;  // of parameters of a tet

  explicit Sagging(const std::string& name, double young = 1.2e6) : material(name) {
    const MaterialInfo& info = material_info(name);
    count = 2 + static_cast<int>(info.extra.size());
    for (int t = 0; t < model.mesh.tet_count(); ++t) {
      MaterialParameters p{lame_from_young_poisson(young * (1 + 0.5 * std::sin(t)), 0.3 + 0.05 * std::cos(t)), {}};
      for (size_t k = 0; k < info.extra.size(); ++k)
        p.extra[k] = (info.extra[k].fallback == 0 ? 0.3 : info.extra[k].fallback) * (1 + 0.2 * std::sin(3.0 * t));
      parameters.push_back(p);
    }
    model.elasticity[0] = make_tet_elasticity(name, model.mesh, 0, parameters);
  }
};

// dtheta that changes one parameter of each tet, in proportion to itself: k = 0 mu, 1 lambda, 2... extra.
inline std::vector<double> change_of(const Sagging& body, int k) {
  std::vector<double> dtheta(body.parameters.size() * body.count);
  const std::vector<double> numbers = taylor::Numbers()(body.parameters.size());
  for (size_t t = 0; t < numbers.size(); ++t) {
    const MaterialParameters& p = body.parameters[t];
    dtheta[t * body.count + k] = (0.7 + 0.3 * numbers[t]) * (k == 0   ? p.lame.mu
                                                             : k == 1 ? p.lame.lambda
                                                                      : p.extra[k - 2]);
  }
  return dtheta;
}

inline std::vector<MaterialParameters> changed(const Sagging& body, const std::vector<double>& dtheta, double eps) {
  std::vector<MaterialParameters> parameters = body.parameters;
  for (size_t t = 0; t < parameters.size(); ++t) {
    const double* d = &dtheta[t * body.count];
    parameters[t].lame.mu += eps * d[0], parameters[t].lame.lambda += eps * d[1];
    for (int k = 2; k < body.count; ++k) parameters[t].extra[k - 2] += eps * d[k];
  }
  return parameters;
}

}  // namespace aspic::testing_models
