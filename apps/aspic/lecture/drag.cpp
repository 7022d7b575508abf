// Pages 25, 33 and 34: a body dragged by a spring to a moving cursor.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "aspic/lecture/course.h"
#include "aspic/lecture/run_scene.h"
#include "base/error.h"

namespace aspic::cli::lecture {
namespace {

const Energy& leash_of(const Model& model) {
  for (const auto& V : model.loads)
    if (V->name() == "point_springs") return *V;
  throw InvalidInput("the scene has no springs to a cursor");
}

// Force of the cursor on the body [N].
Vec3d pull(const ActiveTerm& leash, const Vector& q) {
  Vector g(q.size(), 0.0);
  leash.add_gradient(q, 1, g);
  Vec3d force{};
  for (size_t i = 0; i < g.size(); ++i) force[i % 3] -= g[i];
  return force;
}

// The same as the derivative of the springs' energy with respect to a shift of the body [N].
Vec3d pull_by_differences(const ActiveTerm& leash, const Vector& q) {
  Vec3d force{};
  constexpr double kShift = 1e-3;  // [m]: any width is exact for a quadratic V
  for (int r = 0; r < 3; ++r) {
    Vector ahead = q, behind = q;
    for (size_t i = r; i < q.size(); i += 3) ahead[i] += kShift, behind[i] -= kShift;
    force[r] = -(leash.value(ahead) - leash.value(behind)) / (2 * kShift);
  }
  return force;
}

}  // namespace

void show_drag(const Stage& stage, Sheet& sheet) {
  Scene scene = stage.on_real_mesh("25_drag");
  sheet.keep(scene);
  Simulation& simulation = scene.simulation;
  ActiveTerm leash(leash_of(simulation.model()));
  const Vector rest = simulation.state().q;
  Vector held(rest.size(), 0.0);  // nonzero where a spring is attached
  leash.add_gradient(Vector(rest.size(), 1e3), 1, held);
  int tip = 0;
  while (held[3 * tip] == 0) ++tip;

  CsvFile table = sheet.table("force.csv", {"time_s", "force_x_N", "force_y_N", "force_z_N", "ear_x_m", "iterations"});
  Vector time, force, ear;
  double mismatch = 0;
  std::vector<TriMesh> frames = {surface_at(simulation.model(), rest)};
  const Run result = run(simulation, scene.steps, [&](const StepReport& report) {
    const Vector& q = simulation.state().q;
    leash.begin_step({.start = q, .time = report.time});
    const Vec3d F = pull(leash, q);
    mismatch = std::max(mismatch, norm(F - pull_by_differences(leash, q)));
    time.push_back(report.time);
    force.push_back(norm(F));
    ear.push_back(
        std::hypot(q[3 * tip] - rest[3 * tip], q[3 * tip + 1] - rest[3 * tip + 1], q[3 * tip + 2] - rest[3 * tip + 2]));
    table.append(
        CsvRow().add(report.time).add(F[0]).add(F[1]).add(F[2]).add(q[3 * tip] - rest[3 * tip]).add(report.iterations));
    if (report.step == 35) frames.push_back(surface_at(simulation.model(), q));
  });
  const double strongest = *std::max_element(force.begin(), force.end());
  sheet.equals("steps that converged", scene.steps - result.unconverged, scene.steps, "", "all of them");
  sheet.at_least("largest motion of the dragged part", *std::max_element(ear.begin(), ear.end()), 0.05, "m",
                 "it follows the cursor, which moves by 0.25 m");
  sheet.at_least("largest force of the cursor", strongest, 1, "N", "the body resists");
  sheet.at_most("|force - derivative of the springs' energy|", mismatch, 1e-9 * strongest, "N",
                "V is quadratic, so its central differences are exact but for round-off");
  sheet.at_most("largest energy imbalance of a step", result.largest_ledger_error, 1e-9, "",
                "work of the cursor = kinetic + potential + losses, an identity");
  sheet.draw("force.svg", "Force of the cursor",
             Chart{"force of the spring", {"time [s]"}, {"force [N]"}, {{"", time, force}}});
  sheet.draw(
      "drag.png", "At rest, and dragged (0.35 s)",
      MeshPicture{
          .panels = {{"at rest", frames[0]}, {"dragged", frames.back()}}, .eye = {{0.4, 0.3, 1}}, .up = {{0, 1, 0}}});
}

namespace {

struct Drag {
  std::string integrator;
  Vector time, energy;
  Run run;
  Vector shape;  // last q that is not far outside
};

Drag drag(Scene scene) {
  Drag result{scene.simulation.options().integrator, {}, {}, {}, scene.simulation.state().q};
  result.run = run(scene.simulation, scene.steps, [&](const StepReport& report) {
    result.time.push_back(report.time);
    result.energy.push_back(report.kinetic + report.potential_total);
    const Vector& q = scene.simulation.state().q;
    if (max_abs(q) < 3) result.shape = q;
  });
  return result;
}

}  // namespace

void show_explosion(const Stage& stage, Sheet& sheet) {
  std::vector<Drag> drags;
  for (const char* integrator : {"symplectic_euler", "linearly_implicit_euler", "backward_euler"}) {
    Scene scene = stage.on_real_mesh("33_mouse", {std::string("time.integrator=") + integrator});
    if (integrator == std::string("backward_euler")) sheet.keep(scene);
    drags.push_back(drag(std::move(scene)));
  }
  const Scene scene = stage.on_real_mesh("33_mouse");
  CsvFile table = sheet.table("energy.csv", {"integrator", "time_s", "energy_J"});
  for (const Drag& d : drags)
    for (size_t i = 0; i < d.time.size(); ++i) table.append(CsvRow().add(d.integrator).add(d.time[i]).add(d.energy[i]));

  const Drag& implicit = drags[2];
  sheet.equals("backward_euler: steps that converged", scene.steps - implicit.run.unconverged, scene.steps, "",
               "all of them");
  double made = 0;
  for (const StepReport& report : implicit.run.reports) made = std::max(made, -report.numerical_loss);
  sheet.show("backward_euler: largest energy", implicit.run.largest_energy, "J");
  sheet.at_most("backward_euler: largest energy gain of a step", made, 1e-9 * implicit.run.largest_energy, "J",
                "it dissipates: kinetic + potential <= work of the cursor");
  sheet.at_most("backward_euler: energy at the end / largest", implicit.energy.back() / implicit.run.largest_energy,
                0.2, "", "the motion decays after the cursor has stopped");
  const std::string why = "explodes: far above the maximum of the implicit scheme; inf after overflow";
  for (int i = 0; i < 2; ++i)
    sheet.at_least(drags[i].integrator + ": largest energy / that of backward_euler",
                   drags[i].run.largest_energy / implicit.run.largest_energy, 1e3, "", why);
  for (int i = 0; i < 2; ++i)
    sheet.show(drags[i].integrator + ": steps before overflow", static_cast<double>(drags[i].time.size()), "",
               fmt::format("of {}", scene.steps));
  Chart chart{"the same motion of the mouse", {"time [s]"}, {"energy [J]", AxisScale::logarithmic}, {}};
  MeshPicture picture{.panels = {}, .eye = {{0.3, 0.3, 1}}, .up = {{0, 1, 0}}, .size = {1000, 480}};
  chart.y.max = 1e12;
  for (const Drag& d : drags) {
    chart.series.push_back({d.integrator, d.time, d.energy});
    picture.panels.push_back({d.integrator, surface_at(scene.simulation.model(), d.shape)});
  }
  sheet.draw("energy.svg", "Kinetic and potential energy; a curve ends at overflow", chart);
  sheet.draw("side_by_side.png", "Each scheme when it was last within 3 m of the origin; orange is turned inside out",
             picture);
}

}  // namespace aspic::cli::lecture
