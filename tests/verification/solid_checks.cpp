// Solids with closed-form solutions: hollow sphere, point load on a half-space, torsion.
#include <cmath>
#include <numbers>

#include "mesh/generators.h"
#include "reference/hollow_sphere.h"
#include "reference/radial_reference.h"
#include "reference/statics.h"
#include "verification/families.h"

namespace aspic::verify {
namespace {

// The inner radius changes from 1 to `inner`; the outer rest radius is 2.
Inflation blown_up(int level, const std::string& material, double poisson, double inner) {
  const TriMesh surface = octahedral_sphere(level + 1);
  const int layers = 3 << (level - 1);
  const TetMesh mesh = hollow_sphere(surface, layers, 1, 2);
  const auto at_radius = [&](double R) {
    return vertices_where(mesh, [R](const Vec3d& X) { return std::abs(norm(X) - R) < 1e-9; });
  };
  const std::vector<int> inside = at_radius(1), outside = at_radius(2);
  Model model = make_model(mesh, {.material = material, .young = 1, .poisson = poisson, .gravity = {}});
  model.pins.push_back({"inside", inside, [inner](const Vec3d& X, double t) { return (1 + (inner - 1) * t) * X; }});
  const Simulation simulation = equilibrium(std::move(model), 2, material, 1e-9);
  const std::vector<double> force = elastic_forces(simulation);
  Inflation found{0, 0};
  for (const int v : inside)
    for (int r = 0; r < 3; ++r) found.force += force[3 * v + r] * mesh.rest[v][r] / (4 * std::numbers::pi);
  for (const int v : outside) {
    const double* q = &simulation.state().q[3 * v];
    found.outer += std::hypot(q[0], q[1], q[2]) / static_cast<double>(outside.size());
  }
  return found;
}

void check_sphere(const Subject& subject, Findings& found) {
  const double inner = 1.5, poisson = 0.3;
  const std::vector<int> levels = subject.quick ? std::vector<int>{1, 2} : std::vector<int>{1, 2, 3};
  std::vector<std::string> names = {"neo_hookean_log"};
  if (!subject.quick) names.push_back("stable_neo_hookean");
  for (const std::string& material : names) {
    const Inflation exact = inflated_sphere(material, poisson, 1, 2, inner);
    std::vector<double> outer, force;
    for (const int level : levels) {
      const Inflation one = blown_up(level, subject.replacement(material), poisson, inner);
      outer.push_back(one.outer), force.push_back(one.force);
    }
    const double tolerance = subject.quick ? 0.03 : 1e-3;
    const std::string reason = "error of the extrapolation with order 2: the next term";
    found.expect(material + ": growth of the outer radius, limit",
                 {richardson(outer, 2) - 2, exact.outer - 2, tolerance * (exact.outer - 2)}, reason, "m");
    found.expect(material + ": nominal stress inside / E, limit",
                 {richardson(force, 2), exact.force, tolerance * exact.force}, reason);
  }
}

// Displacement by a force P into the half-space z >= 0 at the origin, G = 1 / (2 (1 + nu)).
Vec3d boussinesq(const Vec3d& X, double poisson, double P) {
  const double r = std::hypot(X[0], X[1]), z = X[2], rho = std::hypot(r, z);
  const double factor = P * (1 + poisson) / (2 * std::numbers::pi);
  const double radial = factor * (r * z / (rho * rho * rho) - (1 - 2 * poisson) * r / (rho * (rho + z)));
  const double down = factor * (z * z / (rho * rho * rho) + 2 * (1 - poisson) / rho);
  return {{r > 0 ? radial * X[0] / r : 0, r > 0 ? radial * X[1] / r : 0, down}};
}

// Displacements at (1/2, 0, 0), (1/2, 0, 1/2) and (0, 0, 1/2) under a force of 1 N, E = 1 Pa.
std::vector<Vec3d> under_point_load(int n, const std::string& material, double poisson) {
  const double P = 1e-3;
  const TetMesh mesh = make_box({{-1, -1, 0}}, {{1, 1, 1}}, {2 * n, 2 * n, n});
  Model model = make_model(mesh, {.material = material, .young = 1, .poisson = poisson, .gravity = {}});
  const auto far = vertices_where(
      mesh, [](const Vec3d& X) { return std::abs(X[0]) > 1 - 1e-9 || std::abs(X[1]) > 1 - 1e-9 || X[2] > 1 - 1e-9; });
  model.pins.push_back({"far", far, [=](const Vec3d& X, double) { return X + boussinesq(X, poisson, P); }});
  const auto at = [&mesh](const Vec3d& X) {
    return vertices_where(mesh, [X](const Vec3d& Y) { return dot(X - Y, X - Y) < 1e-18; }).at(0);
  };
  std::vector<double> force(3 * mesh.rest.size());
  force[3 * at({{0, 0, 0}}) + 2] = P;
  model.loads.push_back(make_growing_load(force));
  const Simulation simulation = equilibrium(std::move(model), 1, "half-space");
  std::vector<Vec3d> moved;
  for (const Vec3d& X : {Vec3d{{0.5, 0, 0}}, Vec3d{{0.5, 0, 0.5}}, Vec3d{{0, 0, 0.5}}}) {
    const double* q = &simulation.state().q[3 * at(X)];
    moved.push_back((1 / P) * (Vec3d{{q[0], q[1], q[2]}} - X));
  }
  return moved;
}

void check_half_space(const Subject& subject, Findings& found) {
  const double poisson = 0.3;
  const std::vector<int> cells = subject.quick ? std::vector<int>{4, 8} : std::vector<int>{8, 16};
  std::vector<std::vector<Vec3d>> by_mesh;
  for (const int n : cells) by_mesh.push_back(under_point_load(n, subject.replacement("linear"), poisson));
  const std::vector<Vec3d> points = {{{0.5, 0, 0}}, {{0.5, 0, 0.5}}, {{0, 0, 0.5}}};
  const char* names[] = {"on the surface", "at 45 degrees", "below the force"};
  for (size_t k = 0; k < points.size(); ++k) {
    const Vec3d exact = boussinesq(points[k], poisson, 1);
    for (const int axis : {2, 0}) {
      if (std::abs(exact[axis]) < 1e-9) continue;
      found.expect(std::string(names[k]) + ": displacement along " + (axis == 2 ? "z" : "x") + ", limit",
                   {richardson({by_mesh[0][k][axis], by_mesh[1][k][axis]}, 2), exact[axis],
                    (subject.quick ? 0.1 : 0.02) * exact[2]},
                   "extrapolated with order 2, 8 or 16 cells from the force: the point load disturbs that order", "m");
    }
  }
}

// Torque over twist per length in the middle of a square column of side 1 with G = `shear`.
double torsional_stiffness(int n, const std::string& material, double shear) {
  const double angle = 1e-4, length = 6;
  const TetMesh mesh = make_box({{-0.5, -0.5, 0}}, {{0.5, 0.5, length}}, {n, n, static_cast<int>(length) * n});
  Model model = make_model(mesh, {.material = material, .young = 2.6 * shear, .poisson = 0.3, .gravity = {}});
  const auto at_height = [&](double z) {
    return vertices_where(mesh, [z](const Vec3d& X) { return std::abs(X[2] - z) < 1e-9; });
  };
  const auto top = at_height(length);
  model.pins.push_back({"bottom", at_height(0), {}});
  model.pins.push_back({"top", top, [angle](const Vec3d& X, double t) {
                          return X + Vec3d{{-angle * t * X[1], angle * t * X[0], 0}};
                        }});
  const Simulation simulation = equilibrium(std::move(model), 1, "torsion");
  const std::vector<double> force = elastic_forces(simulation);
  double torque = 0;
  for (const int v : top) torque += mesh.rest[v][0] * force[3 * v + 1] - mesh.rest[v][1] * force[3 * v];
  const auto turn = [&](double z) {  // mean rotation of a section
    double moment = 0, inertia = 0;
    for (const int v : at_height(z)) {
      const Vec3d X = mesh.rest[v];
      moment += X[0] * simulation.state().q[3 * v + 1] - X[1] * simulation.state().q[3 * v];
      inertia += X[0] * X[0] + X[1] * X[1];
    }
    return moment / inertia;
  };
  return torque * 2 / (turn(length / 2 + 1) - turn(length / 2 - 1));
}

void check_torsion(const Subject& subject, Findings& found) {
  const std::string material = subject.replacement("linear");
  std::vector<double> values;
  for (const int n : subject.quick ? std::vector<int>{3, 6} : std::vector<int>{6, 12})
    values.push_back(torsional_stiffness(n, material, subject.stiffness));
  found.expect("torque / (G twist a^4), limit",
               {richardson(values, 2), 0.1405770, (subject.quick ? 0.03 : 3e-3) * 0.140577},
               "error of the extrapolation with order 2");
}

}  // namespace

void add_solid_checks(std::vector<Check>& checks) {
  checks.push_back(
      {"statics",
       "hollow_sphere",
       "Inflation of a thick hollow sphere",
       "Radii 1 and 2 m, nu = 0.3; the inner radius is blown up to 1.5 m, the outside is free.",
       "The ordinary differential equation of the radius, by shooting, from the printed formula of the "
       "material in principal stretches",
       check_sphere,
       {"Ogden1997"},
       {R"tex(\frac{d}{dR} \left(R^2 \frac{\partial \psi}{\partial s}\right) = R^2 \frac{\partial \psi}{\partial r}, \quad \psi = \psi(s, r / R, r / R), \quad s = \frac{dr}{dR})tex",
        R"tex(r(1) = 1.5, \quad \frac{\partial \psi}{\partial s}(2) = 0)tex"}});
  checks.push_back(
      {"statics",
       "half_space",
       "A point load on a half-space",
       "A block under a force at one vertex, its far faces moved as in the exact solution; nu = 0.3.",
       "Boussinesq's solution",
       check_half_space,
       {"Johnson1985"},
       {R"tex(u_r = \frac{P (1 + \nu)}{2 \pi E} \left(\frac{r z}{\rho^3} - \frac{(1 - 2 \nu)\, r}{\rho\, (\rho + z)}\right))tex",
        R"tex(u_z = \frac{P (1 + \nu)}{2 \pi E} \left(\frac{z^2}{\rho^3} + \frac{2 (1 - \nu)}{\rho}\right), \quad \rho^2 = r^2 + z^2)tex"}});
  checks.push_back({"statics",
                    "torsion",
                    "Torsion of a square column",
                    "1 x 1 x 6, the ends held plane and turned by 1e-4; twist measured in the middle third, where "
                    "sections warp freely.",
                    "Saint-Venant's torsional constant of a square",
                    check_torsion,
                    {"Timoshenko1970"},
                    {R"tex(M = G J\, \vartheta, \quad J = 0.140577\, a^4)tex"}});
}

}  // namespace aspic::verify
