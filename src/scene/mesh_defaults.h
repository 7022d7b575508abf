// Defaults of a scene that is made of a mesh file alone, with a note on each.
#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "mesh/tet_mesh.h"

namespace aspic {

struct Choice {
  std::string key, text;  // "material.young"
};

struct Defaults {
  std::string toml;
  std::vector<Choice> choices;
};

// Whether an override replaces this key, a key inside it, or a table around it.
bool is_overridden(const std::string& key, const std::vector<std::string>& overrides);
// Returns the texts of the choices that no override replaces.
std::vector<std::string> notes_of(const Defaults& defaults, const std::vector<std::string>& overrides);

double guessed_scale(const std::vector<Vec3d>& X);
double one_digit(double x);  // rounds to one significant digit
// The choices of scale and gravity. `extent`: the largest one in units of the file.
std::vector<Choice> choices_of_space(double scale, double extent);

// Returns the surface of a file that is a sheet, or of any file of triangles if it `has_shell`.
std::optional<TriMesh> sheet_in(const std::filesystem::path& path, bool has_shell);
// Returns the lines of a file without tets and triangles, or of any file with lines if it `has_rod`.
std::optional<TetMesh> rod_in(const std::filesystem::path& path, bool has_rod);
// How a sheet or a rod is placed: its scale, and the direction of gravity.
struct ThinPlacement {
  double scale;
  Vec3d gravity;
};
// A sheet that is level falls onto a ball; others hang from their highest vertices.
Defaults defaults_for_sheet(const std::filesystem::path& path, const TriMesh& sheet, const ThinPlacement& placement);
// A rod hangs from its highest vertices, or from its first end if it is level.
Defaults defaults_for_rod(const std::filesystem::path& path, const TetMesh& rod, const ThinPlacement& placement);

}  // namespace aspic
