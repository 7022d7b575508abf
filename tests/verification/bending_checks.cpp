// Bending of slender bodies: the elastica.
#include <algorithm>
#include <cmath>
#include <string>

#include "reference/models.h"
#include "reference/statics.h"
#include "verification/families.h"

namespace aspic::verify {
namespace {

// P L^2 / (E I), and the tip deflection over L.
struct TipLoad {
  double load, drop;
};
const std::vector<TipLoad> kElastica = {{.25, .08274592}, {.5, .16214358}, {1, .30172077},
                                        {2, .49345748},   {4, .66996418},  {10, .81060902}};

// Load steps.
const std::vector<double> kLoads = {.25, .5, 1, 1.5, 2, 3, 4, 5.5, 7.5, 10};

// Tip deflections of a strip of length 1 and height 1/40 with n cells through the height.
std::vector<double> drops(int n, const std::string& material, const std::vector<TipLoad>& loads) {
  const double height = 1.0 / 40, width = height / n;
  Model model = model_of(make_layer(40 * n, n, width,
                                    [height](double x, double y) {
                                      return std::array{x, (y - 0.5) * height};
                                    }),
                         {.material = material, .young = 1, .poisson = 0, .gravity = {}})
                    .pin("wall", [](const Vec3d& X) { return X[0] < 1e-9; })
                    .build();
  hold_plane(model);  // prevents lateral buckling of the narrow strip
  const double area = height * width, inertia = width * height * height * height / 12;
  model.loads.push_back(make_growing_load(
      traction_on(model.mesh, [](const Vec3d& X) { return X[0] > 1 - 1e-9; }, {{0, -inertia / area, 0}}),
      [](double time) {
        const auto step = static_cast<size_t>(std::lround(time));  // 0 before the first
        return step == 0 ? 0.0 : kLoads.at(step - 1);
      }));
  const int tip =
      vertices_where(model.mesh, [](const Vec3d& X) { return X[0] > 1 - 1e-9 && std::abs(X[1]) < 1e-9; }).at(0);
  SimulationOptions options{.h = 1, .integrator = "quasi_static", .solver = {}};
  options.solver.minimize.tolerance = 1e-13;  // bending is soft compared with the moduli that scale the forces
  Simulation simulation = simulate(std::move(model), options);
  std::vector<double> found;
  for (const TipLoad& row : loads) {
    while (simulation.steps_taken() == 0 || kLoads[simulation.steps_taken() - 1] < row.load)
      take_steps(simulation, 1, "elastica");
    found.push_back(-simulation.state().q[3 * tip + 1]);
  }
  return found;
}

void check_elastica(const Subject& subject, Findings& found) {
  const std::vector<TipLoad> loads =
      subject.quick ? std::vector<TipLoad>(kElastica.begin(), kElastica.begin() + 3) : kElastica;
  const std::vector<int> cells = subject.quick ? std::vector<int>{4, 8} : std::vector<int>{2, 4, 8, 16};
  std::vector<std::vector<double>> by_mesh;
  Plot plot{"drop of the tip (dashed: the elastica)", "P L^2 / (E I)", "drop / L", Scales::linear, {}};
  for (const int n : cells) {
    by_mesh.push_back(drops(n, subject.replacement("neo_hookean_log"), loads));
    Curve curve{std::to_string(n) + " cells through the height", {0}, {0}};
    for (size_t k = 0; k < loads.size(); ++k) curve.x.push_back(loads[k].load), curve.y.push_back(by_mesh.back()[k]);
    plot.curves.push_back(curve);
  }
  Curve exact{"elastica", {0}, {0}, CurveStyle::dashed};
  Findings orders;  // appended after the limits
  for (size_t k = 0; k < loads.size(); ++k) {
    const std::string name = "load " + std::to_string(loads[k].load).substr(0, 5);
    std::vector<double> values;
    for (const auto& mesh : by_mesh) values.push_back(mesh[k]);
    const double reference = loads[k].drop;
    exact.x.push_back(loads[k].load), exact.y.push_back(reference);
    found.expect(
        name + ": drop / L, limit", {richardson(values, 2), reference, (subject.quick ? 0.02 : 2.5e-3) * reference},
        subject.quick ? "locking ends at 4 cells through the height"
                      : "shear adds 0.6 (h/L)^2 = 4e-4; the material at 5 % strain and the extrapolation add as much");
    if (values.size() >= 3)
      orders.expect(name + ": order of the last three meshes", {extrapolate(values).order, 2, 0.35},
                    "with 4 to 16 cells through the height, the next term of the error contributes");
  }
  found.rows.insert(found.rows.end(), orders.rows.begin(), orders.rows.end());
  plot.curves.push_back(exact);
  found.plots.push_back(plot);
}

}  // namespace

void add_bending_checks(std::vector<Check>& checks) {
  checks.push_back(
      {"statics",
       "elastica",
       "Large deflection of a cantilever",
       "L / h = 40, nu = 0, a dead load at the tip. Linear tets lock in shear: the limit is judged, and "
       "the trend.",
       "The elastica, by elliptic integrals",
       check_elastica,
       {"Bisshopp1945"},
       {R"tex(E I \frac{d^2 \theta}{ds^2} + P \cos \theta = 0, \quad \theta(0) = 0, \quad \frac{d \theta}{ds}(L) = 0)tex",
        R"tex(w(L) = \int_0^L \sin \theta \, ds)tex"}});
}

}  // namespace aspic::verify
