// Bending of slender and of plane bodies: the elastica, Cook's membrane.
#include <algorithm>
#include <cmath>
#include <string>

#include "energy/linear_load.h"
#include "mesh/surface.h"
#include "verify/families.h"
#include "verify/layers.h"
#include "verify/statics.h"

namespace aspic::verify {
namespace {

// `traction` [Pa] over all boundary triangles whose corners satisfy `is_loaded`.
std::vector<double> traction_on(const TetMesh& mesh, const std::function<bool(const Vec3d&)>& is_loaded,
                                const Vec3d& traction) {
  std::vector<double> force(3 * mesh.rest.size());
  for (const Triangle& triangle : boundary_triangles(mesh, 0, mesh.tet_count()))
    if (std::all_of(triangle.begin(), triangle.end(), [&](int v) { return is_loaded(mesh.rest[v]); }))
      add_traction(mesh.rest, triangle, traction, force);
  return force;
}

Vec3d position(const Simulation& simulation, int v) {
  const double* q = &simulation.state().q[3 * v];
  return {{q[0], q[1], q[2]}};
}

// P L^2 / (E I) and the drop of the tip over L.
struct TipLoad {
  double load, drop;
};
const std::vector<TipLoad> kElastica = {{.25, .08274592}, {.5, .16214358}, {1, .30172077},
                                        {2, .49345748},   {4, .66996418},  {10, .81060902}};

// What the load passes on its way; one step each.
const std::vector<double> kLoads = {.25, .5, 1, 1.5, 2, 3, 4, 5.5, 7.5, 10};

// The drops of a strip of length 1 and height 1/40 with n cells through it.
std::vector<double> drops(int n, const std::string& material, const std::vector<TipLoad>& loads) {
  const double height = 1.0 / 40, width = height / n;
  Model model = make_model(make_layer(40 * n, n, width,
                                      [height](double x, double y) {
                                        return std::array{x, (y - 0.5) * height};
                                      }),
                           {.material = material, .young = 1, .poisson = 0, .gravity = {}});
  model.pins.push_back({"wall", vertices_where(model.mesh, [](const Vec3d& X) { return X[0] < 1e-9; }), {}});
  model.loads.push_back(make_plane_hold(model.mesh, 1e3 * width));  // so narrow a strip would buckle sideways
  const double area = height * width, inertia = width * height * height * height / 12;
  model.loads.push_back(make_growing_load(
      traction_on(model.mesh, [](const Vec3d& X) { return X[0] > 1 - 1e-9; }, {{0, -inertia / area, 0}}),
      [](double time) {
        const auto step = static_cast<size_t>(std::lround(time));  // 0 before the first
        return step == 0 ? 0.0 : kLoads.at(step - 1);
      }));
  const int tip =
      vertices_where(model.mesh, [n](const Vec3d& X) { return X[0] > 1 - 1e-9 && std::abs(X[1]) < 1e-9; }).at(0);
  SimulationOptions options{.h = 1, .integrator = "quasi_static", .solver = {}};
  options.solver.minimize.tolerance = 1e-13;  // bending is soft beside the moduli that forces are judged by
  Simulation simulation = simulate(std::move(model), options);
  std::vector<double> found;
  for (const TipLoad& row : loads) {
    while (simulation.steps_taken() == 0 || kLoads[simulation.steps_taken() - 1] < row.load)
      take_steps(simulation, 1, "elastica");
    found.push_back(-position(simulation, tip)[1]);
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
    by_mesh.push_back(drops(n, subject.taken_for("neo_hookean_log"), loads));
    Curve curve{std::to_string(n) + " cells through the height", {0}, {0}};
    for (size_t k = 0; k < loads.size(); ++k) curve.x.push_back(loads[k].load), curve.y.push_back(by_mesh.back()[k]);
    plot.curves.push_back(curve);
  }
  Curve exact{"elastica", {0}, {0}, CurveStyle::dashed};
  Findings orders;  // after the limits
  for (size_t k = 0; k < loads.size(); ++k) {
    const std::string name = "load " + std::to_string(loads[k].load).substr(0, 5);
    std::vector<double> values;
    for (const auto& mesh : by_mesh) values.push_back(mesh[k]);
    const double reference = loads[k].drop;
    exact.x.push_back(loads[k].load), exact.y.push_back(reference);
    found.expect(
        name + ": drop / L, limit", richardson(values, 2), reference, (subject.quick ? 0.02 : 2.5e-3) * reference,
        subject.quick ? "4 cells through the height are at the end of locking"
                      : "shear adds 0.6 (h/L)^2 = 4e-4, the law as much at strains of 5 %, the extrapolation some");
    if (values.size() >= 3)
      orders.expect(name + ": order of the last three meshes", extrapolate(values).order, 2, 0.35,
                    "locking is over once there are 4 cells through the height; from 4 to 16 the next term counts");
  }
  found.rows.insert(found.rows.end(), orders.rows.begin(), orders.rows.end());
  plot.curves.push_back(exact);
  found.plots.push_back(plot);
}

double cook(int n, const std::string& material) {
  const double thickness = 48.0 / n;
  const TetMesh mesh = make_layer(n, n, thickness, [](double x, double y) {
    return std::array{48 * x, 44 * x + y * (44 - 28 * x)};
  });
  Model model = make_model(mesh, {.material = material, .young = 250, .poisson = 0.3, .gravity = {}});
  model.pins.push_back({"wall", vertices_where(mesh, [](const Vec3d& X) { return X[0] < 1e-9; }), {}});
  model.loads.push_back(make_plane_hold(mesh, 1e5 * 250));
  // 100 per unit of thickness over an edge of 16.
  model.loads.push_back(
      make_growing_load(traction_on(mesh, [](const Vec3d& X) { return X[0] > 48 - 1e-9; }, {{0, 100.0 / 16, 0}})));
  const std::vector<int> corner =
      vertices_where(mesh, [](const Vec3d& X) { return X[0] > 48 - 1e-9 && std::abs(X[1] - 52) < 1e-9; });
  const Simulation simulation = equilibrium(std::move(model), 2, "Cook's membrane", 1e-9);
  double sum = 0;
  for (const int v : corner) sum += position(simulation, v)[1] - 52;
  return sum / static_cast<double>(corner.size());
}

void check_cook(const Subject& subject, Findings& found) {
  const std::vector<int> cells = subject.quick ? std::vector<int>{8, 16, 32} : std::vector<int>{8, 16, 32, 64, 128};
  Curve curve{"linear tets", {}, {}}, limit{"7.638", {}, {}, CurveStyle::dashed};
  for (const int n : cells) {
    curve.x.push_back(n), curve.y.push_back(cook(n, subject.taken_for("neo_hookean_log")));
    limit.x.push_back(n), limit.y.push_back(7.638);
  }
  const Extrapolation found_limit = extrapolate(curve.y);
  found.expect("u_y at (48, 52), limit of the last three meshes", found_limit.limit, 7.638, subject.quick ? 0.12 : 0.02,
               "the reference has four digits; the order, which is estimated too, is that of a corner");
  found.expect("its order", found_limit.order, 1.5, 0.5,
               "between 1.3, that of the singular corner of the clamped edge, and 2, that of the rest");
  found.plots.push_back({"Cook's membrane", "cells along an edge", "u_y at (48, 52)", Scales::linear, {curve, limit}});
}

}  // namespace

void add_bending_checks(std::vector<Check>& checks) {
  checks.push_back({"statics",
                    "elastica",
                    "Large deflection of a cantilever",
                    "L / h = 40, nu = 0, a dead load at the tip. Linear tets lock in shear: the limit is judged, and "
                    "the trend.",
                    "The elastica, by elliptic integrals",
                    {"Bisshopp1945"},
                    check_elastica});
  checks.push_back({"statics",
                    "cook",
                    "Cook's membrane at finite strain",
                    "Plane strain, neo_hookean_log, E = 250, nu = 0.3, a load of 100 on the right edge.",
                    "7.638, a converged value from outside this program for Cook's geometry with this material",
                    {"Cook1974"},
                    check_cook});
}

}  // namespace aspic::verify
