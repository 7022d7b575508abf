#include "verification/shell_models.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "dynamics/pins.h"
#include "energy/mid_edge_bending.h"
#include "energy/sheet_elasticity.h"
#include "mesh/vertices.h"

namespace aspic::verify {
namespace {

// Coordinates of the grid lines, with `low` and `high` cells outside of [0, 1].
class GridLines {
 public:
  GridLines(int cells, int low, int high) : cells_(cells), low_(low), lines_(low + cells + high + 1) {}

  int count() const { return lines_; }
  bool is_border(int line) const { return line <= low_ || line >= low_ + cells_; }
  double at(int line) const { return static_cast<double>(line - low_) / cells_; }
  double spacing() const { return 1.0 / cells_; }

 private:
  int cells_, low_, lines_;
};

class Jitter {
 public:
  explicit Jitter(Cells cells) : is_on_(cells == Cells::irregular) {}
  double displacement(const GridLines& lines, int line) {  // up to a quarter of a cell
    const double value = 0.5 * (static_cast<double>(random_() >> 5) * 0x1p-27 - 0.5);
    return is_on_ && !lines.is_border(line) ? value * lines.spacing() : 0;
  }
  bool flips() { return random_() % 2 == 0 && is_on_; }

 private:
  bool is_on_;
  std::mt19937 random_{1};
};

}  // namespace

double ShellMaterial::moment() const { return young * std::pow(thickness, 3) / (12 * (1 - poisson * poisson)); }

double ShellMesh::area(int triangle) const {
  const auto& [a, b, c] = triangles[triangle];
  return 0.5 * norm(cross(rest[b] - rest[a], rest[c] - rest[a]));
}

std::vector<int> ShellMesh::vertices_where(const std::function<bool(const Vec3d&)>& is_chosen) const {
  std::vector<int> chosen;
  for (size_t v = 0; v < rest.size(); ++v)
    if (is_chosen(rest[v])) chosen.push_back(static_cast<int>(v));
  return chosen;
}

int ShellMesh::nearest(const Vec3d& X) const {
  const auto closer = [&](const Vec3d& a, const Vec3d& b) { return norm(a - X) < norm(b - X); };
  return static_cast<int>(std::min_element(rest.begin(), rest.end(), closer) - rest.begin());
}

ShellMesh make_shell_grid(const ShellGrid& grid, const std::function<Vec3d(double u, double v)>& place) {
  const GridLines columns(grid.nx, grid.rims[0], grid.rims[1]), rows(grid.ny, grid.rims[2], grid.rims[3]);
  Jitter jitter(grid.cells);
  ShellMesh mesh;
  for (int j = 0; j < rows.count(); ++j)
    for (int i = 0; i < columns.count(); ++i) {
      const double u = columns.at(i) + jitter.displacement(columns, i);
      mesh.rest.push_back(place(u, rows.at(j) + jitter.displacement(rows, j)));
    }
  for (int j = 0; j + 1 < rows.count(); ++j)
    for (int i = 0; i + 1 < columns.count(); ++i) {
      const int a = j * columns.count() + i, b = a + 1, d = a + columns.count(), c = d + 1;
      const bool flips = jitter.flips();
      mesh.triangles.push_back(flips ? Triangle{a, b, d} : Triangle{a, b, c});
      mesh.triangles.push_back(flips ? Triangle{b, c, d} : Triangle{a, c, d});
    }
  return mesh;
}

Model shell_model(const ShellMesh& mesh, const ShellMaterial& material, std::vector<Pin> pins) {
  Model model;
  model.mesh.rest = mesh.rest;
  model.mesh.sheet = mesh.triangles;
  const size_t count = mesh.triangles.size();
  model.mesh.thickness.assign(count, material.thickness);
  model.density.assign(count, material.density);
  model.bodies = {{"shell", 0, model.mesh.vertex_count(), 0, 0, 0, static_cast<int>(count)}};
  model.pins = std::move(pins);
  SheetMaterial sheet;
  sheet.laws.assign(count, IsotropicSheet{material.young, material.poisson, material.thickness});
  sheet.plates.assign(count, plate_stiffness(sheet.laws[0]));
  sheet.first_angle_row = model.rows();
  const Pins held(model.pins, rest_positions(model.mesh));
  for (int v = 0; v < held.rows(); ++v) sheet.held.push_back(held.holds(v));
  const std::vector<double> mass(count, material.density * std::pow(material.thickness, 3) / 12);
  model.angle_rows = make_angle_rows(mesh.rest, mesh.triangles, mass);
  model.elasticity.push_back(make_sheet_elasticity(model.mesh, 0, sheet));
  model.mass = std::make_unique<MassMatrix>(model.mesh, model.density, MassKind::lumped, angle_masses(model));
  return model;
}

std::vector<double> area_load(const ShellMesh& mesh, const Vec3d& load, const std::vector<int>& held) {
  std::vector<char> is_held(mesh.rest.size(), 0);
  for (const int v : held) is_held[v] = 1;
  std::vector<double> force(3 * mesh.rest.size(), 0.0);
  for (size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& [a, b, c] = mesh.triangles[t];
    if (is_held[a] && is_held[b] && is_held[c]) continue;
    for (const int v : mesh.triangles[t])
      for (int r = 0; r < 3; ++r) force[3 * static_cast<size_t>(v) + r] += mesh.area(static_cast<int>(t)) / 3 * load[r];
  }
  return force;
}

}  // namespace aspic::verify
