// Relaxation and oscillation of homogeneous cubes with Maxwell branches.
#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>
#include <numbers>

#include "mesh/generators.h"
#include "mesh/tet_nodes.h"
#include "reference/models.h"
#include "verification/families.h"

namespace aspic::verify {
namespace {

using Complex = std::complex<double>;

struct CubeBranch {
  double shear, time;  // [Pa], [s]
};

struct StretchedCube {
  std::string material;
  double young = 1, poisson = 0;
  int order = 1;
  bool is_held = true;  // all vertices, in all directions; else only z at the ends, without friction
  std::vector<CubeBranch> branches = {};
};

// The stretch along z is a function of time.
Simulation stretched_cube(const StretchedCube& of, const std::function<double(double)>& stretch, double h) {
  const int cells = of.is_held ? 1 : 2;
  TetMesh mesh = make_box({{0, 0, 0}}, {{1, 1, 1}}, {cells, cells, cells});
  if (of.order == 2) mesh = raise_order(std::move(mesh));
  ModelBuilder builder =
      model_of(mesh, {.material = of.material, .young = of.young, .poisson = of.poisson, .gravity = {}});
  const auto motion = [stretch](const Vec3d& X, double t) { return Vec3d{{X[0], X[1], stretch(t) * X[2]}}; };
  const auto at = [](int axis, double place) {
    return [axis, place](const Vec3d& X) { return std::abs(X[axis] - place) < 1e-9; };
  };
  const Vec3d x{{1, 0, 0}}, y{{0, 1, 0}}, z{{0, 0, 1}};
  if (of.is_held) {
    builder.pin("end", at(2, 1), motion);
    builder.pin(
        "rest", [](const Vec3d& X) { return X[2] < 1 - 1e-9; }, motion);
  } else {
    builder.pin("end", at(2, 1), motion, {z}).pin("foot", at(2, 0), {}, {z});
    builder.pin("x", at(0, 0), {}, {x}).pin("y", at(1, 0), {}, {y});
  }
  for (const CubeBranch& b : of.branches) builder.maxwell_branch(b.shear, b.time);
  SimulationOptions options{.h = h, .integrator = "quasi_static", .solver = {}};
  options.solver.minimize.tolerance = 1e-10;
  return simulate(builder.build(), options);
}

StepReport converged_step(Simulation& simulation) {
  StepReport report = simulation.step();
  if (!is_success(report.status)) throw std::runtime_error("a step of the cube did not converge");
  return report;
}

double pulling_force(const StepReport& report) { return report.resultants.pins[0].force[2]; }  // [N]

// Relaxation after a ramp: the strain grows linearly to kRampStrain at kRamp, then stays.
constexpr double kRampStrain = 0.4, kRamp = 1.5;

// Stress of a branch [Pa].
double ramp_stress(const CubeBranch& b, double t) {
  const double rise = 2 * b.shear * kRampStrain * b.time / kRamp;
  const double reached = -rise * std::expm1(-std::min(t, kRamp) / b.time);
  return reached * std::exp(-std::max(t - kRamp, 0.0) / b.time);
}

// int |s|^2 / (2 G tau) dt until t > kRamp [J].
double ramp_loss(const CubeBranch& b, double t) {
  const double rise = 2 * b.shear * kRampStrain * b.time / kRamp, tau = b.time;
  const double growing =
      rise * rise * (kRamp + 2 * tau * std::expm1(-kRamp / tau) - tau / 2 * std::expm1(-2 * kRamp / tau));
  const double peak = ramp_stress(b, kRamp), falling = -peak * peak * tau / 2 * std::expm1(-2 * (t - kRamp) / tau);
  return (growing + falling) / (2 * b.shear * tau);
}

void check_relaxation(const Subject& subject, Findings& found) {
  const std::vector<CubeBranch> branches = {{0.7, 0.4}, {2, 3}, {1, 60}};
  for (const int order : {1, 2}) {
    StretchedCube of{.material = subject.replacement("stvk"), .order = order};
    for (const CubeBranch& b : branches) of.branches.push_back({subject.stiffness * b.shear, b.time});
    const auto strain = [](double t) { return kRampStrain * std::min(t / kRamp, 1.0); };
    Simulation simulation = stretched_cube(
        of, [&](double t) { return std::sqrt(1 + 2 * strain(t)); }, 0.25);
    double stress = 0, loss = 0, exact_loss = 0, stored = 0;
    for (int i = 0; i < 24; ++i) {
      const StepReport report = converged_step(simulation);
      const double t = report.time;
      double exact = strain(t), exact_stored = 0;  // E = 1 Pa, nu = 0
      for (const CubeBranch& b : branches) {
        const double s = ramp_stress(b, t);
        exact += s;
        exact_stored += s * s / (4 * b.shear);
      }
      stress = std::max(stress, std::abs(pulling_force(report) / std::sqrt(1 + 2 * strain(t)) / exact - 1));
      stored = std::max(stored, std::abs(report.potential.back() / exact_stored - 1));
      loss += report.viscoelastic_loss;
    }
    for (const CubeBranch& b : branches) exact_loss += ramp_loss(b, simulation.state().time);
    const std::string tets = order == 1 ? "linear tets: " : "quadratic tets: ", reason = "round-off";
    found.expect_small(tets + "largest error of the stress over the stress", stress, 1e-12, reason);
    found.expect_small(tets + "largest error of the stored over the stored energy", stored, 1e-12, reason);
    found.expect_small(tets + "error of the dissipated energy over this energy", loss / exact_loss - 1, 1e-12, reason);
  }
}

// Complex amplitude of `values`, one period, over that of sin(2 pi k / n), k = 1 ... n.
Complex complex_amplitude(const std::vector<double>& values) {
  Complex sum = 0;
  const auto n = static_cast<double>(values.size());
  for (size_t k = 0; k < values.size(); ++k)
    sum += values[k] * std::polar(1.0, -2 * std::numbers::pi * static_cast<double>(k + 1) / n);
  return Complex(0, 2 / n) * sum;
}

// Modulus of a branch with strains that are linear within steps, n per period.
Complex discrete_modulus(const CubeBranch& b, double frequency, int n) {
  const double x = 2 * std::numbers::pi / (n * frequency * b.time);
  const Complex z = std::polar(1.0, 2 * std::numbers::pi / n);
  return b.shear * -std::expm1(-x) / x * (z - 1.0) / (z - std::exp(-x));
}
Complex exact_modulus(const CubeBranch& b, double frequency) {
  const Complex iwt(0, frequency * b.time);
  return b.shear * iwt / (1.0 + iwt);
}

// Amplitude of the pull over that of the strain, sin(frequency t) times `strain`, in the last of several periods.
// `stretch`: of a strain.
Complex measured_modulus(const StretchedCube& of, double frequency, int n, double strain,
                         const std::function<double(double)>& stretch) {
  const double period = 2 * std::numbers::pi / frequency;
  Simulation simulation = stretched_cube(
      of, [&](double t) { return stretch(strain * std::sin(frequency * t)); }, period / n);
  double slowest = 0;
  for (const CubeBranch& b : of.branches) slowest = std::max(slowest, b.time);
  const int transient = n * static_cast<int>(std::ceil(36 * slowest / period));  // decays to 1e-16
  std::vector<double> stress;
  for (int i = 0; i < transient + n; ++i) {
    const StepReport report = converged_step(simulation);
    const double now = stretch(strain * std::sin(frequency * report.time));
    if (i >= transient) stress.push_back(pulling_force(report) / (of.is_held ? now : 1) / strain);
  }
  return complex_amplitude(stress);
}

void expect_second_order(const std::string& name, const std::vector<Complex>& errors, Findings& found) {
  const Complex last = errors.back(), before = errors[errors.size() - 2];
  const std::string reason = "the next term of the error";
  found.expect(name + ": order of the storage modulus", {std::log2(std::abs(before.real() / last.real())), 2, 0.1},
               reason);
  found.expect(name + ": order of the loss modulus", {std::log2(std::abs(before.imag() / last.imag())), 2, 0.1},
               reason);
}

// The second Piola-Kirchhoff stress of a strain E along z: (1 Pa + 2 G*) E.
void check_oscillation(const Subject& subject, Findings& found) {
  const CubeBranch b{2, 1};
  const std::vector<int> steps = subject.quick ? std::vector{32, 64} : std::vector{16, 32, 64, 128};
  for (const double frequency : {0.5, 1.0, 2.0}) {
    double deviation = 0;
    std::vector<Complex> errors;
    for (const int n : steps) {
      const StretchedCube of{.material = subject.replacement("stvk"),
                             .branches = {{subject.stiffness * b.shear, b.time}}};
      const Complex total =
          measured_modulus(of, frequency, n, 0.2, [](double strain) { return std::sqrt(1 + 2 * strain); });
      const Complex measured = (total - 1.0) / 2.0, expected = discrete_modulus(b, frequency, n);
      deviation = std::max(deviation, std::abs(measured - expected) / std::abs(expected));
      errors.push_back(measured - exact_modulus(b, frequency));
    }
    const std::string name = "frequency times relaxation time " + std::to_string(frequency).substr(0, 3);
    found.expect_small(name + ": largest error of the discrete modulus", deviation, 1e-10, "round-off");
    expect_second_order(name, errors, found);
  }
}

Complex young_of(double bulk, double shear, const Complex& branch) {
  const Complex K = bulk + branch * (2.0 / 3), G = shear + branch;
  return 9.0 * K * G / (3.0 * K + G);
}

void check_oscillating_pull(const Subject& subject, Findings& found) {
  constexpr double kPoisson = 0.45, kFrequency = 1, kSmallStrain = 1e-6;
  constexpr double kShear = 1 / (2 * (1 + kPoisson)), kBulk = 1 / (3 * (1 - 2 * kPoisson));
  const CubeBranch b{2 * kShear, 1};
  const std::vector<int> steps = {16, 32};
  double deviation = 0;
  std::vector<Complex> errors;
  for (const int n : steps) {
    const StretchedCube of{.material = subject.replacement("neo_hookean"),
                           .poisson = kPoisson,
                           .is_held = false,
                           .branches = {{subject.stiffness * b.shear, b.time}}};
    const Complex measured =
        measured_modulus(of, kFrequency, n, kSmallStrain, [](double strain) { return 1 + strain; });
    const Complex expected = young_of(kBulk, kShear, discrete_modulus(b, kFrequency, n));
    deviation = std::max(deviation, std::abs(measured - expected) / std::abs(expected));
    errors.push_back(measured - young_of(kBulk, kShear, exact_modulus(b, kFrequency)));
  }
  found.expect_small("largest error of the discrete modulus", deviation, 1e-8, "strains of 1e-6, and the solver");
  expect_second_order("pull", errors, found);
}

}  // namespace

void add_viscoelastic_checks(std::vector<Check>& checks) {
  checks.push_back({"viscoelasticity",
                    "relaxation",
                    "Relaxation after a ramp",
                    "A cube with three Maxwell branches is stretched by half; its strain grows linearly in time, then "
                    "stays. Stress, stored and dissipated energy.",
                    "Closed form",
                    check_relaxation,
                    {"Simo1987"},
                    {R"tex(s' + s/\tau = 2 G E')tex"}});
  checks.push_back({"viscoelasticity",
                    "oscillation",
                    "Storage and loss modulus",
                    "A cube is stretched so that its strain oscillates with the amplitude 0.2.",
                    "The modulus of the scheme in closed form, and that of a Maxwell branch",
                    check_oscillation,
                    {"Simo1987"},
                    {R"tex(G^*_h = G \phi \frac{z - 1}{z - e^{-x}},\quad z = e^{i\omega h},\quad x = h/\tau)tex",
                     R"tex(\phi = \frac{1 - e^{-x}}{x},\quad G^* = G \frac{i\omega\tau}{1 + i\omega\tau})tex"}});
  checks.push_back(
      {"viscoelasticity",
       "pull",
       "Oscillating pull with free sides",
       "A cube of nu = 0.45 is pulled with a small oscillating strain.",
       "Young's modulus of the complex bulk and shear moduli",
       check_oscillating_pull,
       {},
       {R"tex(E^* = \frac{9 K^* G^*}{3 K^* + G^*},\quad K^* = K + \tfrac23 G_b^*,\ G^* = \mu + G_b^*)tex"}});
}

}  // namespace aspic::verify
