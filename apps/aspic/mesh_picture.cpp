#include "aspic/mesh_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/check.h"
#include "base/error.h"
#include "io/atomic_file.h"
#include "viewer/browser_pictures.h"
#include "viewer/page.h"
#include "viewer/recording_code.h"

namespace aspic::cli {
namespace {

using viewer::Json;

constexpr int kPixels = 2;      // pixels per unit of PictureSize, for sharp print
constexpr double kLetter = 14;  // text height

bool is_finite(const Vec3d& x) {
  return std::all_of(std::begin(x.a), std::end(x.a), [](double c) { return std::isfinite(static_cast<float>(c)); });
}

bool is_per_triangle(const ShadedSurface& panel) { return panel.values.size() == panel.surface.triangles.size(); }

std::vector<float> to_floats(const std::vector<double>& numbers) { return {numbers.begin(), numbers.end()}; }

// Returns the finite triangles and their vertices.
ShadedSurface drawable(const ShadedSurface& panel) {
  ShadedSurface result{panel.caption, {}, {}};
  std::vector<int> kept(panel.surface.vertices.size(), -1);
  for (size_t t = 0; t < panel.surface.triangles.size(); ++t) {
    Triangle triangle = panel.surface.triangles[t];
    if (!std::all_of(triangle.begin(), triangle.end(), [&](int v) { return is_finite(panel.surface.vertices[v]); }))
      continue;
    for (int& v : triangle) {
      if (kept[v] < 0) {
        kept[v] = result.surface.vertex_count();
        result.surface.vertices.push_back(panel.surface.vertices[v]);
        if (!panel.values.empty() && !is_per_triangle(panel)) result.values.push_back(panel.values[v]);
      }
      v = kept[v];
    }
    result.surface.triangles.push_back(triangle);
    if (is_per_triangle(panel)) result.values.push_back(panel.values[t]);
  }
  return result;
}

void check(const MeshDrawing& drawing) {
  const std::string path = drawing.path.string();
  if (drawing.path.extension() != ".png")
    throw InvalidInput(
        fmt::format("{}: a picture of meshes must be .png, not '{}'", path, drawing.path.extension().string()));
  if (drawing.picture.panels.empty()) throw InvalidInput(path + ": no surface to draw");
  for (const ShadedSurface& panel : drawing.picture.panels) {
    ASPIC_CHECK(panel.values.empty() || is_per_triangle(panel) || panel.values.size() == panel.surface.vertices.size());
    if (drawable(panel).surface.triangles.empty())
      throw InvalidInput(fmt::format("{}: the surface '{}' has no finite triangle", path, panel.caption));
  }
}

// Smallest and largest value; null if there are none.
Json value_range(const MeshPicture& picture) {
  double min = std::numeric_limits<double>::infinity(), max = -min;
  for (const ShadedSurface& panel : picture.panels)
    for (const double value : panel.values)
      if (std::isfinite(value)) min = std::min(min, value), max = std::max(max, value);
  if (min > max) return nullptr;
  return {picture.value_min.value_or(min), picture.value_max.value_or(max)};
}

// Format of web/src/meshPicture.ts.
std::string packed(const MeshPicture& picture) {
  viewer::ArrayPack pack;
  Json panels = Json::array();
  for (const ShadedSurface& given : picture.panels) {
    const ShadedSurface panel = drawable(given);
    const std::string name = fmt::format("{}.", panels.size());
    std::vector<float> positions;
    std::vector<uint32_t> triangles;
    for (const Vec3d& x : panel.surface.vertices) positions.insert(positions.end(), std::begin(x.a), std::end(x.a));
    for (const Triangle& t : panel.surface.triangles) triangles.insert(triangles.end(), t.begin(), t.end());
    pack.add(name + "positions", positions);
    pack.add(name + "triangles", triangles);
    pack.add(name + "values", to_floats(panel.values));
    const char* values = given.values.empty() ? "none" : is_per_triangle(given) ? "triangles" : "vertices";
    panels.push_back({{"caption", panel.caption}, {"values", values}});
  }
  return pack.bytes({{"title", picture.title},
                     {"panels", panels},
                     {"eye", picture.eye.a},
                     {"up", picture.up.a},
                     {"wires", picture.wires == Wires::thin},
                     {"value_label", picture.value_label},
                     {"range", value_range(picture)},
                     {"width", kPixels * picture.size.width},
                     {"height", kPixels * picture.size.height},
                     {"letter", kPixels * kLetter}});
}

}  // namespace

bool draw(const std::vector<MeshDrawing>& drawings, const StopToken& stop) {
  for (const MeshDrawing& drawing : drawings) check(drawing);
  const auto drawing = [&](int index) -> const MeshDrawing& {
    if (index < 0 || index >= static_cast<int>(drawings.size())) throw InvalidInput("there is no such picture");
    return drawings[static_cast<size_t>(index)];
  };
  const auto end = viewer::draw_in_browser(
      {.page = viewer::page(),
       .query = fmt::format("&meshes={}", drawings.size()),
       .part = [&](int index) { return packed(drawing(index).picture); }},
      [&](int index, int, std::string_view png) { write_file(drawing(index).path, png); }, stop);
  return end == viewer::RenderEnd::done;
}

}  // namespace aspic::cli
