// Pages 23 and 24: the scheme printed as "Forward Euler", and backward Euler.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "aspic/lecture/course.h"
#include "aspic/lecture/run_scene.h"
#include "dynamics/ledger.h"
#include "energy/springs.h"

namespace aspic::cli::lecture {
namespace {

constexpr double kStiffness = 100, kStep = 0.01;  // [N/m], [s]

// Four masses of 1 kg, each on a spring to its rest position: w = 10 rad/s.
Simulation make_oscillator(const std::string& integrator) {
  Model model;
  model.mesh = {{{{0, 0, 0}}, {{1, 0, 0}}, {{0, 1, 0}}, {{0, 0, 1}}}, {{0, 1, 2, 3}}, {}};
  model.bodies = {{"masses", 0, 4, 0, 1}};
  model.density = {4 / volume(model.mesh, 0)};
  model.mass = std::make_unique<MassMatrix>(model.mesh, model.density, MassKind::lumped);
  State start;
  std::vector<PointSpring> springs;
  for (int v = 0; v < 4; ++v) {
    const Vec3d X = model.mesh.rest[v];
    springs.push_back({v, kStiffness, [X](double) { return X; }});
    start.q.insert(start.q.end(), {X[0] + 0.1, X[1], X[2]});
  }
  start.qdot.assign(12, 0.0);
  model.loads.push_back(make_point_springs("point_springs", springs));
  return Simulation(std::move(model), std::move(start), {.h = kStep, .integrator = integrator});
}

struct Oscillation {
  Vector time, energy, modified;                  // relative to the start; modified: invariant of symplectic Euler
  double least_ratio = INFINITY, most_ratio = 0;  // energy ratio of consecutive steps
};

Oscillation oscillate(const std::string& integrator, int steps) {
  Simulation simulation = make_oscillator(integrator);
  const auto energy = [&] { return simulation.kinetic_energy() + simulation.potential_energies()[0]; };
  const auto modified = [&] {
    double coupling = 0;  // sum of x v
    for (size_t i = 0; i < 12; ++i)
      coupling += (simulation.state().q[i] - simulation.model().mesh.rest[i / 3][i % 3]) * simulation.state().qdot[i];
    return energy() - kStep / 2 * kStiffness * coupling;
  };
  const double first = energy(), first_modified = modified();
  Oscillation result{{0}, {1}, {1}};
  for (int i = 0; i < steps; ++i) {
    simulation.step();
    const double ratio = energy() / first / result.energy.back();
    result.least_ratio = std::min(result.least_ratio, ratio);
    result.most_ratio = std::max(result.most_ratio, ratio);
    result.time.push_back(simulation.state().time);
    result.energy.push_back(energy() / first);
    result.modified.push_back(modified() / first_modified);
  }
  return result;
}

double distance_from(const Vector& values, double target) {
  double most = 0;
  for (const double x : values) most = std::max(most, std::abs(x - target));
  return most;
}

void check_oscillator(Sheet& sheet) {
  constexpr int kSteps = 300;
  const Oscillation forward = oscillate("forward_euler", kSteps), printed = oscillate("symplectic_euler", kSteps),
                    backward = oscillate("backward_euler", kSteps);
  CsvFile table = sheet.table("oscillator.csv", {"time_s", "forward_euler", "symplectic_euler", "backward_euler"});
  for (size_t i = 0; i < forward.time.size(); ++i)
    table.append(CsvRow().add(forward.time[i]).add(forward.energy[i]).add(printed.energy[i]).add(backward.energy[i]));
  const double growth = 1 + kStep * kStep * kStiffness;  // 1.01
  const std::string why = "1 + w^2 h^2 exactly, to round-off of 1e-16 per operation";
  sheet.at_most("classical forward Euler: |growth of the energy per step - 1.01|",
                std::max(growth - forward.least_ratio, forward.most_ratio - growth), 1e-12, "", why);
  sheet.at_most("backward Euler: |shrinking of the energy per step - 1.01|",
                std::max(1 / backward.least_ratio - growth, growth - 1 / backward.most_ratio), 1e-12, "", why);
  sheet.at_least("symplectic Euler: least energy / first",
                 *std::min_element(printed.energy.begin(), printed.energy.end()), 1 / 1.05 - 1e-12, "",
                 "1 / (1 + w h / 2) but for round-off");
  sheet.at_most("symplectic Euler: largest energy / first",
                *std::max_element(printed.energy.begin(), printed.energy.end()), 1 / 0.95 + 1e-12, "",
                "1 / (1 - w h / 2) but for round-off");
  sheet.at_most("symplectic Euler: drift of 1/2 v^2 + 1/2 w^2 x^2 - h/2 w^2 x v, relative",
                distance_from(printed.modified, 1), kSteps * 10 * kEpsilon, "", "conserved but for round-off");
  sheet.draw("oscillator.svg", "m = 1 kg, k = 100 N/m, h = 0.01 s",
             Chart{"energy of an oscillator",
                   {"time [s]"},
                   {"energy / first", AxisScale::logarithmic},
                   {{"forward_euler (classical)", forward.time, forward.energy},
                    {"symplectic_euler (as printed)", printed.time, printed.energy},
                    {"backward_euler", backward.time, backward.energy}}});
}

// The printed formula: q_(i+1) = 2 q_i - q_(i-1) - h^2 M^-1 dV/dq(q_i), with a lumped M.
Vector as_printed(const Scene& scene, int steps) {
  const Model& model = scene.simulation.model();
  const Pins pins(model.pins, scene.simulation.state().q);
  const double h = scene.simulation.options().h;
  Vector q = scene.simulation.state().q, previous = plus(q, -h, scene.simulation.state().qdot);
  for (int i = 0; i < steps; ++i) {
    Vector g = gradient_of_potential(model, q);
    pins.set_zero(g);
    Vector next(q.size());
    for (size_t k = 0; k < q.size(); ++k)
      next[k] = 2 * q[k] - previous[k] - h * h * g[k] / model.mass->vertex_mass()[k / 3];
    previous = std::move(q);
    q = std::move(next);
  }
  return q;
}

Vector simulated(Scene scene, int steps) {
  run(scene.simulation, steps);
  return scene.simulation.state().q;
}

}  // namespace

void show_printed_forward_euler(const Stage& stage, Sheet& sheet) {
  constexpr int kSteps = 50;
  const auto scene = [&](const std::string& integrator) {
    return stage.on_real_mesh("05_swing", {"time.step=5e-5", "solver.mass=lumped", "time.integrator=" + integrator});
  };
  sheet.keep(scene("symplectic_euler"));
  const Vector printed = as_printed(scene("symplectic_euler"), kSteps);
  const Vector symplectic = simulated(scene("symplectic_euler"), kSteps);
  const Vector classical = simulated(scene("forward_euler"), kSteps);
  const double bound = 2.0 * kSteps * kSteps * kEpsilon * max_abs(printed);
  sheet.at_most(fmt::format("|printed formula - symplectic_euler| after {} steps", kSteps),
                max_abs(plus(printed, -1, symplectic)), bound, "m",
                "n^2 roundings of q: a second difference sums them twice");
  sheet.at_least("|printed formula - classical forward_euler|", max_abs(plus(printed, -1, classical)), 1e4 * bound, "m",
                 "another scheme, not another rounding");
  check_oscillator(sheet);
}

void show_backward_euler(const Stage& stage, Sheet& sheet) {
  constexpr int kSteps = 40;
  Scene stable = stage.on_real_mesh("05_swing", {"gravity=[0,0,0]"});
  Scene unstable = stage.on_real_mesh("05_swing", {"gravity=[0,0,0]", "time.integrator=symplectic_euler"});
  sheet.keep(stable);
  Simulation& simulation = stable.simulation;
  const Model& model = simulation.model();
  const double first = potential(model, simulation.state().q);
  CsvFile table = sheet.table("energy.csv", {"step", "time_s", "backward_euler_J"});
  Vector time = {0}, energy = {1};
  double worst = -INFINITY;
  State before = simulation.state();
  double before_energy = first;
  const Run implicit = run(simulation, kSteps, [&](const StepReport& report) {
    const Vector dv = plus(simulation.state().qdot, -1, before.qdot);
    const double excess =
        report.potential_total + dot(dv, mass_times(model, dv)) / 2 - before_energy;  // E minus E(q_i), over h^2
    worst = std::max(worst, excess / first);
    before = simulation.state();
    before_energy = report.kinetic + report.potential_total;
    time.push_back(report.time);
    energy.push_back(before_energy / first);
    table.append(CsvRow().add(report.step).add(report.time).add(before_energy));
  });
  const Run explicit_run = run(unstable.simulation, kSteps);
  sheet.equals("backward Euler: steps that converged", kSteps - implicit.unconverged, kSteps, "", "all of them");
  sheet.at_most("backward Euler: largest energy / first", implicit.largest_energy / first, 1 + 1e-9, "",
                "V_(i+1) + T_(i+1) <= V_i + T_i while V is convex along the step");
  sheet.at_most("largest of (V_(i+1) + 1/2 |v_(i+1) - v_i|_M^2 - V_i - T_i) / first energy", worst, 1e-12, "",
                "E does not rise above E(q_i), the start of the minimization");
  sheet.at_least("explicit, same h: largest energy / first", explicit_run.largest_energy / first, 1e3, "",
                 "h is far above its stable step");
  sheet.at_least("backward Euler: linear systems per step", static_cast<double>(implicit.iterations) / kSteps, 1, "",
                 "harder to solve: an explicit step solves with the constant M only");
  sheet.draw("energy.svg", "Kinetic and potential energy of the swing with backward Euler",
             Chart{"more stable", {"time [s]"}, {"energy / first"}, {{"backward_euler", time, energy}}});
}

}  // namespace aspic::cli::lecture
