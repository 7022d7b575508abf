// Integrators on problems with closed-form solutions: oscillator and free fall.
#include <algorithm>
#include <cmath>

#include "reference/integrators.h"
#include "verification/families.h"

namespace aspic::verify {
namespace {

void check_oscillator(const Subject& subject, Findings& found) {
  for (const std::string& integrator : integrators_in_time()) {
    const Oscillation expected = expected_oscillations().at(integrator);
    const Oscillation measured = measured_oscillation(subject.replacement(integrator));
    found.expect(integrator + ": energy left after a period",
                 {measured.energy_left, expected.energy_left, 6e-7 * std::max(1.0, expected.energy_left)},
                 "the last printed digit of the reference");
    found.expect(integrator + ": frequency ratio", {measured.frequency_ratio, expected.frequency_ratio, 6e-6},
                 "the last printed digit of the reference");
  }
}

Curve energy_curve(const Subject& subject, const std::string& integrator, int steps, double& worst_factor,
                   double factor) {
  Simulation simulation = oscillator({.h = 0.01, .integrator = subject.replacement(integrator), .solver = {}});
  Curve curve{integrator, {0}, {1}, CurveStyle::line};
  const double first = oscillator_energy(simulation);
  for (int i = 0; i < steps; ++i) {
    const double before = oscillator_energy(simulation);
    take_steps(simulation, 1, integrator);
    worst_factor = std::max(worst_factor, std::abs(oscillator_energy(simulation) / before - factor));
    curve.x.push_back(simulation.state().time);
    curve.y.push_back(oscillator_energy(simulation) / first);
  }
  return curve;
}

void check_symplectic_euler(const Subject& subject, Findings& found, Plot& plot) {
  const std::string name = "symplectic_euler";
  Simulation simulation = oscillator({.h = 0.01, .integrator = subject.replacement(name), .solver = {}});
  const double E = oscillator_energy(simulation);
  // q moves with the new velocity, so the shadow energy contains - h/2 w^2 x v.
  const auto shadow = [&] {
    return oscillator_energy(simulation) -
           0.5 * 0.01 * 100 * oscillator_position(simulation) * oscillator_velocity(simulation);
  };
  double least = 1, most = 1, drift = 0;
  Curve curve{name, {0}, {1}, CurveStyle::line};
  for (int i = 0; i < 1000; ++i) {
    take_steps(simulation, 1, name);
    const double ratio = oscillator_energy(simulation) / E;
    least = std::min(least, ratio), most = std::max(most, ratio);
    drift = std::max(drift, std::abs(shadow() / E - 1));
    if (i >= 200) continue;
    curve.x.push_back(simulation.state().time);
    curve.y.push_back(ratio);
  }
  const std::string reason =
      "1 / (1 +- w h / 2) is reached when a step ends at that phase; of 1000 steps, one "
      "comes within 1e-3 of it";
  found.expect(name + ": least energy / first", {least, 1 / 1.05, 1e-6}, reason);
  found.expect(name + ": largest energy / first", {most, 1 / 0.95, 1e-6}, reason);
  found.expect_small(name + ": drift of v^2/2 + w^2 x^2/2 - h/2 w^2 x v, relative", drift, 1e-11,
                     "round-off of 1000 steps");
  plot.curves.push_back(curve);
}

void check_euler_energies(const Subject& subject, Findings& found) {
  Plot plot{"energy of an oscillator, w h = 0.1", "time [s]", "energy / first", Scales::linear, {}};
  for (const auto& [integrator, factor] : {std::pair{"forward_euler", 1.01}, {"backward_euler", 1 / 1.01}}) {
    double worst = 0;
    plot.curves.push_back(energy_curve(subject, integrator, 100, worst, factor));
    found.expect_small(
        integrator + std::string(": |energy per step / the one before - ") + (factor > 1 ? "1.01|" : "1/1.01|"), worst,
        1e-12, "round-off of a step");
  }
  check_symplectic_euler(subject, found, plot);
  found.plots.push_back(plot);
}

void check_free_fall(const Subject& subject, Findings& found) {
  for (const std::string& integrator : integrators_in_time()) {
    found.expect_small(integrator + ": distance from the closed form after 10 steps",
                       free_fall_error(subject.replacement(integrator), expected_fall(integrator, kFallSteps)), 1e-13,
                       "round-off of 10 solves for positions of 1 m", "m");
  }
}

}  // namespace

void add_integrator_checks(std::vector<Check>& checks) {
  checks.push_back(
      {"integrators",
       "oscillator",
       "Damping and frequency of a harmonic oscillator",
       "Masses on springs, w h = 0.1, every integrator: the factor per step from four positions.",
       "The eigenvalue of each scheme's amplification matrix",
       check_oscillator,
       {"Hairer1996"},
       {R"tex(x_n = \operatorname{Re}(c\, r^n))tex",
        R"tex(\frac{E(t + T)}{E(t)} = |r|^{4 \pi / (\omega h)}, \quad \frac{\omega_h}{\omega} = \frac{\arg r}{\omega h})tex"}});
  checks.push_back(
      {"integrators",
       "euler_energies",
       "Energy of Euler's three methods",
       "m = 1 kg, k = 100 N/m, h = 0.01 s. Forward Euler gains energy, backward Euler loses it, symplectic Euler "
       "conserves a shadow energy.",
       "Closed forms of the three maps",
       check_euler_energies,
       {"Hairer1996"},
       {R"tex(E_{n+1} = (1 + \omega^2 h^2)\, E_n \quad \text{(forward Euler)})tex",
        R"tex(E_{n+1} = \frac{E_n}{1 + \omega^2 h^2} \quad \text{(backward Euler)})tex",
        R"tex(\tfrac12 v^2 + \tfrac12 \omega^2 x^2 - \tfrac{h}{2} \omega^2 x v = E_0, \quad \frac{E_0}{1 + \omega h / 2} \le E_n \le \frac{E_0}{1 - \omega h / 2} \quad \text{(symplectic Euler)})tex"}});
  checks.push_back(
      {"integrators",
       "free_fall",
       "Free fall of an elastic box",
       "The fall of a box after n = 10 steps, every integrator.",
       "The recurrence of each scheme under a constant force",
       check_free_fall,
       {},
       {R"tex(y_0 - y_n = \tfrac12 g h^2\, n (n + 1) \quad \text{(backward, linearly implicit, symplectic Euler)})tex",
        R"tex(y_0 - y_n = \tfrac12 g h^2\, n (n - 1) \quad \text{(forward Euler)})tex",
        R"tex(y_0 - y_n = \tfrac12 g h^2\, n^2 \quad \text{(others)})tex"}});
}

}  // namespace aspic::verify
