#include "scene/mesh_defaults.h"

#include <algorithm>
#include <cmath>
#include <variant>

#include "base/error.h"
#include "base/formatted.h"
#include "io/mesh_file.h"
#include "mesh/box.h"
#include "mesh/doctor.h"
#include "mesh/rod_shapes.h"
#include "scene/value.h"

namespace aspic {
namespace {

constexpr double kSmallest = 0.3, kLargest = 3;  // [m] extents that are not scaled
constexpr double kLevel = 0.2;                   // height / largest extent of a sheet that falls

std::string vector_text(const Vec3d& x) {
  return "[" + number_text(x[0]) + ", " + number_text(x[1]) + ", " + number_text(x[2]) + "]";
}

// The points of a thin body, and its extent along gravity.
struct ScaledPoints {
  Box box;
  double size;
  Vec3d up;
  double low = INFINITY, high = -INFINITY;

  ScaledPoints(std::vector<Vec3d> X, const ThinPlacement& placement) {
    const double g = norm(placement.gravity);
    up = g > 0 ? (-1 / g) * placement.gravity : Vec3d{{0, 1, 0}};
    for (Vec3d& x : X) x = placement.scale * x;
    box = bounding_box(X);
    size = longest_side(box);
    for (const Vec3d& x : X) low = std::min(low, dot(up, x)), high = std::max(high, dot(up, x));
  }
  bool is_level() const { return high - low < kLevel * size; }
};

// Returns the scene up to the scale of its body.
std::string head_of_thin(const std::filesystem::path& path, double scale, double tolerance) {
  return "gravity = [0.0, -9.81, 0.0]\n[time]\nstep = 0.01\nduration = 2.0\n[solver]\ntolerance = " +
         number_text(tolerance) + "\n[contact]\nfriction = 0.3\n[[body]]\nmesh = " + toml_string(path.string()) +
         "\nscale = " + number_text(scale) + "\n";
}

}  // namespace

bool is_overridden(const std::string& key, const std::vector<std::string>& overrides) {
  for (const std::string& o : overrides) {
    const std::string path = o.substr(0, o.find('='));
    if (path == key || path.ends_with("." + key) || key.starts_with(path + ".") ||
        path.find("." + key + ".") != std::string::npos || path.starts_with(key + "."))
      return true;
  }
  return false;
}

std::vector<std::string> notes_of(const Defaults& defaults, const std::vector<std::string>& overrides) {
  std::vector<std::string> notes;
  for (const Choice& c : defaults.choices)
    if (!is_overridden(c.key, overrides)) notes.push_back(c.text);
  return notes;
}

double guessed_scale(const std::vector<Vec3d>& X) {
  const double extent = longest_side(bounding_box(X));
  return extent >= kSmallest && extent <= kLargest ? 1 : 1 / extent;
}

double one_digit(double x) {
  const double unit = std::pow(10.0, std::floor(std::log10(x)));
  return std::round(x / unit) * unit;
}

std::vector<Choice> choices_of_space(double scale, double extent) {
  const std::string size = number_text(extent);
  const std::string text =
      scale == 1 ? "scale = 1: a mesh has no unit; its largest extent, " + size + ", is read as meters"
                 : "scale = " + number_text(scale) + ": a mesh has no unit; its largest extent, " + size +
                       ", becomes 1 m, so that the motion is visible (scale=1 keeps meters, scale=0.001 is for "
                       "millimeters)";
  return {{"scale", text}, {"gravity", "gravity = 9.81 m/s^2 along -y: y is up (gravity=[0,0,-9.81] for z)"}};
}

std::optional<TriMesh> sheet_in(const std::filesystem::path& path, bool has_shell) {
  const std::variant<TetMesh, TriMesh> mesh = read_mesh(path.string());
  const TriMesh* surface = std::get_if<TriMesh>(&mesh);
  if (!surface || surface->triangles.empty()) return std::nullopt;
  const double extent = longest_side(bounding_box(surface->vertices));
  if (!(extent > 0) || !std::isfinite(extent) || !(has_shell || is_sheet(*surface))) return std::nullopt;
  return *surface;
}

std::optional<TetMesh> rod_in(const std::filesystem::path& path, bool has_rod) {
  if (!has_rod && !has_lines_only(path.string())) return std::nullopt;
  return read_line_mesh(path.string());
}

Defaults defaults_for_rod(const std::filesystem::path& path, const TetMesh& rod, const ThinPlacement& placement) {
  const ScaledPoints scaled(rod.rest, placement);
  if (!(scaled.size > 0) || !std::isfinite(scaled.size))
    throw InvalidInput(path.string() + ": all vertices coincide; use another polyline");
  const std::string radius = formatted("%.1g", 5e-3 * scaled.size);
  Defaults d;
  d.toml = head_of_thin(path, placement.scale, 1e-6) + "rod = { radius = " + radius +
           " }\nmaterial = { young = 1e6, poisson = 0.3, density = 1000.0 }\n[[body.pin]]\n";
  d.choices = choices_of_space(placement.scale, scaled.size / placement.scale);
  d.choices.push_back({"rod", "rod.radius = " + radius +
                                  " m: the mesh has lines alone, and becomes a cable of a hundredth of its size"});
  d.choices.push_back({"material", "material: young = 1e6 Pa, poisson = 0.3, density = 1000 kg/m^3: soft rubber"});
  d.choices.push_back({"contact.friction", "contact.friction = 0.3"});
  if (scaled.is_level()) {
    const int end = chained(rod.vertex_count(), rod.rods).front()[0];
    d.toml += "name = \"end\"\nwhere = { vertices = [" + std::to_string(end) + "] }\n";
    d.choices.push_back({"pin", "pin: the rod is level, and swings from its end, vertex " + std::to_string(end)});
  } else {
    d.toml += "name = \"top\"\nwhere = { highest = 0.02 }\n";
    d.choices.push_back({"pin", "pin: the highest 2 % of the height are fixed, so that the rod hangs"});
  }
  d.choices.push_back({"time", "time.step = 0.01 s, time.duration = 2 s"});
  return d;
}

Defaults defaults_for_sheet(const std::filesystem::path& path, const TriMesh& sheet, const ThinPlacement& placement) {
  const ScaledPoints scaled(sheet.vertices, placement);
  const double size = scaled.size, scale = placement.scale;
  const std::string thickness = formatted("%.1g", 1e-3 * size);
  Defaults d;
  d.toml = head_of_thin(path, scale, 1e-4) + "shell = { thickness = " + thickness +
           " }\nmaterial = { young = 1e6, poisson = 0.3, density = 300.0 }\n";
  d.choices = choices_of_space(scale, size / scale);
  d.choices.push_back({"shell", "shell.thickness = " + thickness +
                                    " m: the mesh is a sheet, and becomes cloth of a thousandth of its size"});
  d.choices.push_back({"material", "material: young = 1e6 Pa, poisson = 0.3, density = 300 kg/m^3: light fabric"});
  d.choices.push_back({"contact.friction", "contact.friction = 0.3: cotton"});
  if (scaled.is_level()) {
    const double radius = 0.25 * size;
    const Vec3d middle = 0.5 * (scaled.box.lower + scaled.box.upper);
    const Vec3d center = middle + (scaled.low - 1.1 * radius - dot(scaled.up, middle)) * scaled.up;
    d.toml += "[[obstacle]]\nname = \"ball\"\nsphere = { center = " + vector_text(center) +
              ", radius = " + number_text(radius) + " }\n";
    d.choices.push_back({"obstacle", "obstacle: a ball under the sheet, which is level and falls onto it"});
  } else {
    d.toml += "[[body.pin]]\nname = \"top\"\nwhere = { highest = 0.02 }\n";
    d.choices.push_back({"pin", "pin: the highest 2 % of the height are fixed, so that the sheet hangs"});
  }
  d.choices.push_back({"time", "time.step = 0.01 s, time.duration = 2 s"});
  return d;
}

}  // namespace aspic
