// Derivatives: energies of all materials on tets compared with differences.
#include <cmath>
#include <random>

#include "dynamics/step_derivatives.h"
#include "mesh/generators.h"
#include "reference/models.h"
#include "verification/families.h"

namespace aspic::verify {
namespace {

Plot error_plot() {
  return {"error of central differences, all materials", "step / length", "relative error", Scales::logarithmic, {}};
}

void check_differences(const Subject& subject, Findings& found) {
  const TetMesh mesh = make_box({{0, 0, 0}}, {{1, 0.8, 0.6}}, {3, 2, 2});
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-0.03, 0.03);
  const std::vector<double> x = at_vertices(mesh, [&](const Vec3d& X) {
    Vec3d moved{};
    for (int r = 0; r < 3; ++r) moved[r] = (1 + 0.1 * r) * X[r] + 0.2 * X[(r + 1) % 3] + uniform(random);
    return moved;
  });
  Plot plot = error_plot();
  Findings orders;  // appended after the errors
  for (const MaterialInfo& info : materials()) {
    const std::string taken = subject.replacement(info.name);
    const Model model = make_model(mesh, {.material = taken, .young = 1, .poisson = 0.4});
    TetElasticity& V = *model.elasticity[0];
    Couplings couplings;
    V.add_couplings(couplings);
    const BlockPattern pattern = make_pattern(mesh.vertex_count(), couplings);
    V.bind(pattern);
    const DerivativeReport report = check_derivatives(differentiable(ActiveTerm(V), pattern), x, {.length = 0.3});
    for (const auto& [name, check] : {std::pair("gradient", &report.gradient), {"Hessian", &report.hessian}}) {
      found.expect_small(info.name + ": smallest error of the " + name, check->smallest_error, 1e-6,
                         "where the error h^2 of the difference meets its round-off 1e-16 / h");
      if (!std::isnan(check->order))  // quadratic energies have only round-off error
        orders.expect(info.name + ": order of the error of the " + name, {check->order, 2, 0.2},
                      "a line fitted over the decades before round-off");
    }
    plot.curves.push_back({info.name, report.hessian.step, report.hessian.error});
  }
  found.rows.insert(found.rows.end(), orders.rows.begin(), orders.rows.end());
  found.plots.push_back(plot);
}

}  // namespace

void add_derivative_checks(std::vector<Check>& checks) {
  checks.push_back({"derivatives",
                    "differences",
                    "Gradients and Hessians against central differences",
                    "A crumpled box of 72 tets, every material. The error of a central difference falls by 100 when "
                    "its step falls by 10, until round-off; that of a wrong derivative does not fall.",
                    "Taylor's theorem",
                    check_differences,
                    {},
                    {R"tex(\frac{f(x + h) - f(x - h)}{2 h} = \frac{df}{dx} + O(h^2))tex"}});
}

}  // namespace aspic::verify
