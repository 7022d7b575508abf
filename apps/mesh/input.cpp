#include "input.h"
#include "base/formatted.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>

#include "base/error.h"
#include "io/mesh_file.h"
#include "mesh/doctor.h"
#include "mesh/findings.h"
#include "mesher.h"
#include "unit_frame.h"

namespace aspic {
namespace {

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

std::string first_indices(const std::vector<int>& indices) {
  constexpr size_t kShown = 8;
  std::string text;
  for (size_t i = 0; i < std::min(kShown, indices.size()); ++i)
    text += (text.empty() ? "" : ", ") + std::to_string(indices[i]);
  return indices.size() > kShown ? text + ", ..." : text;
}

// Remedy for holes that --fill-holes did not close.
constexpr const char* kLargeHoles = "these holes are too large to fill; wrap the surface with --rebuild instead";

void check(const std::filesystem::path& path, const TriMesh& mesh, Defects defects) {
  std::vector<std::string> errors;
  for (const Finding& finding : diagnose(mesh)) {
    if (finding.severity != Severity::error) continue;
    std::string& error = errors.emplace_back(path.string() + ": " + finding.message);
    if (!finding.indices.empty()) error += " [" + first_indices(finding.indices) + "]";
    const bool stays_open = defects == Defects::fill_small_holes && finding.name == "open_surface";
    error += "; " + (stays_open ? kLargeHoles : finding.remedy);
  }
  if (!errors.empty()) throw InvalidInput(errors);
}

void check_coordinates(const std::filesystem::path& path, const TriMesh& mesh) {
  if (mesh.triangles.empty()) return check(path, mesh, Defects::refuse);
  for (const Vec3d& x : mesh.vertices)
    if (!std::isfinite(x[0]) || !std::isfinite(x[1]) || !std::isfinite(x[2])) return check(path, mesh, Defects::refuse);
}

}  // namespace

// The examination uses the unit frame, because products of lengths may overflow or underflow in the units of the file.
CheckedSurface checked_surface(const std::filesystem::path& path, Defects defects) {
  CheckedSurface surface{read_tri_mesh(path), {}};
  surface.actions = repair(surface.mesh);
  check_coordinates(path, surface.mesh);
  const UnitFrame frame = unit_frame(path.string(), surface.mesh.vertices);
  to_frame(frame, surface.mesh.vertices);
  if (defects == Defects::rebuild) {
    Rebuilt closed = rebuilt(path.string(), surface.mesh);
    surface.mesh = std::move(closed.surface);
    surface.actions.push_back("rebuilt with " + std::to_string(surface.mesh.triangle_count()) +
                              " triangles; holes and grooves narrower than about " +
                              three_digits(closed.detail * frame.unit) + " are closed");
  } else if (defects == Defects::fill_small_holes) {
    const int before = surface.mesh.triangle_count();
    surface.mesh = with_holes_filled(surface.mesh, diagonal(surface.mesh.vertices));
    if (const int added = surface.mesh.triangle_count() - before; added > 0)
      surface.actions.push_back("filled holes with " + std::to_string(added) + " triangles");
  }
  check(path, surface.mesh, defects);
  from_frame(frame, surface.mesh.vertices);
  return surface;
}

bool is_image(const std::filesystem::path& path) {
  const std::string name = lower(path.filename().string());
  return name.ends_with(".inr") || name.ends_with(".inr.gz");
}

void check_output(const std::filesystem::path& path) {
  std::vector<std::string> known;
  for (const MeshFormat& format : mesh_formats()) {
    if (!format.writes_tets) continue;
    if (format.extension == lower(path.extension().string())) return;
    known.push_back(format.extension);
  }
  throw InvalidInput("--output " + path.string() + ": no format with this extension stores tets" +
                     suggestion(path.extension().string(), known));
}

std::pair<int, double> parsed_region_size(const std::string& text) {
  int label = 0;
  double size = 0;
  const char* const end = text.data() + text.size();
  const auto [equals, label_error] = std::from_chars(text.data(), end, label);
  if (label_error == std::errc() && equals != end && *equals == '=') {
    const auto [last, size_error] = std::from_chars(equals + 1, end, size);
    if (size_error == std::errc() && last == end && std::isfinite(size) && size > 0) return {label, size};
  }
  throw InvalidInput("--region-size " + text +
                     ": write LABEL=SIZE with an integer and a positive length, such as 2=0.5");
}

}  // namespace aspic
