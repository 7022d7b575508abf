// Page 3: a layered slab of soft tissue is poked.
#include <algorithm>
#include <array>
#include <cmath>

#include "aspic/lecture/course.h"
#include "aspic/lecture/run_scene.h"
#include "base/error.h"
#include "mesh/surface.h"

namespace aspic::cli::lecture {
namespace {

struct Indentation {
  Vector depth, force, energy;  // [m], [N], [J]; first entry: slab at rest
  Run run;
};

const Pin& indenter_of(const Model& model) {
  for (const Pin& pin : model.pins)
    if (pin.name.ends_with("indenter")) return pin;
  throw InvalidInput("03_tissue.toml: the pin 'indenter' is missing");
}

Indentation poke(Simulation& simulation, int steps) {
  const Pin& indenter = indenter_of(simulation.model());
  const int y = 3 * indenter.vertices[0] + 1;
  const double height = simulation.state().q[y];
  Indentation result{{0}, {0}, {0}, {}};
  result.run = run(simulation, steps, [&](const StepReport& report) {
    const Vector& q = simulation.state().q;
    const Vector g = gradient_of_potential(simulation.model(), q);
    double force = 0;  // force of the indenter: the reaction, downward
    for (const int v : indenter.vertices) force -= g[3 * v + 1];
    result.depth.push_back(height - q[y]);
    result.force.push_back(force);
    result.energy.push_back(report.potential_total);
  });
  return result;
}

// Largest deviation of dV/d(depth), by central differences, from the force, and its largest truncation error: a sixth
// of h^2 F'', twice, because F'' is also a difference.
struct VirtualWork {
  double error = 0, allowed = 0;  // [N]
};
VirtualWork virtual_work(const Indentation& poke) {
  VirtualWork worst;
  for (size_t i = 1; i + 1 < poke.depth.size(); ++i) {
    const double slope = (poke.energy[i + 1] - poke.energy[i - 1]) / (poke.depth[i + 1] - poke.depth[i - 1]);
    const double curvature = std::abs(poke.force[i + 1] - 2 * poke.force[i] + poke.force[i - 1]);  // h^2 F''
    worst.error = std::max(worst.error, std::abs(slope - poke.force[i]));
    worst.allowed = std::max(worst.allowed, curvature / 3);
  }
  return worst;
}

// Mean compression under the indenter of muscle, fat and skin.
std::array<double, 3> compression(const Model& model, const Vector& q) {
  std::array<double, 4> below{}, height = {0, 0.0125, 0.0275, 0.03};
  std::array<int, 4> count{};
  for (int v = 0; v < model.mesh.vertex_count(); ++v) {
    const Vec3d& X = model.mesh.rest[v];
    for (int k = 0; k < 4; ++k) {
      if (std::abs(X[1] - height[k]) > 1e-6 || std::hypot(X[0] - 0.04, X[2] - 0.04) > 0.0142) continue;
      below[k] += q[3 * v + 1];
      ++count[k];
    }
  }
  std::array<double, 3> strain{};
  for (int k = 0; k < 3; ++k)
    strain[k] = 1 - (below[k + 1] / count[k + 1] - below[k] / count[k]) / (height[k + 1] - height[k]);
  return strain;
}

// Half of the slab, cut through the center of the indenter.
TriMesh half_slab(const Model& model, const Vector& q, std::vector<double>& young) {
  TetMesh half{model.mesh.rest, {}, {}};
  std::vector<double> of_tet;
  for (int t = 0; t < model.mesh.tet_count(); ++t) {
    double z = 0;
    for (const int v : model.mesh.tets[t]) z += model.mesh.rest[v][2] / 4;
    if (z > 0.04) continue;
    half.tets.push_back(model.mesh.tets[t]);
    of_tet.push_back(model.tet_fields[0].second[t]);
  }
  TriMesh surface;
  for (size_t i = 0; i < q.size(); i += 3) surface.vertices.push_back({{q[i], q[i + 1], q[i + 2]}});
  surface.triangles = boundary_triangles(half, 0, half.tet_count());
  std::vector<std::vector<int>> tets_of(model.mesh.rest.size());
  for (int t = 0; t < half.tet_count(); ++t)
    for (const int v : half.tets[t]) tets_of[v].push_back(t);
  for (const Triangle& triangle : surface.triangles)
    for (const int t : tets_of[triangle[0]]) {
      const auto has = [&](int v) { return std::count(half.tets[t].begin(), half.tets[t].end(), v) > 0; };
      if (!has(triangle[1]) || !has(triangle[2])) continue;
      young.push_back(std::log10(of_tet[t]));
      break;
    }
  return surface;
}

}  // namespace

void show_tissue(const Stage& stage, Sheet& sheet) {
  Scene scene = stage.scene("03_tissue");
  sheet.keep(scene);
  const Model& model = scene.simulation.model();
  const Indentation layered = poke(scene.simulation, scene.steps);
  Scene uniform = stage.scene("03_tissue", {"material.young=5e3"});
  const Indentation soft = poke(uniform.simulation, uniform.steps);

  CsvFile table = sheet.table("force.csv", {"depth_m", "force_N", "energy_J", "force_uniform_N"});
  for (size_t i = 0; i < layered.depth.size(); ++i)
    table.append(CsvRow().add(layered.depth[i]).add(layered.force[i]).add(layered.energy[i]).add(soft.force[i]));

  sheet.equals("steps that converged", scene.steps - layered.run.unconverged, scene.steps, "", "all of them");
  sheet.show("force at the largest depth", layered.force.back(), "N");
  const VirtualWork work = virtual_work(layered);
  sheet.at_most("|reaction - dV/d(depth)|", work.error, work.allowed, "N",
                "virtual work; the bound is h^2/3 F'', the error of differences of this width");
  const double first = layered.force[1] / layered.depth[1];
  const size_t n = layered.depth.size() - 1;
  const double last = (layered.force[n] - layered.force[n - 1]) / (layered.depth[n] - layered.depth[n - 1]);
  sheet.show("stiffness at first", first, "N/m");
  sheet.at_least("stiffness at the end / at first", last / first, 1.2, "", "the material stiffens: it is not linear");
  const std::array<double, 3> strain = compression(model, scene.simulation.state().q);
  sheet.show("compression of the fat under the indenter", strain[1], "");
  sheet.show("compression of the muscle there", strain[0], "");
  sheet.at_least("compression of fat / of muscle", strain[1] / strain[0], 2, "",
                 "fat is 10 times softer than muscle, but stiffens under compression");
  sheet.at_least("force of the layered / of a uniform slab of fat", layered.force.back() / soft.force.back(), 1.5, "",
                 "stiffer layers stiffen the slab");
  sheet.remark("The layers' moduli are given here; 'aspic capture' and 'aspic fit' estimate them from pokes.");

  sheet.draw("force.svg", "Force against depth",
             Chart{"a poke",
                   {"depth [mm]"},
                   {"force [N]"},
                   {{"layered", scaled(layered.depth, 1e3), layered.force},
                    {"uniform fat", scaled(soft.depth, 1e3), soft.force}}});
  ShadedSurface panel{"cut through the middle", {}};
  panel.surface = half_slab(model, scene.simulation.state().q, panel.values);
  sheet.draw("slab.png", "The slab at the largest depth",
             MeshPicture{.panels = {panel}, .eye = {{0.3, 0.5, 1}}, .up = {{0, 1, 0}}, .value_label = "log10 E [Pa]"});
}

}  // namespace aspic::cli::lecture
