// Large torsion of a round cylinder: torque, axial force, radius.
#include <cmath>

#include "mesh/generators.h"
#include "reference/radial_reference.h"
#include "reference/statics.h"
#include "verification/families.h"

namespace aspic::verify {
namespace {

constexpr double kCylinderPoisson = 0.3, kTwist = 1, kHeight = 0.5;  // cylinder of radius 1 [1], [rad/m], [m]

struct Twisted {
  double torque, force, outer;  // by the ends on the cylinder; outer radius at half height
};

Twisted twisted(int rings, const std::string& material, const Torsion& exact) {
  const TetMesh mesh = make_cylinder(1, kHeight, 1.0 / rings);
  const auto at_height = [&mesh](double z) {
    return vertices_where(mesh, [z](const Vec3d& X) { return std::abs(X[2] - z) < 1e-9; });
  };
  Model model = make_model(mesh, {.material = material, .young = 1, .poisson = kCylinderPoisson, .gravity = {}});
  const auto motion = [&exact](const Vec3d& X, double t) {
    const double R = std::hypot(X[0], X[1]), stretch = R > 0 ? exact.radius(R) / R : 1;
    const double angle = t * kTwist * X[2], c = std::cos(angle), s = std::sin(angle);
    const double now = 1 + t * (stretch - 1);
    return Vec3d{{now * (c * X[0] - s * X[1]), now * (s * X[0] + c * X[1]), X[2]}};
  };
  const std::vector<int> top = at_height(kHeight);
  model.pins.push_back({"bottom", at_height(0), motion});
  model.pins.push_back({"top", top, motion});
  const Simulation simulation = equilibrium(std::move(model), 2, material, 1e-9);
  const std::vector<double>&q = simulation.state().q, force = elastic_forces(simulation);
  Twisted found{0, sum_over(top, force)[2], 0};
  for (const int v : top) found.torque += q[3 * v] * force[3 * v + 1] - q[3 * v + 1] * force[3 * v];
  int side = 0;
  for (const int v : at_height(kHeight / 2)) {
    if (std::hypot(mesh.rest[v][0], mesh.rest[v][1]) < 1 - 1e-9) continue;
    found.outer += std::hypot(q[3 * v], q[3 * v + 1]);
    ++side;
  }
  found.outer /= side;
  return found;
}

void check_cylinder(const Subject& subject, Findings& found) {
  const std::vector<int> rings = subject.quick ? std::vector<int>{4, 8} : std::vector<int>{8, 16};
  std::vector<std::string> names = {"neo_hookean_log"};
  if (!subject.quick) names.insert(names.end(), {"stable_neo_hookean", "mooney_rivlin"});
  for (const std::string& material : names) {
    const Torsion exact = twisted_cylinder(material, kCylinderPoisson, kTwist);
    std::vector<double> torque, force, outer;
    for (const int n : rings) {
      const Twisted one = twisted(n, subject.replacement(material), exact);
      torque.push_back(one.torque), force.push_back(one.force), outer.push_back(one.outer);
    }
    const double tolerance = subject.quick ? 0.02 : 2e-3;
    const std::string reason = "error of the extrapolation with order 2: the next term";
    found.expect(material + ": torque / (E b^3), limit",
                 {richardson(torque, 2), exact.torque, tolerance * exact.torque}, reason);
    found.expect(material + ": axial force / (E b^2), limit",
                 {richardson(force, 2), exact.force, tolerance * std::abs(exact.force)}, reason);
    found.expect(material + ": change of the radius / b, limit",
                 {richardson(outer, 2) - 1, exact.radius(1) - 1, tolerance * std::abs(exact.radius(1) - 1)}, reason);
  }
}

}  // namespace

void add_cylinder_checks(std::vector<Check>& checks) {
  checks.push_back(
      {"statics",
       "twisted_cylinder",
       "Finite torsion of a round cylinder",
       "A round cylinder of fixed length is twisted by 1 rad per radius, nu = 0.3, its ends as in the exact "
       "solution, its side free. Its ends are under pressure (Poynting effect).",
       "The ordinary differential equation of the radius, by shooting, from the printed formula of the "
       "material in principal stretches",
       check_cylinder,
       {"Rivlin1949", "Ogden1997"},
       {R"tex(x = (r \cos(\Theta + \tau Z),\; r \sin(\Theta + \tau Z),\; Z), \quad r = r(R), \quad s = \frac{dr}{dR})tex",
        R"tex(\frac{d}{dR} \left(R\, \frac{\partial \psi}{\partial s}\right) = R\, \frac{\partial \psi}{\partial r}, \quad \frac{\partial \psi}{\partial s}(1) = 0)tex"}});
}

}  // namespace aspic::verify
