#include "scene/mesh_defaults.h"

#include <algorithm>
#include <cmath>
#include <variant>

#include "base/error.h"
#include "base/formatted.h"
#include "io/mesh_file.h"
#include "mesh/box.h"
#include "mesh/doctor.h"
#include "scene/value.h"

namespace aspic {
namespace {

constexpr double kSmallest = 0.3, kLargest = 3;  // [m] extents that are not scaled
constexpr double kLevel = 0.2;                   // height / largest extent of a sheet that falls

std::string vector_text(const Vec3d& x) {
  return "[" + number_text(x[0]) + ", " + number_text(x[1]) + ", " + number_text(x[2]) + "]";
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

Defaults defaults_for_sheet(const std::filesystem::path& path, const TriMesh& sheet, const SheetPlacement& placement) {
  const double extent = longest_side(bounding_box(sheet.vertices)), scale = placement.scale;
  const double g = norm(placement.gravity);
  const Vec3d up = g > 0 ? (-1 / g) * placement.gravity : Vec3d{{0, 1, 0}};
  std::vector<Vec3d> X = sheet.vertices;
  for (Vec3d& x : X) x = scale * x;
  const Box box = bounding_box(X);
  const double size = longest_side(box);
  const std::string thickness = formatted("%.1g", 1e-3 * size);
  Defaults d;
  d.toml = "gravity = [0.0, -9.81, 0.0]\n[time]\nstep = 0.01\nduration = 2.0\n[solver]\ntolerance = 1e-4\n[contact]\n" +
           std::string("friction = 0.3\n[[body]]\nmesh = ") + toml_string(path.string()) +
           "\nscale = " + number_text(scale) + "\nshell = { thickness = " + thickness +
           " }\nmaterial = { young = 1e6, poisson = 0.3, density = 300.0 }\n";
  d.choices = choices_of_space(scale, extent);
  d.choices.push_back({"shell", "shell.thickness = " + thickness +
                                    " m: the mesh is a sheet, and becomes cloth of a thousandth of its size"});
  d.choices.push_back({"material", "material: young = 1e6 Pa, poisson = 0.3, density = 300 kg/m^3: light fabric"});
  d.choices.push_back({"contact.friction", "contact.friction = 0.3: cotton"});
  double low = INFINITY, high = -INFINITY;
  for (const Vec3d& x : X) low = std::min(low, dot(up, x)), high = std::max(high, dot(up, x));
  if (high - low < kLevel * size) {
    const double radius = 0.25 * size;
    const Vec3d middle = 0.5 * (box.lower + box.upper);
    const Vec3d center = middle + (low - 1.1 * radius - dot(up, middle)) * up;
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
