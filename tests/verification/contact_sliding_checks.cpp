// Blocks that stick and slide.
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "mesh/generators.h"
#include "verification/contact_models.h"
#include "verification/families.h"

namespace aspic::verify {
namespace {

// The state of rest under gravity across the slope without friction, reached by long steps.
State at_rest_on_floor(TouchingModel given) {
  given.friction = 0;
  given.gravity[0] = 0;
  Simulation simulation = simulate(make_touching(given), {.h = 0.05, .solver = {}});
  take_steps(simulation, 40, "coming to rest");
  State state = simulation.state();
  state.time = 0;
  std::fill(state.qdot.begin(), state.qdot.end(), 0.0);
  return state;
}

struct Slope {
  double tangent = 0, friction = 0, speed = 0;  // of the incline, coefficient, initial speed down the slope [m/s]
  double h = 0.01;
  std::string integrator;
};

// A block on an incline, in the frame of the incline: x points down. It starts in equilibrium without friction.
Simulation block_on_slope(const Slope& slope) {
  const double angle = std::atan(slope.tangent);
  TouchingModel given{.bodies = {{make_box({{-0.05, 0.0005, -0.05}}, {{0.05, 0.0255, 0.05}}, {4, 1, 4})}},
                      .has_floor = true,
                      .friction = slope.friction};
  given.bodies[0].young = 1e8;    // shear by the weight moves the center by 1e-6 m
  given.contact.stiffness = 1e5;  // rather than 1e7: pressures of 250 Pa are far below
  given.gravity = {{kGravity * std::sin(angle), -kGravity * std::cos(angle), 0}};
  State start = at_rest_on_floor(given);
  for (size_t i = 0; i < start.qdot.size(); i += 3) start.qdot[i] = slope.speed;
  SimulationOptions options{.h = slope.h, .integrator = slope.integrator, .solver = {}};
  return Simulation(make_touching(given), start, options);
}

double along(const Simulation& simulation) { return mass_mean(simulation.model(), simulation.state().q)[0]; }

double creep_of(const Simulation& simulation) {  // the default of [contact] creep
  Vec3d lower = simulation.model().mesh.rest[0], upper = lower;
  for (const Vec3d& X : simulation.model().mesh.rest)
    for (int k = 0; k < 3; ++k) lower[k] = std::min(lower[k], X[k]), upper[k] = std::max(upper[k], X[k]);
  return 1e-4 * std::sqrt(kGravity * norm(upper - lower));
}

// Distance after n steps with the acceleration a from rest. The first step of bdf2 is one of backward Euler.
double fallen(const std::string& integrator, double a, double h, int n) {
  if (integrator == "backward_euler") return a * h * h * n * (n + 1) / 2;
  return a * h * h * (n * n / 2.0 + 0.75 * (1 - std::pow(3.0, -n)));
}

void check_slope(const Subject& subject, const std::string& scheme, Findings& found) {
  const double mu = 0.5;
  const int steps = subject.quick ? 20 : 100;
  const std::string integrator = subject.replacement(scheme);
  for (const double share : {0.995, 0.9}) {  // of the critical slope
    Simulation simulation = block_on_slope({.tangent = share * mu, .friction = mu, .integrator = integrator});
    take_steps(simulation, 5, "sticking block");
    const double before = along(simulation), h = simulation.options().h;
    take_steps(simulation, steps, "sticking block");
    const double speed = (along(simulation) - before) / (steps * h);
    const double creep = creep_of(simulation) * (1 - std::sqrt(1 - share));
    found.expect(scheme + ", tan(angle) = " + std::to_string(share).substr(0, 5) + " mu: creep of the block",
                 {speed, creep, 0.02 * creep},
                 "the smoothed law slides at speed * (1 - sqrt(1 - tan / mu)); pressure is not uniform under the block",
                 "m/s");
  }
  for (const double share : {1.005, 1.2}) {
    Simulation simulation = block_on_slope({.tangent = share * mu, .friction = mu, .integrator = integrator});
    const double before = along(simulation), h = simulation.options().h, angle = std::atan(share * mu);
    take_steps(simulation, steps, "sliding block");
    const double a = kGravity * (std::sin(angle) - mu * std::cos(angle));
    const double expected = fallen(scheme, a, h, steps);
    const double allowed = 1e-3 * expected + (share < 1.1 ? 2 : 0) * creep_of(simulation) * h * steps;
    const std::string name = scheme + ", tan(angle) = " + std::to_string(share).substr(0, 5) + " mu: ";
    found.expect(name + "distance", {along(simulation) - before, expected, allowed},
                 share < 1.1 ? "1e-3, and a fifth of a percent above the threshold speeds pass the smoothed range"
                             : "1e-3: shear of the block and the solver's tolerance",
                 "m");
    expect_contact(name, simulation, found);
  }
}

void check_incline(const Subject& subject, Findings& found) {
  for (const char* scheme : {"backward_euler", "bdf2"}) check_slope(subject, scheme, found);
}

// The distance after a fixed time converges to a t^2 / 2.
void check_sliding_order(const Subject& subject, Findings& found) {
  const double mu = 0.5, tangent = 0.6, angle = std::atan(tangent), t = 0.2;
  const double exact = kGravity * (std::sin(angle) - mu * std::cos(angle)) * t * t / 2;
  for (const auto& [scheme, order] : {std::pair("backward_euler", 1), std::pair("bdf2", 2)}) {
    double error[2] = {};
    for (const int k : {0, 1}) {
      const int steps = 5 << k;
      Simulation simulation = block_on_slope(
          {.tangent = tangent, .friction = mu, .h = t / steps, .integrator = subject.replacement(scheme)});
      const double before = along(simulation);
      take_steps(simulation, steps, "sliding block");
      error[k] = along(simulation) - before - exact;
    }
    found.expect(std::string(scheme) + ": order of the distance", {std::log2(error[0] / error[1]), double(order), 0.2},
                 "two step lengths");
  }
}

void check_slide_to_rest(const Subject& subject, Findings& found) {
  const double mu = 0.3, speed = 1, a = mu * kGravity;
  const int steps = subject.quick ? 20 : 80;
  const double h = speed / (a * steps);  // so that it stops at the end of a step
  for (const std::string scheme : {"backward_euler", "bdf2"}) {
    Simulation simulation =
        block_on_slope({.friction = mu, .speed = speed, .h = h, .integrator = subject.replacement(scheme)});
    const double before = along(simulation);
    double loss = 0;
    for (int i = 0; i < steps + 10; ++i) {
      const StepReport report = simulation.step();
      if (!is_success(report.status)) throw std::runtime_error("sliding block: a step did not converge");
      loss += report.friction_loss;
    }
    // With bdf2, the first step adds -3/4 a h^2.
    const double stop = speed * speed / (2 * a);
    const double expected = scheme == "backward_euler" ? stop - speed * h / 2 : stop - 0.75 * a * h * h;
    found.expect(scheme + ": distance", {along(simulation) - before, expected, 1e-3 * expected},
                 "1e-3: the block shears and its pressure is uneven", "m");
    const double weight = 1000 * 0.1 * 0.025 * 0.1 * kGravity;  // of the block [N]
    found.expect(scheme + ": loss by friction / (mu m g distance)",
                 {loss / (mu * weight * (along(simulation) - before)), 1, 1e-3},
                 "1e-3: the block shears and its pressure is uneven");
    found.expect_small(scheme + ": speed at the end",
                       std::abs(mass_mean(simulation.model(), simulation.state().qdot)[0]), creep_of(simulation),
                       "a block at rest creeps slower than the limit", "m/s");
    expect_contact(scheme + ": ", simulation, found);
  }
}

// Boxes on each other on a slight slope.
void check_stack(const Subject& subject, Findings& found) {
  const int boxes = subject.quick ? 3 : 10, steps = subject.quick ? 20 : 1000;
  const double mu = 0.5, tangent = 0.3 / boxes, angle = std::atan(tangent), h = 0.02;
  TouchingModel given{.has_floor = true, .friction = mu};
  for (int i = 0; i < boxes; ++i) {
    const double low = 0.0005 + i * 0.1005, half = 0.05 - 0.003 * i;
    given.bodies.push_back(
        {make_box({{-half, low, -half}}, {{half, low + 0.1, half}}, {2 + i % 2, 2, 2 + i % 2}), 1e8});
  }
  given.gravity = {{kGravity * std::sin(angle), -kGravity * std::cos(angle), 0}};
  SimulationOptions options{.h = h, .integrator = subject.replacement("backward_euler"), .solver = {}};
  Simulation simulation(make_touching(given), options);
  take_steps(simulation, 50, "stack of boxes");
  const std::vector<double> before = simulation.state().q;
  double reported = 0;
  for (int i = 0; i < steps; ++i) {
    const StepReport report = simulation.step();
    if (!is_success(report.status)) throw std::runtime_error("stack of boxes: a step did not converge");
    reported += report.friction_creep;
  }
  expect_contact("", simulation, found);
  const double slip = creep_of(simulation) * (1 - std::sqrt(1 - tangent / mu));
  for (int i = 0; i < boxes; ++i) {
    const auto [first, end] = vertices_of(given, i);
    const Vec3d moved = mass_mean(simulation.model(), simulation.state().q, first, end) -
                        mass_mean(simulation.model(), before, first, end);
    found.expect(
        "box " + std::to_string(i + 1) + ": creep",
        {moved[0] / (steps * h), (i + 1) * slip, (i < 3 ? 0.01 : 0.03) * (i + 1) * slip},
        "each of the surfaces below creeps by the smoothed law; 1 % for the boxes that still settle, 3 % higher "
        "up, since a tall stack leans and its pressure is uneven",
        "m/s");
    found.expect_small("box " + std::to_string(i + 1) + ": motion / reported creep of the surfaces below it",
                       norm(moved) / ((i + 1) * reported), 1.01,
                       "the report has the largest creep of all surfaces; 1 % since a tall stack leans");
    found.expect_small("box " + std::to_string(i + 1) + ": motion across the slope", std::abs(moved[2]),
                       1e-3 * h * steps * (i + 1) * slip,
                       "nothing acts there, a thousandth of the creep for meshes without symmetry", "m");
  }
}

}  // namespace

void add_contact_sliding_checks(std::vector<Check>& checks) {
  checks.push_back(
      {"contact",
       "incline",
       "A block on an incline sticks below the angle of friction and slides above it",
       "mu = 0.5; slopes of 0.9, 0.995, 1.005 and 1.2 mu.",
       "Coulomb's law with backward Euler and BDF2; below the angle of friction, the smoothed law creeps, s is its "
       "speed",
       check_incline,
       {},
       {R"tex(x_n = \tfrac12 a h^2\, n (n + 1), \quad a = g (\sin \alpha - \mu \cos \alpha) \quad (\tan \alpha > \mu))tex",
        R"tex(x_n = a h^2 \left( \tfrac12 n^2 + \tfrac34 (1 - 3^{-n}) \right) \quad (\text{BDF2}))tex",
        R"tex(\dot x = s \left(1 - \sqrt{1 - \tan \alpha / \mu}\right) \quad (\tan \alpha < \mu))tex"}});
  checks.push_back(
      {"contact",
       "slide_to_rest",
       "A sliding block comes to rest",
       "1 m/s on a level floor, mu = 0.3.",
       "Coulomb's law with backward Euler and BDF2",
       check_slide_to_rest,
       {},
       {R"tex(x = \frac{v^2}{2 \mu g} - \frac{v h}{2}, \quad x = \frac{v^2}{2 \mu g} - \tfrac34 \mu g h^2 \quad (\text{BDF2}))tex"}});
  checks.push_back({"contact",
                    "sliding_order",
                    "Sliding converges with the order of the integrator",
                    "A block slides down a slope of 1.2 mu, mu = 0.5.",
                    "Coulomb's law",
                    check_sliding_order,
                    {},
                    {R"tex(x = \tfrac12 g (\sin \alpha - \mu \cos \alpha)\, t^2)tex"}});
  checks.push_back({"contact",
                    "stack",
                    "A stack of boxes stays at rest",
                    "Ten stiff boxes on a slope of 0.03, mu = 0.5, 1 000 steps.",
                    "The creep of the smoothed law of friction for each surface below; s is its speed",
                    check_stack,
                    {},
                    {R"tex(\dot x_i = i\, s \left(1 - \sqrt{1 - \tan \alpha / \mu}\right))tex"}});
}

}  // namespace aspic::verify
