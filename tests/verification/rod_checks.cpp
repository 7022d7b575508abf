// Rods: a heavy cantilever, and buckling by twist.
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "energy/linear_load.h"
#include "energy/rod.h"
#include "mesh/rod_shapes.h"
#include "reference/statics.h"
#include "verification/families.h"

namespace aspic::verify {
namespace {

constexpr double kRodPi = std::numbers::pi;

// Factorizes a symmetric matrix as L L'.
bool is_definite(std::vector<std::vector<double>> A) {
  for (size_t j = 0; j < A.size(); ++j)
    for (size_t i = j; i < A.size(); ++i) {
      double sum = A[i][j];
      for (size_t k = 0; k < j; ++k) sum -= A[i][k] * A[j][k];
      if (i == j && !(sum > 0)) return false;
      A[i][j] = i == j ? std::sqrt(sum) : sum / A[j][j];
    }
  return true;
}

// A rod of length about 1 with E I = G J = 1 and a large stretching stiffness.
struct TestRod {
  static constexpr double kRadius = 0.01;

  TetMesh mesh;
  std::vector<RodSegment> segments;

  explicit TestRod(TetMesh polyline, double stiffness) : mesh(std::move(polyline)) {
    mesh.radius.assign(mesh.rods.size(), kRadius);
    for (size_t s = 0; s < mesh.rods.size(); ++s) {
      RodSegment segment{mesh.rods[s], stiffness, 1};
      segment.is_straight = true;
      segment.row = mesh.vertex_count() + static_cast<int>(s / 3);
      segment.entry = static_cast<int>(s % 3);
      segment.length = kRadius;
      segments.push_back(segment);
    }
  }

  size_t entry(size_t segment) const {
    return 3 * static_cast<size_t>(segments[segment].row) + segments[segment].entry;
  }
  int rows() const { return mesh.vertex_count() + static_cast<int>((segments.size() + 2) / 3); }
  std::vector<double> young() const {
    return std::vector<double>(segments.size(), 4 / (kRodPi * std::pow(kRadius, 4)));
  }
  std::vector<double> at_rest() const {
    std::vector<double> x;
    for (const Vec3d& X : mesh.rest) x.insert(x.end(), X.a, X.a + 3);
    x.resize(3 * static_cast<size_t>(rows()), 0.0);
    return x;
  }

  // Returns whether the Hessian in these degrees of freedom, plus `shift` times the identity, is positive definite.
  bool is_stable(const std::vector<double>& x, const std::vector<size_t>& free, double shift) const {
    const auto stretch = make_rod_stretch(mesh, 0, young());
    const auto bending = make_rod_bending(mesh, segments);
    Couplings couplings;
    stretch->add_couplings(couplings);
    bending->add_couplings(couplings);
    const BlockPattern pattern = make_pattern(rows(), couplings);
    BlockSparse H(pattern);
    for (Energy* V : {static_cast<Energy*>(stretch.get()), bending.get()}) {
      V->bind(pattern);
      ActiveTerm(*V).add_hessian(x, 1, {}, H);
    }
    std::vector<std::vector<double>> dense;
    std::vector<double> e(x.size(), 0.0), column(x.size());
    for (size_t j = 0; j < free.size(); ++j) {
      e[free[j]] = 1;
      H.multiply(e, column);
      e[free[j]] = 0;
      std::vector<double>& row = dense.emplace_back();
      for (const size_t i : free) row.push_back(column[i]);
      row[j] += shift;
    }
    return is_definite(std::move(dense));
  }
};

// Returns the value in [low, high] at which a rod becomes unstable.
template <class IsStable>
double critical(double low, double high, const IsStable& is_stable) {
  for (int i = 0; i < 16; ++i) {
    const double middle = 0.5 * (low + high);
    (is_stable(middle) ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

// Clamped by a segment beyond each end. Returns the critical torque times L / (E I).
double critical_torque(int n, const Subject& subject) {
  const double h = 1.0 / n;
  TestRod rod(make_line({{-h, 0, 0}}, {{1 + h, 0, 0}}, h), subject.stiffness);
  rod.segments.front().is_held = rod.segments.back().is_held = true;
  std::vector<size_t> free;
  for (size_t i = 6; i < 3 * static_cast<size_t>(n + 1); ++i) free.push_back(i);
  for (int s = 1; s <= n; ++s) free.push_back(rod.entry(static_cast<size_t>(s)));
  return critical(4, 16, [&](double torque) {
    std::vector<double> x = rod.at_rest();
    for (int s = 1; s <= n + 1; ++s)
      x[rod.entry(static_cast<size_t>(s))] = TestRod::kRadius * torque * std::min((s - 0.5) / n, 1.0);
    return rod.is_stable(x, free, 0);
  });
}

void check_rod_torque(const Subject& subject, Findings& found) {
  std::vector<double> torques;
  Curve curve{"discrete rod", {}, {}}, exact{"series", {}, {}, CurveStyle::dashed};
  for (const int n : {12, 24, 48}) {
    if (subject.quick && n > 24) break;
    torques.push_back(critical_torque(n, subject));
    curve.x.push_back(n), curve.y.push_back(torques.back());
    exact.x.push_back(n), exact.y.push_back(8.9868);
  }
  found.expect("critical M L / (E I)", {richardson(torques, 2), 8.9868, 0.01 * 8.9868},
               "extrapolated from the two finest polylines");
  found.plots.push_back({"buckling torque", "segments", "M L / (E I)", Scales::linear, {curve, exact}});
}

// A straight rod closed to a ring: its total twist is minus the natural one.
double critical_twist(int n, const Subject& subject) {
  std::vector<size_t> free;
  return critical(9, 15, [&](double twist) {
    TestRod rod(make_ring(1, 2 * kRodPi / n), subject.stiffness);
    double length = 0;
    for (const auto& [a, b] : rod.mesh.rods) length += norm(rod.mesh.rest[b] - rod.mesh.rest[a]);
    for (RodSegment& segment : rod.segments) segment.natural_twist = -twist / length;
    free.clear();
    for (size_t i = 0; i < 3 * static_cast<size_t>(n); ++i) free.push_back(i);
    for (int s = 0; s < n; ++s) free.push_back(rod.entry(static_cast<size_t>(s)));
    constexpr double kRigid = 1e-3;  // rigid motions have eigenvalues of round-off
    return rod.is_stable(rod.at_rest(), free, kRigid);
  });
}

void check_rod_ring(const Subject& subject, Findings& found) {
  std::vector<double> twists;
  for (const int n : {16, 32, 64}) {
    if (subject.quick && n > 32) break;
    twists.push_back(critical_twist(n, subject));
  }
  const double michell = 2 * kRodPi * std::sqrt(3.0);
  found.expect("critical twist G J / (E I)", {richardson(twists, 2), michell, 0.01 * michell},
               "extrapolated from the two finest polylines");
}

// Length 1, weight w = 10 E I per length, clamped by a segment beyond its end.
void check_heavy_rod(const Subject& subject, Findings& found) {
  constexpr int n = 20;
  constexpr double h = 1.0 / n;
  TestRod rod(make_line({{-h, 0, 0}}, {{1, 0, 0}}, h), subject.stiffness);
  rod.segments[0].is_held = true;
  Model model;
  model.mesh = rod.mesh;
  model.density.assign(rod.segments.size(), 1);
  model.bodies = {{"rod", 0, rod.mesh.vertex_count()}};
  model.bodies[0].segment_count = static_cast<int>(rod.segments.size());
  model.pins = {{"wall", {0, 1}, {}}, {"twist", {rod.segments[0].row}, {}, {{{1, 0, 0}}}}};
  model.angle_rows = make_rod_rows(rod.mesh, 0, model.density, TestRod::kRadius);
  model.elasticity.push_back(make_rod_stretch(rod.mesh, 0, rod.young()));
  model.damping.push_back(make_rod_bending(rod.mesh, rod.segments));
  model.mass = std::make_unique<MassMatrix>(model.mesh, model.density, MassKind::lumped, angle_masses(model));
  std::vector<double> force(3 * rod.mesh.rest.size(), 0.0);
  for (int v = 1; v <= n + 1; ++v) force[3 * static_cast<size_t>(v) + 2] = -10 * h * (v == 1 || v == n + 1 ? 0.5 : 1);
  model.loads.push_back(make_linear_load("load", std::move(force)));
  SimulationOptions options{.h = 1, .integrator = "quasi_static", .initial_guess = "zero", .solver = {}};
  options.solver.minimize.tolerance = 1e-9;
  options.solver.minimize.max_iterations = 1000;
  Simulation simulation = simulate(std::move(model), options);
  take_steps(simulation, 1, "the heavy rod");
  const Vec3d tip = point(simulation.state().q, n + 1);
  found.expect("x / L of the tip", {tip[0], 0.6563538, 0.005 * 0.6563538}, "the error of 20 segments");
  found.expect("z / L of the tip", {tip[2], -0.7001997, 0.005 * 0.7001997}, "the error of 20 segments");
}

}  // namespace

void add_rod_checks(std::vector<Check>& checks) {
  checks.push_back({"statics",
                    "heavy_rod",
                    "Large deflection of a rod under its weight",
                    "w L^3 / (E I) = 10, clamped, 20 segments.",
                    "The heavy elastica, by shooting",
                    check_heavy_rod,
                    {},
                    {R"tex(E I \theta'' = -w (L - s) \cos \theta, \quad \theta(0) = 0, \quad \theta'(L) = 0)tex"}});
  checks.push_back({"statics",
                    "rod_torque",
                    "Buckling of a clamped rod under torque",
                    "Smallest torque at which the Hessian of the straight rod is singular; both ends are clamped.",
                    "Greenhill's problem with clamped ends",
                    check_rod_torque,
                    {},
                    {R"tex(\tan \frac{m}{2} = \frac{m}{2}, \quad m = \frac{M L}{E I} = 8.987)tex"}});
  checks.push_back({"statics",
                    "rod_ring",
                    "Michell's instability of a twisted ring",
                    "Total twist at which the Hessian of a ring of a straight rod becomes indefinite.",
                    "Michell's solution for a closed ring",
                    check_rod_ring,
                    {},
                    {R"tex(\varphi = 2 \pi \sqrt{3} \, \frac{E I}{G J})tex"}});
}

}  // namespace aspic::verify
