// Page 2: a very fine mesh.
#include <fmt/format.h>

#include "aspic/lecture/course.h"
#include "aspic/lecture/run_scene.h"

namespace aspic::cli::lecture {

void show_fine_mesh(const Stage& stage, Sheet& sheet) {
  constexpr int kTets = 100000, kSteps = 3;
  Scene scene = stage.on_fine_mesh("02_fine_mesh", kTets, sheet);
  sheet.keep(scene);
  CsvFile table = sheet.table("steps.csv", {"step", "time_s", "iterations", "residual_N", "seconds"});
  double seconds = 0;
  const Run result = run(scene.simulation, kSteps, [&](const StepReport& r) {
    table.append(CsvRow().add(r.step).add(r.time).add(r.iterations).add(r.residual).add(r.seconds));
    seconds += r.seconds;
  });
  const Model& model = scene.simulation.model();
  const TriMesh surface = surface_at(model, scene.simulation.state().q);
  sheet.at_least("tets", model.mesh.tet_count(), kTets, "", "the mesh of the slide is very fine");
  sheet.show("vertices", model.mesh.vertex_count(), "");
  sheet.equals("steps that converged", kSteps - result.unconverged, kSteps, "", "all of them");
  sheet.at_most("largest energy imbalance of a step", result.largest_ledger_error, 1e-9, "",
                "the balance is an identity; sums of 1e5 terms have 11 digits");
  sheet.at_least("smallest det F", result.reports.back().min_det_F, 1e-3, "", "no tet is inverted or flat");
  sheet.show("wall time per step", seconds / kSteps, "s");
  sheet.draw("mesh.png",
             fmt::format("{} tets after {} steps; {} triangles are drawn", model.mesh.tet_count(), kSteps,
                         surface.triangle_count()),
             MeshPicture{.panels = {{"", surface}}, .eye = {{0.4, 0.3, 1}}, .up = {{0, 1, 0}}, .size = {900, 800}});
}

}  // namespace aspic::cli::lecture
