// Page 6: bodies that tumble down chutes.
#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "aspic/lecture/course.h"
#include "aspic/lecture/run_scene.h"
#include "mesh/box.h"
#include "mesh/self_intersection.h"
#include "mesh/surface.h"

namespace aspic::cli::lecture {
namespace {

Vec3d center_of(const Model& model, const BodyRange& body) {
  Box box;
  for (int v = body.first_vertex; v < body.first_vertex + body.vertex_count; ++v) box.add(model.mesh.rest[v]);
  return 0.5 * (box.lower + box.upper);
}

// The overrides that place the real mesh where the scene places its own shapes.
std::vector<std::string> centered(const Stage& stage) {
  const Scene own = stage.scene("06_chutes"), one = stage.on_real_mesh("05_swing");
  const Model& placed = own.simulation.model();
  const Vec3d center = center_of(one.simulation.model(), one.simulation.model().bodies[0]);
  std::vector<std::string> overrides;
  for (const BodyRange& body : placed.bodies) {
    const Vec3d t = center_of(placed, body) - center;
    overrides.push_back(fmt::format("body.{}.translate=[{}, {}, {}]", overrides.size(), t[0], t[1], t[2]));
  }
  return overrides;
}

}  // namespace

void show_chutes(const Stage& stage, Sheet& sheet) {
  Scene scene = stage.on_real_mesh("06_chutes", centered(stage));
  sheet.keep(scene);
  const Model& model = scene.simulation.model();
  sheet.show("vertices", model.mesh.vertex_count(), "");

  double gap = std::numeric_limits<double>::infinity(), lowest = gap, friction = 0;
  int contacts = 0, intersections = 0;
  std::vector<ShadedSurface> panels;
  CsvFile table = sheet.table("chutes.csv", {"time_s", "contacts", "min_gap_m", "max_pressure_Pa", "friction_loss_J"});
  const int every = std::max(1, scene.steps / 4);
  const Run result = run(scene.simulation, scene.steps, [&](const StepReport& report) {
    const ShadedSurface now = all_surfaces(scene.simulation);
    intersections += !self_intersections(now.surface, 1).pairs.empty();
    const Vector& q = scene.simulation.state().q;
    for (size_t k = 1; k < q.size(); k += 3) lowest = std::min(lowest, q[k]);
    if (report.contacts > 0) gap = std::min(gap, report.min_gap);
    contacts = std::max(contacts, report.contacts);
    friction += report.friction_loss;
    if (report.step % every == 0) panels.push_back(now);
    table.append(CsvRow()
                     .add(report.time)
                     .add(report.contacts)
                     .add(report.min_gap)
                     .add(report.max_pressure)
                     .add(report.friction_loss));
  });
  sheet.equals("steps that converged", scene.steps - result.unconverged, scene.steps, "", "all of them");
  sheet.show("Newton iterations per step", static_cast<double>(result.iterations) / scene.steps, "");
  sheet.at_least("contacts, most at a time", contacts, 1, "", "the bodies reach the chutes");
  sheet.equals("steps whose surfaces intersect", intersections, 0, "",
               "an exact test of all triangles, which shares no code with contact");
  sheet.at_least("lowest vertex above the floor", lowest, 0, "m", "bodies do not pass through the floor");
  sheet.show("smallest gap", gap, "m");
  sheet.at_least("energy that friction takes", friction, 1e-9, "J", "the bodies slide");
  sheet.at_most("largest energy imbalance of a step", result.largest_ledger_error, 1e-9, "",
                "the balance is an identity, contact and friction included");
  sheet.draw("chutes.png", "Bodies on two chutes, colored by speed",
             MeshPicture{.panels = std::move(panels),
                         .eye = {{0.5, 0.4, 1}},
                         .up = {{0, 1, 0}},
                         .wires = Wires::none,
                         .value_label = "speed [m/s]"});
}

}  // namespace aspic::cli::lecture
