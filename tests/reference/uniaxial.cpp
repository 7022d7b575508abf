#include "reference/uniaxial.h"

#include <cmath>
#include <functional>
#include <stdexcept>

#include "material/list.h"
#include "material/reference.h"
#include "mesh/generators.h"
#include "reference/models.h"

namespace aspic::verify {
namespace {

using Real = long double;

// Unit cube with two cells per edge; the center vertex is displaced.
TetMesh distorted_box() {
  TetMesh mesh = make_box({{0, 0, 0}}, {{1, 1, 1}}, {2, 2, 2});
  mesh.rest[13] = mesh.rest[13] + Vec3d{{0.11, -0.07, 0.05}};
  return mesh;
}

struct Forces {
  double along, across;  // on the faces x = 1 and y = 1
  double inner;          // force on the inner vertex
};

Forces forces_of(const TetMesh& mesh, const TetElasticity& elasticity, double l, double t) {
  std::vector<double> g(3 * mesh.rest.size());
  elasticity.add_gradient(at_vertices(mesh,
                                      [l, t](const Vec3d& X) {
                                        return Vec3d{{l * X[0], t * X[1], t * X[2]}};
                                      }),
                          1, g);
  Forces forces{0, 0, std::hypot(g[3 * 13], g[3 * 13 + 1], g[3 * 13 + 2])};
  for (size_t v = 0; v < mesh.rest.size(); ++v) {
    if (mesh.rest[v][0] == 1) forces.along += g[3 * v];
    if (mesh.rest[v][1] == 1) forces.across += g[3 * v + 1];
  }
  return forces;
}

// Secant method from t and a nearby point, down to round-off.
double root_near(double t, const std::function<double(double)>& f, const std::string& what) {
  double before = t * 1.001, f_before = f(before);
  for (int i = 0; i < 60; ++i) {
    const double ft = f(t);
    if (ft == 0 || ft == f_before) return t;
    const double next = t - ft * (t - before) / (ft - f_before);
    before = t, f_before = ft, t = next;
    if (std::abs(t - before) <= 1e-14 * std::abs(t)) return t;
  }
  throw std::runtime_error(what + ": no lateral stretch without force was found, the last one was " +
                           std::to_string(t));
}

}  // namespace

long double principal_energy(const std::string& material, const std::array<long double, 3>& stretch, double young,
                             double poisson) {
  long double energy = 0;
  with_material(material, [&]<class M>() {
    energy = M::reference_energy(PrincipalStretches(stretch), {young, poisson});
  });
  return energy;
}

StretchedBox stretched_box(const std::string& material, const MaterialParameters& parameters, double l, double guess) {
  const TetMesh mesh = distorted_box();
  const auto elasticity =
      make_tet_elasticity(material, mesh, 0, std::vector<MaterialParameters>(mesh.tet_count(), parameters));
  const double t = root_near(
      guess, [&](double s) { return forces_of(mesh, *elasticity, l, s).across; },
      material + ", l = " + std::to_string(l));
  const Forces forces = forces_of(mesh, *elasticity, l, t);
  return {{t, forces.along}, forces.inner / std::abs(forces.along)};
}

Uniaxial uniaxial_of_energy(const std::string& material, double young, double poisson, double l) {
  const auto psi = [&](Real a, Real b) { return principal_energy(material, {a, b, b}, young, poisson); };
  const Real h = 1e-3L;  // sixth-order differences: error h^6, round-off 1e-19 / h
  const auto slope = [h](const auto& f) {
    return (45 * (f(h) - f(-h)) - 9 * (f(2 * h) - f(-2 * h)) + (f(3 * h) - f(-3 * h))) / (60 * h);
  };
  const Real x = l;
  const auto across = [&](Real t) { return slope([&](Real d) { return psi(x, t + d); }); };
  const Real guess = std::pow(x, -static_cast<Real>(poisson));
  // Round-off of the differences dominates that of t.
  Real t = guess;
  for (int i = 0; i < 50; ++i) {
    const Real step = across(t) / slope([&](Real d) { return across(t + d); });
    t -= step;
    if (std::abs(step) < 1e-15L) break;
  }
  return {static_cast<double>(t), static_cast<double>(slope([&](Real d) { return psi(x + d, t); }))};
}

}  // namespace aspic::verify
