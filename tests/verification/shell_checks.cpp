// Thin shells with mid-edge bending: plates, a heavy strip and curved shells.
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "energy/linear_load.h"
#include "reference/statics.h"
#include "verification/families.h"
#include "verification/shell_models.h"

namespace aspic::verify {
namespace {

constexpr double kPi = std::numbers::pi;

// Returns the equilibrium under a dead load, in one step.
std::vector<double> shell_equilibrium(Model model, std::vector<double> force, const std::string& what) {
  model.loads.push_back(make_linear_load("load", std::move(force)));
  SimulationOptions options{.h = 1, .integrator = "quasi_static", .initial_guess = "zero", .solver = {}};
  options.solver.minimize.tolerance = 1e-8;
  options.solver.minimize.max_iterations = 1000;
  Simulation simulation = simulate(std::move(model), options);
  take_steps(simulation, 1, what);
  return simulation.state().q;
}

enum class Support { clamped, simple };

// Deflection at the center of a unit square with n x n cells under a uniform load q, times D / q.
double plate_coefficient(int n, Cells cells, Support support, const Subject& subject) {
  const ShellMaterial given{1e7, 0.3, 0.01, 1000};
  ShellMaterial material = given;
  material.young *= subject.stiffness;
  const double load = 0.01 * given.thickness * given.moment() / 0.00126;  // bends it by about a hundredth of t
  const int rim = support == Support::clamped ? 1 : 0;
  const ShellMesh mesh = make_shell_grid({n, n, {rim, rim, rim, rim}, cells}, [](double u, double v) {
    return Vec3d{{u, v, 0}};
  });
  const std::vector<int> border = mesh.vertices_where(
      [](const Vec3d& X) { return std::min(X[0], X[1]) < 1e-9 || std::max(X[0], X[1]) > 1 - 1e-9; });
  std::vector<Pin> pins = {{"border", border, {}, {}}};
  if (support == Support::simple) {  // no triangle is held, so all may turn
    pins[0].directions = {{{0, 0, 1}}};
    pins.push_back({"corners", {0, n}, {}, {{{1, 0, 0}}, {{0, 1, 0}}}});
  }
  Model model = shell_model(mesh, material, pins);
  const std::vector<int> rims = support == Support::clamped ? border : std::vector<int>{};
  const std::vector<double> q = shell_equilibrium(std::move(model), area_load(mesh, {{0, 0, load}}, rims), "a plate");
  return q[3 * static_cast<size_t>(mesh.nearest({{0.5, 0.5, 0}})) + 2] * given.moment() / load;
}

// Navier's series for the center of a simply supported square.
double navier_coefficient() {
  double sum = 0;
  for (int m = 1; m < 200; m += 2)
    for (int n = 1; n < 200; n += 2) sum += ((m + n) / 2 % 2 ? 1 : -1) / (m * n * std::pow(m * m + n * n, 2.0));
  return 16 / std::pow(kPi, 6) * sum;
}

void check_plate(const Subject& subject, Findings& found, Support support, double reference) {
  const double tolerance = support == Support::clamped ? 0.025 : 0.005;
  found.expect("w D / (q L^4) at the center, irregular mesh",
               {plate_coefficient(32, Cells::irregular, support, subject), reference, tolerance * reference},
               "the error of 32 cells");
  Curve curve{"aligned mesh", {}, {}}, exact{"series", {}, {}, CurveStyle::dashed};
  for (const int n : {8, 16, 32}) {
    curve.x.push_back(n), curve.y.push_back(plate_coefficient(n, Cells::aligned, support, subject));
    exact.x.push_back(n), exact.y.push_back(reference);
  }
  found.expect("order of the error on aligned meshes",
               {std::log2((curve.y[1] - reference) / (curve.y[2] - reference)), 2, 0.3}, "16 and 32 cells");
  found.plots.push_back(
      {"deflection of the plate", "cells along an edge", "w D / (q L^4)", Scales::linear, {curve, exact}});
}

// A clamped strip of length L and width L / 5 bends under its own weight w per length.
void check_heavy_strip(const Subject& subject, Findings& found) {
  constexpr int ny = 8;
  const ShellMaterial material{1e6 * subject.stiffness, 0, 1e-3, 1000};
  const double weight = 9.81 * material.thickness * material.density;
  const double L = std::cbrt(10 * ShellMaterial{1e6, 0, 1e-3, 1000}.moment() / weight);  // w L^3 / (E I) = 10
  const ShellMesh mesh = make_shell_grid({5 * ny, ny, {1, 0, 0, 0}}, [L](double u, double v) {
    return Vec3d{{L * u, L / 5 * v, 0}};
  });
  const std::vector<int> held = mesh.vertices_where([](const Vec3d& X) { return X[0] < 1e-9; });
  Model model = shell_model(mesh, material, {{"wall", held, {}}});
  const std::vector<double> q =
      shell_equilibrium(std::move(model), area_load(mesh, {{0, 0, -weight}}, held), "the heavy strip");
  const std::vector<int> tip = mesh.vertices_where([L](const Vec3d& X) { return X[0] > L * (1 - 1e-9); });
  const Vec3d sum = sum_over(tip, q);
  const double count = static_cast<double>(tip.size()) * L, x = sum[0] / count, z = sum[2] / count;
  const std::string cells = std::to_string(5 * ny) + " x " + std::to_string(ny) + " cells";
  constexpr double tolerance = 0.002;
  found.expect("x / L of the tip", {x, 0.6563538, tolerance * 0.6563538}, "the error of " + cells);
  found.expect("z / L of the tip", {z, -0.7001997, tolerance * 0.7001997}, "the error of " + cells);
}

// A cylindrical roof of radius 25 and 80 degrees, 50 long, on diaphragms at both ends, under 90 per area.
double roof_deflection(int n, const Subject& subject) {
  const ShellMaterial material{4.32e8 * subject.stiffness, 0, 0.25, 1};
  const ShellMesh mesh = make_shell_grid({n, n, {0, 0, 0, 0}, Cells::aligned}, [](double u, double v) {
    const double angle = (u - 0.5) * 80 * kPi / 180;
    return Vec3d{{25 * std::sin(angle), 50 * v, 25 * std::cos(angle)}};
  });
  const std::vector<int> ends = mesh.vertices_where([](const Vec3d& X) { return X[1] < 1e-9 || X[1] > 50 - 1e-9; });
  const std::vector<Vec3d> across = {{{1, 0, 0}}, {{0, 0, 1}}};
  Model model = shell_model(mesh, material, {{"ends", ends, {}, across}, {"corner", {0}, {}, {{{0, 1, 0}}}}});
  constexpr double kScale = 1e-3;  // linear deflections
  const std::vector<double> q =
      shell_equilibrium(std::move(model), area_load(mesh, {{0, 0, -90 * kScale}}), "the roof");
  const double side = 40 * kPi / 180;
  const int edge = mesh.nearest({{25 * std::sin(side), 25, 25 * std::cos(side)}});
  return (mesh.rest[edge][2] - q[3 * static_cast<size_t>(edge) + 2]) / kScale;
}

void check_roof(const Subject& subject, Findings& found) {
  found.expect("deflection of the free edge", {roof_deflection(32, subject), 0.3024, 0.05 * 0.3024},
               "the linear membrane of 32 cells");
}

// A hemisphere of radius 10 with a hole of 18 degrees at the pole, n cells from the equator to the hole, under forces
// of 2 at its equator: outward along x, inward along y.
double hemisphere_deflection(int n, const Subject& subject) {
  const ShellMaterial material{6.825e7 * subject.stiffness, 0.3, 0.04, 1};
  ShellMesh mesh = make_shell_grid({4 * n, n, {0, 0, 0, 0}, Cells::aligned}, [](double u, double v) {
    const double turn = 2 * kPi * u, height = 72 * kPi / 180 * v;
    return Vec3d{
        {10 * std::cos(height) * std::cos(turn), 10 * std::cos(height) * std::sin(turn), 10 * std::sin(height)}};
  });
  // Merges the first and the last column.
  const int columns = 4 * n + 1;
  std::vector<Vec3d> rest;
  std::vector<int> number;
  for (int v = 0; v < columns * (n + 1); ++v) {
    const bool is_last = v % columns == columns - 1;
    number.push_back(is_last ? number[v - columns + 1] : static_cast<int>(rest.size()));
    if (!is_last) rest.push_back(mesh.rest[v]);
  }
  mesh.rest = rest;
  for (Triangle& t : mesh.triangles)
    for (int& v : t) v = number[v];

  constexpr double kScale = 1e-2;  // linear deflections
  const int quarter = n, top = 4 * n * n;
  std::vector<double> force(3 * mesh.rest.size(), 0.0);
  const auto push = [&](int vertex, int axis, double f) { force[3 * static_cast<size_t>(vertex) + axis] = kScale * f; };
  push(0, 0, 2), push(2 * quarter, 0, -2), push(quarter, 1, -2), push(3 * quarter, 1, 2);
  Model model = shell_model(mesh, material,
                            {{"along_x", {0, 2 * quarter}, {}, {{{0, 1, 0}}, {{0, 0, 1}}}},
                             {"along_y", {quarter, 3 * quarter}, {}, {{{1, 0, 0}}}},
                             {"hole", {top, top + 2 * quarter}, {}, {{{0, 1, 0}}}}});
  const std::vector<double> q = shell_equilibrium(std::move(model), force, "the hemisphere");
  return (q[0] - mesh.rest[0][0]) / kScale;
}

void check_hemisphere(const Subject& subject, Findings& found) {
  const int n = subject.quick ? 16 : 32;
  found.expect("displacement along a force",
               {hemisphere_deflection(n, subject), 0.094, (subject.quick ? 0.02 : 0.01) * 0.094},
               "the error of " + std::to_string(n) + " cells");
}

}  // namespace

void add_shell_checks(std::vector<Check>& checks) {
  const auto add_plate = [&](const std::string& name, const std::string& title, Support support, double reference,
                             const std::vector<std::string>& formulas) {
    checks.push_back({"statics",
                      name,
                      title,
                      "nu = 0.3, t / L = 0.01, a uniform load q, 32 cells along an edge.",
                      "Series of thin plates",
                      [support, reference](const Subject& subject, Findings& found) {
                        check_plate(subject, found, support, reference);
                      },
                      {"Timoshenko1959"},
                      formulas});
  };
  add_plate("clamped_plate", "Bending of a clamped square plate", Support::clamped, 0.00126532,
            {R"tex(D \Delta^2 w = q, \quad w = \frac{\partial w}{\partial n} = 0)tex"});
  add_plate(
      "supported_plate", "Bending of a simply supported square plate", Support::simple, navier_coefficient(),
      {R"tex(w = \frac{16 q L^4}{\pi^6 D} \sum_{m, n} \frac{(-1)^{(m + n) / 2 - 1}}{m n (m^2 + n^2)^2}, \quad m, n = 1, 3, 5, ...)tex"});
  checks.push_back({"statics",
                    "heavy_strip",
                    "Large deflection of a strip under its weight",
                    "w L^3 / (E I) = 10, nu = 0, clamped by a row of pinned triangles, an irregular mesh.",
                    "The heavy elastica, by shooting",
                    check_heavy_strip,
                    {},
                    {R"tex(E I \theta'' = -w (L - s) \cos \theta, \quad \theta(0) = 0, \quad \theta'(L) = 0)tex"}});
  checks.push_back({"statics",
                    "scordelis_lo",
                    "Scordelis-Lo roof",
                    "A cylindrical roof on diaphragms under its weight: membrane and bending.",
                    "Published linear solution",
                    check_roof,
                    {"MacNeal1985"}});
  checks.push_back({"statics",
                    "pinched_hemisphere",
                    "Pinched hemisphere with a hole",
                    "Four forces at the equator: bending without stretch of a doubly curved shell.",
                    "Published linear solution",
                    check_hemisphere,
                    {"MacNeal1985"}});
}

}  // namespace aspic::verify
