// Shells of mid-edge bending for the checks of statics.
#pragma once
#include <functional>
#include <vector>

#include "reference/models.h"

namespace aspic::verify {

struct ShellMaterial {
  double young, poisson, thickness, density;  // [Pa], [1], [m], [kg/m^3]

  double moment() const;  // D [N m]
};

struct ShellMesh {
  std::vector<Vec3d> rest;
  std::vector<Triangle> triangles;

  double area(int triangle) const;
  std::vector<int> vertices_where(const std::function<bool(const Vec3d&)>& is_chosen) const;
  int nearest(const Vec3d& X) const;
};

enum class Cells { aligned, irregular };

// A grid of cells of [0, 1]^2, each cut into two triangles. Rims are cells outside of the unit square, at x < 0, x > 1,
// y < 0 and y > 1.
struct ShellGrid {
  int nx, ny;
  std::array<int, 4> rims = {0, 0, 0, 0};
  Cells cells = Cells::irregular;
};

// Returns the grid, mapped by `place`. Vertices of irregular grids are displaced by up to a quarter of a cell, except
// off the borders of the unit square and of the grid; their diagonals are random.
ShellMesh make_shell_grid(const ShellGrid& grid, const std::function<Vec3d(double u, double v)>& place);

// Returns a shell with these pins. Triangles with three pinned vertices clamp it if all directions are pinned.
Model shell_model(const ShellMesh& mesh, const ShellMaterial& material, std::vector<Pin> pins);

// Returns the forces of a load per area on triangles with a vertex that is not in `held` [N].
std::vector<double> area_load(const ShellMesh& mesh, const Vec3d& load, const std::vector<int>& held = {});

}  // namespace aspic::verify
