// Page 1: a cape in the wind.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "aspic/lecture/course.h"
#include "aspic/lecture/run_scene.h"
#include "math/eigen3.h"
#include "mesh/elements.h"
#include "mesh/self_intersection.h"

namespace aspic::cli::lecture {
namespace {

// Angle of the line from the shoulders to the hem with the vertical [degrees].
double lift(const Model& model, const Vector& q) {
  double high = -1e300, low = 1e300;
  for (const Vec3d& X : model.mesh.rest) high = std::max(high, X[1]), low = std::min(low, X[1]);
  Vec3d shoulders{}, hem{};
  double above = 0, below = 0;
  for (int v = 0; v < model.mesh.vertex_count(); ++v) {
    if (model.mesh.rest[v][1] == high) shoulders = shoulders + point(q, v), ++above;
    if (model.mesh.rest[v][1] == low) hem = hem + point(q, v), ++below;
  }
  const Vec3d down = (1 / below) * hem - (1 / above) * shoulders;
  return std::atan2(std::hypot(down[0], down[2]), -down[1]) * 180 / std::numbers::pi;
}

double largest_stretch(const Model& model, const Vector& q) {
  double most = 0;
  for (int e = 0; e < model.mesh.element_count(); ++e) {
    const Mat3d F = deformation_gradient(model.mesh, e, q);
    most = std::max(most, std::sqrt(symmetric_eigen(transpose(F) * F).values[2]));
  }
  return most;
}

}  // namespace

void show_cape(const Stage& stage, Sheet& sheet) {
  Scene scene = stage.scene("01_cape");
  sheet.keep(scene);
  const Model& model = scene.simulation.model();
  double wind = 0, drag = 0, stretch = 0, lowest = 90, highest = 0;
  int intersections = 0;
  std::vector<ShadedSurface> panels;
  CsvFile table = sheet.table("cape.csv", {"time_s", "lift_deg", "wind_work_J", "damping_loss_J", "contacts"});
  const int every = std::max(1, scene.steps / 4);
  const Run result = run(scene.simulation, scene.steps, [&](const StepReport& report) {
    const Vector& q = scene.simulation.state().q;
    const ShadedSurface now = all_surfaces(scene.simulation);
    const double angle = lift(model, q);
    wind += report.nonconservative_work, drag += report.damping_loss;
    stretch = std::max(stretch, largest_stretch(model, q));
    intersections += !self_intersections(now.surface, 1).pairs.empty();
    if (report.time > scene.steps * scene.simulation.options().h / 2)
      lowest = std::min(lowest, angle), highest = std::max(highest, angle);
    if (report.step % every == 0) panels.push_back(now);
    table.append(CsvRow()
                     .add(report.time)
                     .add(angle)
                     .add(report.nonconservative_work)
                     .add(report.damping_loss)
                     .add(report.contacts));
  });
  sheet.equals("steps that converged", scene.steps - result.unconverged, scene.steps, "", "all of them");
  sheet.show("Newton iterations per step", static_cast<double>(result.iterations) / scene.steps, "");
  sheet.equals("steps whose surfaces intersect", intersections, 0, "",
               "an exact test of all triangles, which shares no code with contact");
  sheet.at_least("work of the wind", wind, 1e-3, "J", "gusts lift the cape");
  sheet.at_least("energy that drag and friction take", drag, 1e-3, "J", "the air damps it");
  sheet.at_most("largest energy imbalance of a step", result.largest_ledger_error, 1e-9, "",
                "the balance is an identity, wind included");
  sheet.at_least("change of the lift in gusts", highest - lowest, 10, "degrees",
                 "it flutters instead of standing still");
  sheet.at_most("largest stretch", stretch, 1.15, "", "fabric bends, but hardly stretches");
  sheet.draw("cape.png", "The cape behind a walking figure, colored by speed",
             MeshPicture{.panels = std::move(panels),
                         .eye = {{1, 0.3, 0.4}},
                         .up = {{0, 1, 0}},
                         .wires = Wires::none,
                         .value_label = "speed [m/s]"});
}

}  // namespace aspic::cli::lecture
