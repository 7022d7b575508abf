// Fibres and muscle: identities, a pressurized artery, the force-velocity relation.
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <string>

#include "energy/fibres.h"
#include "material/fibre_law.h"
#include "mesh/generators.h"
#include "mesh/tet_nodes.h"
#include "mesh/tet_shape.h"
#include "reference/models.h"
#include "reference/statics.h"
#include "verification/families.h"

namespace aspic::verify {
namespace {

// Returns the root of an increasing function.
double root(double low, double high, const std::function<double(double)>& f) {
  for (int i = 0; i < 100; ++i) {
    const double middle = 0.5 * (low + high);
    (f(middle) > 0 ? high : low) = middle;
  }
  return 0.5 * (low + high);
}

void check_isotropy(const Subject&, Findings& found) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> entry(-1, 1);
  const auto axis = [&] {
    const Vec3d a = {{entry(random), entry(random), entry(random)}};
    return (1 / norm(a)) * a;
  };
  const auto mirror = [](const Vec3d& n) { return identity3<double>() - 2.0 * outer(n, n); };
  double most = 0;
  for (int i = 0; i < 100; ++i) {
    Mat3d F = 1.2 * identity3<double>();
    for (double& a : F.a) a += 0.2 * entry(random);
    const Vec3d a = axis(), b = axis();
    const Mat3d turned = F * (mirror(axis()) * mirror(axis()));  // a random rotation before F
    const double first = FibreLaw::psi(F, {3, 0.8, 1.0 / 3, a[0], a[1], a[2]});
    const double second = FibreLaw::psi(turned, {3, 0.8, 1.0 / 3, b[0], b[1], b[2]});
    most = std::max(most, std::abs(second / first - 1));
  }
  found.expect_small("relative difference of the energies of a rotated body", most, 1e-12, "round-off");
}

// An artery of one layer with two families of fibres, by the strain energy of an incompressible tube:
//   P = integral over the wall of (l_t dW/dl_t) dr / r
struct Artery {
  double radius = 0.71e-3, wall = 0.26e-3;     // [m], at rest
  double mu = 3000, k1 = 2363.2, k2 = 0.8393;  // [Pa], [Pa], [1]
  double angle = 29 * std::numbers::pi / 180;  // of the fibres to the circumference
  double stretch = 1.5, pressure = 13332.2;    // along the axis; [Pa]

  double hoop_slope(double around) const {
    const double c = std::cos(angle), s = std::sin(angle), across = 1 / (around * stretch);
    const double E = std::max(0.0, around * around * c * c + stretch * stretch * s * s - 1);
    return mu * (around * around - across * across) + 2 * (k1 * E * std::exp(k2 * E * E)) * 2 * around * around * c * c;
  }
  double pressure_at(double inner) const {  // by Simpson's rule in R
    constexpr int kParts = 200;
    double sum = 0;
    for (int i = 0; i <= kParts; ++i) {
      const double R = radius + wall * i / kParts;
      const double r = std::sqrt(inner * inner + (R * R - radius * radius) / stretch);
      sum += (i == 0 || i == kParts ? 1 : (i % 2 ? 4 : 2)) * hoop_slope(r / R) * R / (stretch * r * r);
    }
    return sum * wall / kParts / 3;
  }
  double inner_radius() const {
    return root(0.5 * radius, 4 * radius, [&](double r) { return pressure_at(r) - pressure; });
  }
};

// Inner radius of a quarter of a slice with n cells around it and n/4 through the wall.
double inflated_artery(const Artery& artery, int n, const std::string& material) {
  constexpr double kBulk = 1e8;
  const double height = artery.wall;
  TetMesh mesh = make_box({{0, 0, 0}}, {{1, 1, height}}, {n / 4, n, 1});
  for (Vec3d& X : mesh.rest) {
    const double R = artery.radius + artery.wall * X[0], angle = 0.5 * std::numbers::pi * X[1];
    X = {{R * std::cos(angle), R * std::sin(angle), X[2]}};
  }
  const std::vector<int> inner =
      vertices_where(mesh, [&](const Vec3d& X) { return std::hypot(X[0], X[1]) < artery.radius * (1 + 1e-6); });
  std::vector<char> is_inner(mesh.rest.size(), 0);
  for (const int v : inner) is_inner[v] = 1;
  mesh = raise_order(std::move(mesh));
  std::vector<Face> inside = boundary_faces(mesh, 0, mesh.tet_count());
  std::erase_if(inside, [&](const Face& face) {
    return std::any_of(face.corners.begin(), face.corners.end(),
                       [&](int v) { return static_cast<size_t>(v) >= is_inner.size() || !is_inner[v]; });
  });
  const auto family = [&](double sign) {
    std::vector<Fibre> fibres(mesh.tets.size(), Fibre{{}, artery.k1, artery.k2, 0});
    for (int t = 0; t < mesh.tet_count(); ++t)
      for (int q = 0; q < 4; ++q) {
        const std::array<double, 4> w = fibre_point(mesh, t, q);
        Vec3d X{};
        for (int i = 0; i < 4; ++i) X = X + w[i] * mesh.rest[mesh.tets[t][i]];
        const double r = std::hypot(X[0], X[1]), c = std::cos(artery.angle);
        fibres[t].directions[q] = {{-c * X[1] / r, c * X[0] / r, sign * std::sin(artery.angle)}};
      }
    return fibres;
  };
  const auto grow = [&](double t) { return 1 + (artery.stretch - 1) * std::min(t, 1.0); };
  const Lame lame{.mu = artery.mu, .lambda = kBulk};
  Model model = ModelBuilder(mesh)
                    .material(material, std::vector<MaterialParameters>(mesh.tets.size(), MaterialParameters{lame, {}}))
                    .density(1000)
                    .pin(
                        "z", [&](const Vec3d& X) { return X[2] < 1e-9 || X[2] > height - 1e-9; },
                        [&](const Vec3d& X, double t) {
                          return Vec3d{{X[0], X[1], grow(t) * X[2]}};
                        },
                        {{{0, 0, 1}}})
                    .pin("y", [](const Vec3d& X) { return std::abs(X[1]) < 1e-9; }, {}, {{{0, 1, 0}}})
                    .pin("x", [](const Vec3d& X) { return std::abs(X[0]) < 1e-9; }, {}, {{{1, 0, 0}}})
                    .load(make_fibres({"fibre", mesh}, family(1)))
                    .load(make_fibres({"fibre_2", mesh}, family(-1)))
                    .pressure("pressure", inside, [&](double t) { return artery.pressure * std::min(t, 1.0); })
                    .build();
  const Simulation simulation = equilibrium(std::move(model), 10, "artery", 1e-8);
  double sum = 0;
  for (const int v : inner) sum += std::hypot(simulation.state().q[3 * v], simulation.state().q[3 * v + 1]);
  return sum / static_cast<double>(inner.size());
}

void check_artery(const Subject& subject, Findings& found) {
  Artery artery;
  const double exact = artery.inner_radius();
  artery.mu *= subject.stiffness, artery.k1 *= subject.stiffness;
  for (const int n : subject.quick ? std::vector{8} : std::vector{8, 16, 32}) {
    const double measured = inflated_artery(artery, n, subject.replacement("neo_hookean_isochoric"));
    found.expect("inner radius, " + std::to_string(n) + " cells per quarter",
                 {1e3 * measured, 1e3 * exact, 2e-3 * 1e3 * exact}, "edges are straight", "mm");
  }
}

// A cube of 1 cm of a material that does not contract, with one fibre along x.
constexpr double kYoung = 2e4, kStrength = 1e5, kVelocity = 5, kCurvature = 0.25;

double passive(double l) { return kYoung * l * (l * l - 1) / 2; }
double overlap(double l) { return 1 - 4 * (1 - l) * (1 - l); }

// Stretch rate under a load P [Pa], by Hill's equation.
double shortening(double l, double P) {
  const double g = (P - passive(l)) / (kStrength * overlap(l));
  return kVelocity * (g - 1) / (1 + g / kCurvature);
}

Simulation released_muscle(double P, double h) {
  const TetMesh mesh = make_box({{0, 0, 0}}, {{0.01, 0.01, 0.01}}, {1, 1, 1});
  const auto force = traction_on(mesh, [](const Vec3d& X) { return X[0] > 0.009; }, {{P, 0, 0}});
  const MuscleFibre fibre{{Vec3d{{1, 0, 0}}}, kStrength, 1};
  const auto is_full = [](double) { return 1.0; };
  ModelBuilder builder =
      model_of(mesh, {.material = "stvk", .young = kYoung, .poisson = 0, .density = 1, .gravity = {}});
  for (const int axis : {0, 1, 2}) {
    Vec3d n{};
    n[axis] = 1;
    builder.pin(std::string(1, static_cast<char>('x' + axis)), [axis](const Vec3d& X) { return X[axis] == 0; }, {},
                {n});
  }
  builder.load(make_growing_load(force, [](double) { return 1.0; }));
  builder.load(make_muscle({"muscle", mesh}, std::vector<MuscleFibre>(mesh.tets.size(), fibre), is_full));
  Model model = builder.build();
  const MuscleVelocity slowed{fibre, kVelocity, kCurvature, 1.5};
  model.damping.push_back(
      make_muscle_velocity({"muscle_velocity", mesh}, std::vector<MuscleVelocity>(mesh.tets.size(), slowed), is_full));
  SimulationOptions options{.h = h, .integrator = "backward_euler", .solver = {}};
  options.solver.minimize.tolerance = 1e-10;
  return simulate(std::move(model), options);
}

double stretch_of(const Simulation& simulation) {
  double most = 0;
  for (size_t i = 0; i < simulation.state().q.size(); i += 3) most = std::max(most, simulation.state().q[i] / 0.01);
  return most;
}

void check_release(const Subject&, Findings& found) {
  for (const double share : {0.2, 0.5, 0.8}) {
    constexpr double kShort = 1e-4;
    Simulation simulation = released_muscle(share * kStrength, kShort);
    take_steps(simulation, 3, "release of a muscle");
    const double before = stretch_of(simulation);
    take_steps(simulation, 1, "release of a muscle");
    const double l = stretch_of(simulation), v = (before - l) / kShort / kVelocity;
    const double force = (share * kStrength - passive(l)) / (kStrength * overlap(l));
    found.expect("(P + a)(v + b) at " + std::to_string(share).substr(0, 3) + " of the strength",
                 {(force + kCurvature) * (v + kCurvature), (1 + kCurvature) * kCurvature, 1e-3},
                 "the change of the overlap in a step");
  }
  constexpr double kTime = 0.1, kLoad = 0.3 * kStrength;
  double exact = 1;
  constexpr int kParts = 1000;
  for (int i = 0; i < kParts; ++i) {  // Runge-Kutta of order 4
    const double d = kTime / kParts, a = shortening(exact, kLoad), b = shortening(exact + d / 2 * a, kLoad),
                 c = shortening(exact + d / 2 * b, kLoad), e = shortening(exact + d * c, kLoad);
    exact += d / 6 * (a + 2 * b + 2 * c + e);
  }
  std::vector<double> errors;
  double loss = 0, ledger = 0;
  for (const int steps : {20, 40, 80}) {
    Simulation simulation = released_muscle(kLoad, kTime / steps);
    for (int i = 0; i < steps; ++i) {
      const StepReport report = simulation.step();
      if (!is_success(report.status)) throw std::runtime_error("release of a muscle did not converge");
      loss += report.damping_loss, ledger = std::max(ledger, std::abs(report.ledger_error));
    }
    errors.push_back(std::abs(stretch_of(simulation) - exact));
  }
  found.expect("order of the stretch after 0.1 s", {std::log2(errors[1] / errors[2]), 1, 0.1}, "backward Euler");
  found.expect_small("error of the stretch with steps of 1.25 ms", errors[2], 2e-3, "order 1");
  found.expect_small("error of the energy balance over the loss", ledger / loss, 1e-9, "round-off");
}

}  // namespace

void add_tissue_checks(std::vector<Check>& checks) {
  checks.push_back({"tissue",
                    "dispersed_fibres",
                    "Fibres in all directions",
                    "The energy of fibres with the dispersion 1/3 for random deformations, and after random rotations "
                    "of the rest shape.",
                    "An isotropic energy does not depend on either",
                    check_isotropy,
                    {"Gasser2006"}});
  checks.push_back(
      {"tissue",
       "artery",
       "Inflated artery with two families of fibres",
       "A tube of 0.71 mm radius and 0.26 mm wall, mu = 3 kPa, k1 = 2.36 kPa, k2 = 0.84, fibres at 29 "
       "degrees to the circumference, stretched by 1.5 and under 13.3 kPa. A quarter with quadratic tets.",
       "The incompressible tube, by quadrature",
       check_artery,
       {"Holzapfel2000"},
       {R"tex(P = \int_{r_i}^{r_o} \lambda_\theta \frac{\partial W}{\partial \lambda_\theta} \frac{dr}{r})tex"}});
  checks.push_back({"tissue",
                    "quick_release",
                    "Quick release of a muscle",
                    "An active muscle shortens against a load below its strength.",
                    "Hill's hyperbola; the stretch over time by a Runge-Kutta method",
                    check_release,
                    {"Hill1938", "Blemker2005"},
                    {R"tex((P + a)(v + b) = \text{constant})tex"}});
}

}  // namespace aspic::verify
