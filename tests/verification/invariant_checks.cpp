// Invariants: zero resultants, rigid motions, numberings, reflections, units.
#include <algorithm>
#include <cmath>
#include <random>

#include "math/vectors.h"
#include "mesh/generators.h"
#include "reference/models.h"
#include "verification/families.h"

namespace aspic::verify {
namespace {

TetMesh small_box() { return make_box({{0, 0, 0}}, {{1, 0.8, 0.6}}, {3, 2, 2}); }

// Stretched, sheared and randomly perturbed positions.
std::vector<double> deformed(const TetMesh& mesh) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-0.03, 0.03);
  return at_vertices(mesh, [&](const Vec3d& X) {
    Vec3d x{};
    for (int r = 0; r < 3; ++r) x[r] = (1 + 0.1 * r) * X[r] + 0.2 * X[(r + 1) % 3] + uniform(random);
    return x;
  });
}

// Young's modulus and Poisson's ratio vary from tet to tet.
std::unique_ptr<TetElasticity> heterogeneous(const std::string& material, const TetMesh& mesh) {
  std::vector<MaterialParameters> parameters;
  for (int t = 0; t < mesh.tet_count(); ++t)
    parameters.push_back(material_parameters(material, {.young = 1 + 0.1 * t, .poisson = 0.1 + 0.004 * t}));
  return make_tet_elasticity(material, mesh, 0, parameters);
}

void check_forces(const Subject& subject, Findings& found) {
  const TetMesh mesh = small_box();
  const std::vector<double> x = deformed(mesh);
  for (const MaterialInfo& info : materials()) {
    const auto V = heterogeneous(subject.replacement(info.name), mesh);
    std::vector<double> g(x.size());
    V->add_gradient(x, 1, g);
    Vec3d sum{}, moment{};
    for (size_t i = 0; i < g.size(); i += 3) {
      const Vec3d f{{g[i], g[i + 1], g[i + 2]}};
      sum = sum + f;
      moment = moment + cross(Vec3d{{x[i], x[i + 1], x[i + 2]}}, f);
    }
    const double size = max_abs(g);
    found.expect_small(info.name + ": |sum of forces| / largest force", norm(sum) / size, 1e-13,
                       "round-off of sums over 36 vertices");
    if (!info.objective) continue;
    found.expect_small(info.name + ": |sum of moments| / largest force", norm(moment) / size, 1e-12,
                       "round-off of sums over 36 vertices");
  }
}

void check_rigid_motions(const Subject& subject, Findings& found) {
  const TetMesh mesh = small_box();
  const std::vector<double> x = deformed(mesh);
  const double c = std::cos(2.0), s = std::sin(2.0);
  const Mat3d R = Mat3d{{c, s, 0, -s, c, 0, 0, 0, 1}} * Mat3d{{1, 0, 0, 0, s, c, 0, -c, s}};
  std::vector<double> moved(x.size());
  for (size_t i = 0; i < x.size(); i += 3) {
    const Vec3d y = R * Vec3d{{x[i], x[i + 1], x[i + 2]}} + Vec3d{{5, -3, 2}};
    for (int r = 0; r < 3; ++r) moved[i + r] = y[r];
  }
  for (const MaterialInfo& info : materials()) {
    if (!info.objective) continue;
    const auto V = heterogeneous(subject.replacement(info.name), mesh);
    found.expect_small(info.name + ": |V(Rx + t) / V(x) - 1|", std::abs(V->value(moved) / V->value(x) - 1), 1e-13,
                       "round-off, enlarged by coordinates of 5 m beside strains of 0.1");
  }
}

struct Numbered {
  TetMesh mesh;
  std::vector<int> place;  // positions of vertices in the other mesh
};

Numbered renumbered(const TetMesh& mesh, int factor) {
  const int n = mesh.vertex_count();  // `factor` must not divide it
  Numbered other{mesh, std::vector<int>(n)};
  for (int v = 0; v < n; ++v) {
    other.place[v] = static_cast<int>((static_cast<int64_t>(factor) * v + 3) % n);
    other.mesh.rest[other.place[v]] = mesh.rest[v];
  }
  for (Tet& tet : other.mesh.tets)
    for (int& v : tet) v = other.place[v];
  std::reverse(other.mesh.tets.begin(), other.mesh.tets.end());
  return other;
}

// A cantilever that falls for ten steps. Nothing acts in its third direction z, except noise of the mesh.
std::vector<double> falling_beam(TetMesh mesh, const Vec3d& gravity, double h, const ModelOptions& options) {
  ModelOptions all = options;
  all.gravity = gravity;
  const auto at_wall = vertices_where(mesh, [](const Vec3d& X) { return X[0] == 0; });
  Model model = make_model(std::move(mesh), all);
  model.pins.push_back({"wall", at_wall, {}});
  SimulationOptions simulation_options{.h = h, .integrator = "backward_euler", .solver = {}};
  simulation_options.solver.minimize.tolerance = 1e-12;
  Simulation simulation = simulate(std::move(model), simulation_options);
  take_steps(simulation, 10, "falling beam");
  return simulation.state().q;
}

TetMesh beam_mesh(double size) { return make_box({{0, 0, 0}}, {{4 * size, size, size}}, {8, 2, 2}); }

void check_numbering(const Subject& subject, Findings& found) {
  const ModelOptions options{.material = subject.replacement("neo_hookean_log"), .young = 1e5};
  const Vec3d gravity{{0.5, -9.81, 2}};
  const TetMesh mesh = beam_mesh(1);
  const std::vector<double> q = falling_beam(mesh, gravity, 0.02, options);
  const Numbered other = renumbered(mesh, 7);
  const std::vector<double> p = falling_beam(other.mesh, gravity, 0.02, options);
  double most = 0;
  for (size_t i = 0; i < q.size(); ++i) most = std::max(most, std::abs(q[i] - p[3 * other.place[i / 3] + i % 3]));
  found.expect_small("largest change by another numbering", most, 1e-10,
                     "the solves are converged to 1e-12 of the forces", "m");

  TetMesh mirrored = mesh;  // reflects z, and exchanges two corners of each tet to keep volumes positive
  for (Vec3d& X : mirrored.rest) X[2] = -X[2];
  for (Tet& tet : mirrored.tets) std::swap(tet[0], tet[1]);
  const std::vector<double> m = falling_beam(mirrored, {{gravity[0], gravity[1], -gravity[2]}}, 0.02, options);
  most = 0;
  for (size_t i = 0; i < q.size(); ++i) most = std::max(most, std::abs(q[i] - (i % 3 == 2 ? -m[i] : m[i])));
  found.expect_small("largest change in the mirror", most, 1e-10, "the solves are converged to 1e-12 of the forces",
                     "m");
}

void check_units(const Subject& subject, Findings& found) {
  const std::string material = subject.replacement("neo_hookean_log");
  // Lengths and times scale by a, moduli and densities by b.
  const auto run = [&](double a, double b) {
    std::vector<double> q = falling_beam(beam_mesh(a), {{0, -9.81 / a, 0}}, 0.02 * a,
                                         {.material = material, .young = 1e5 * b, .density = 1000 * b});
    for (double& x : q) x /= a;
    return q;
  };
  const std::vector<double> meters = run(1, 1);
  struct Units {
    const char* name;
    double a, b;
  };
  for (const Units& units : {Units{"lengths and times / 1000", 1e-3, 1},
                             {"lengths and times x 1000", 1e3, 1},
                             {"moduli and densities / 1000", 1, 1e-3},
                             {"moduli and densities x 1e6", 1, 1e6}})
    found.expect_small(std::string("largest relative change by ") + units.name,
                       largest_difference(run(units.a, units.b), meters), 1e-9,
                       "the same iterations, apart from round-off");
}

}  // namespace

void add_invariant_checks(std::vector<Check>& checks) {
  checks.push_back({"invariants",
                    "forces",
                    "Internal forces have no resultant and no moment",
                    "A deformed box whose moduli differ from tet to tet, every material.",
                    "Newton's third law",
                    check_forces,
                    {},
                    {R"tex(\sum_i f_i = 0, \quad \sum_i x_i \times f_i = 0)tex"}});
  checks.push_back({"invariants",
                    "rigid_motions",
                    "The energy is invariant under rigid motions",
                    "The same box, rotated and moved: every material but linear.",
                    "Frame indifference",
                    check_rigid_motions,
                    {},
                    {R"tex(V(R x + t) = V(x))tex"}});
  checks.push_back({"invariants", "numbering", "Motions are invariant under renumbering and reflection",
                    "A cantilever falls for ten steps; vertices and tets are renumbered, or z is reflected.",
                    "The symmetry of the equations", check_numbering});
  checks.push_back({"invariants", "units", "Motions are independent of units",
                    "The same cantilever in other units of length and time, of modulus and density.",
                    "The equations are homogeneous", check_units});
}

}  // namespace aspic::verify
