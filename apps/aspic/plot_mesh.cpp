// Shaded surfaces: projected, lit and sorted from back to front here; gnuplot fills the polygons.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "aspic/gnuplot.h"
#include "aspic/viridis.h"
#include "base/check.h"
#include "base/error.h"
#include "mesh/topology.h"

namespace aspic::cli {
namespace {

constexpr Color kPlain = {0.62, 0.75, 0.87}, kUndefined = {0.72, 0.72, 0.72};

Vec3d unit(const Vec3d& v) { return (1 / std::sqrt(dot(v, v))) * v; }

// An orthographic camera: right and up span the picture, `eye` points out of it.
struct Camera {
  Vec3d right, up, eye;
  Camera(const Vec3d& toward_eye, const Vec3d& up_hint) : eye(unit(toward_eye)) {
    const Vec3d side = cross(up_hint, eye);
    right = dot(side, side) > 1e-12 ? unit(side) : unit(cross(Vec3d{{0.3, 1, 0.1}}, eye));
    up = cross(eye, right);
  }
};

// A strong light from above the left shoulder, a weak one from the right, and a floor that no side falls below.
double brightness(const Vec3d& normal, const Camera& camera) {
  static const Vec3d key = unit({{-0.45, 0.65, 0.75}}), fill = unit({{0.8, 0.1, 0.5}});
  const Vec3d n = {{dot(normal, camera.right), dot(normal, camera.up), dot(normal, camera.eye)}};
  return 0.44 + 0.66 * std::max(0.0, dot(n, key)) + 0.16 * std::max(0.0, dot(n, fill));
}

struct Box {
  double left = std::numeric_limits<double>::infinity(), right = -left, bottom = left, top = -left;
  void add(double u, double v) {
    left = std::min(left, u), right = std::max(right, u), bottom = std::min(bottom, v), top = std::max(top, v);
  }
  double width() const { return right - left; }
  double height() const { return top - bottom; }
};

Box bounds(const TriMesh& mesh, const Camera& camera) {
  Box box;
  for (const Vec3d& x : mesh.vertices) {
    const double u = dot(x, camera.right), v = dot(x, camera.up);
    if (std::isfinite(u) && std::isfinite(v)) box.add(u, v);
  }
  return box;
}

struct ValueRange {
  double min = std::numeric_limits<double>::infinity(), max = -min;
  bool is_empty() const { return !(min <= max); }
  Color color(double value) const {
    if (!std::isfinite(value)) return kUndefined;
    return viridis(max > min ? (value - min) / (max - min) : 0.5);
  }
};

ValueRange value_range(const MeshPicture& picture) {
  ValueRange range;
  for (const ShadedSurface& panel : picture.panels)
    for (const double value : panel.values)
      if (std::isfinite(value)) range.min = std::min(range.min, value), range.max = std::max(range.max, value);
  if (range.is_empty()) return range;
  if (picture.value_min) range.min = *picture.value_min;
  if (picture.value_max) range.max = *picture.value_max;
  return range;
}

double triangle_value(const ShadedSurface& panel, size_t t) {
  if (panel.values.size() == panel.surface.triangles.size()) return panel.values[t];
  double sum = 0;
  for (const int v : panel.surface.triangles[t]) sum += panel.values[static_cast<size_t>(v)];
  return sum / 3;
}

std::string rgb(const Color& c, double light, double transparency = 0) {
  unsigned packed = static_cast<unsigned>(std::lround(255 * transparency));
  for (const double channel : c)
    packed = packed << 8 | static_cast<unsigned>(std::lround(255 * std::clamp(channel * light, 0.0, 1.0)));
  return fmt::format("{}", packed);
}

// Places a panel on the picture, in pixels.
struct Placement {
  double scale = 1, left = 0, bottom = 0;  // of the box
  Box box;
};

class Panel {
 public:
  Panel(const ShadedSurface& panel, const Camera& camera, const Placement& placement)
      : panel_(panel), camera_(camera), placement_(placement) {
    for (const Vec3d& x : panel.surface.vertices)
      pixel_.push_back({placement.left + placement.scale * (dot(x, camera.right) - placement.box.left),
                        placement.bottom + placement.scale * (dot(x, camera.up) - placement.box.bottom)});
  }

  // One polygon per line block, farthest first.
  std::string polygons(const ValueRange& values, Wires wires) const {
    std::string text;
    const double wire = wires == Wires::none ? 0 : wire_strength();
    for (const size_t t : back_to_front()) {
      const Triangle& corners = panel_.surface.triangles[t];
      Vec3d n = normal(corners);
      if (dot(n, camera_.eye) < 0) n = -1.0 * n;  // sheets are lit on both sides
      const Color base = panel_.values.empty() ? kPlain : values.color(triangle_value(panel_, t));
      // Where colour means something, light only hints at the shape.
      const double contrast = panel_.values.empty() ? 1 : 0.45;
      const double light = 1 - contrast + contrast * brightness(n, camera_);
      add_fill(text, corners, rgb(base, light));
      for (size_t k = 0; wire > 0 && k < 3; ++k) add_wire(text, corners[k], corners[(k + 1) % 3], wire);
    }
    return text;
  }

 private:
  Vec3d normal(const Triangle& t) const {
    const auto& x = panel_.surface.vertices;
    const Vec3d n = cross(x[t[1]] - x[t[0]], x[t[2]] - x[t[0]]);
    const double length = std::sqrt(dot(n, n));
    return length > 0 ? (1 / length) * n : camera_.eye;
  }

  bool is_drawable(const Triangle& t) const {
    return std::all_of(t.begin(), t.end(),
                       [&](int v) { return std::isfinite(pixel_[v][0]) && std::isfinite(pixel_[v][1]); });
  }

  // Whether triangles that look away are hidden by others for certain.
  bool is_closed() const {
    const TriMesh& mesh = panel_.surface;
    const SurfaceTopology found = topology(mesh.triangles, mesh.vertex_count());
    if (!found.open.empty() || !found.non_manifold.empty() || !found.disagreeing.empty()) return false;
    double volume = 0;
    for (const Triangle& t : mesh.triangles)
      volume += dot(mesh.vertices[t[0]], cross(mesh.vertices[t[1]], mesh.vertices[t[2]]));
    return volume > 0;
  }

  std::vector<size_t> back_to_front() const {
    const auto& triangles = panel_.surface.triangles;
    const bool closed = is_closed();
    std::vector<size_t> order;
    std::vector<double> depth(triangles.size());
    for (size_t t = 0; t < triangles.size(); ++t) {
      if (!is_drawable(triangles[t]) || (closed && dot(normal(triangles[t]), camera_.eye) < 0)) continue;
      order.push_back(t);
      for (const int v : triangles[t]) depth[t] += dot(panel_.surface.vertices[v], camera_.eye);
    }
    std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) { return depth[a] < depth[b]; });
    return order;
  }

  // Wires fade where triangles become as small as the wires are wide.
  double wire_strength() const {
    double length = 0;
    for (const Triangle& t : panel_.surface.triangles)
      length += std::hypot(pixel_[t[1]][0] - pixel_[t[0]][0], pixel_[t[1]][1] - pixel_[t[0]][1]);
    length /= static_cast<double>(std::max<size_t>(1, panel_.surface.triangles.size()));
    return std::isfinite(length) ? 0.6 * std::clamp((length - 2.5) / 12, 0.0, 1.0) : 0;
  }

  // Grown by a third of a pixel, so that no background shines through between neighbours.
  void add_fill(std::string& text, const Triangle& t, const std::string& ink) const {
    Point2 middle{};
    for (const int v : t) middle[0] += pixel_[v][0] / 3, middle[1] += pixel_[v][1] / 3;
    for (const int v : t) {
      const double du = pixel_[v][0] - middle[0], dv = pixel_[v][1] - middle[1];
      const double grow = 0.35 / std::max(1e-9, std::hypot(du, dv));
      text += fmt::format("{:.2f} {:.2f} {}\n", pixel_[v][0] + grow * du, pixel_[v][1] + grow * dv, ink);
    }
    text += '\n';
  }

  void add_wire(std::string& text, int from, int to, double strength) const {
    constexpr double kHalfWidth = 0.45;  // [px]
    const Point2 &a = pixel_[from], &b = pixel_[to];
    const double length = std::hypot(b[0] - a[0], b[1] - a[1]);
    if (!(length > 1e-6)) return;
    const double u = -kHalfWidth * (b[1] - a[1]) / length, v = kHalfWidth * (b[0] - a[0]) / length;
    const std::string ink = rgb({0.10, 0.16, 0.24}, 1, 1 - strength);
    for (const auto& [x, y] : {Point2{a[0] + u, a[1] + v}, Point2{b[0] + u, b[1] + v}, Point2{b[0] - u, b[1] - v},
                               Point2{a[0] - u, a[1] - v}})
      text += fmt::format("{:.2f} {:.2f} {}\n", x, y, ink);
    text += '\n';
  }

  const ShadedSurface& panel_;
  const Camera& camera_;
  Placement placement_;
  std::vector<Point2> pixel_;
};

void check(const std::filesystem::path& path, const MeshPicture& picture) {
  if (picture.panels.empty()) throw InvalidInput(path.string() + ": there is no surface to draw");
  for (const ShadedSurface& panel : picture.panels) {
    ASPIC_CHECK(panel.values.empty() || panel.values.size() == panel.surface.triangles.size() ||
                panel.values.size() == panel.surface.vertices.size());
    if (panel.surface.triangles.empty())
      throw InvalidInput(fmt::format("{}: the surface '{}' has no triangles", path.string(), panel.caption));
  }
}

void add_color_bar(Gnuplot& plot, const ValueRange& values, const std::string& value_label) {
  std::string stops;
  for (size_t i = 0; i < std::size(kViridis); ++i) {
    const Color& c = kViridis[i];
    stops += fmt::format("{}{} {} {} {}", i ? ", " : "", i, c[0], c[1], c[2]);
  }
  const double spread = values.max > values.min ? 0 : std::max(1e-12, 1e-3 * std::abs(values.min));
  plot.add(
      fmt::format("set palette defined ({})\nset cbrange {}", stops, range(values.min - spread, values.max + spread)));
  plot.add(fmt::format("set cblabel {} offset 1,0 textcolor rgb '{}'\nset cbtics textcolor rgb '{}'",
                       label(value_label), kInk, kInk));
  plot.add("set colorbox user origin 0.865, 0.2 size 0.018, 0.6");
}

// Where everything is on the picture, in pixels.
struct Layout {
  PictureSize size;
  double pixels = 1;  // per unit of `size`
  double width = 0, height = 0, column = 0, bottom = 0, top = 0, scale = 0;
  std::vector<Box> boxes;

  Placement placement(size_t panel) const {
    const Box& box = boxes[panel];
    return {scale, middle(panel) - scale * box.width() / 2, bottom + (top - bottom - scale * box.height()) / 2, box};
  }
  double middle(size_t panel) const { return (static_cast<double>(panel) + 0.5) * column; }
};

// All panels have one scale; the picture is not higher than they need.
Layout layout(const std::filesystem::path& path, const MeshPicture& picture, const Camera& camera, bool has_values) {
  Layout result;
  result.size = picture.size;
  result.pixels = path.extension() == ".png" ? 2 : 1;
  result.width = result.pixels * picture.size.width;
  double widest = 0, highest = 0;
  for (const ShadedSurface& panel : picture.panels) {
    result.boxes.push_back(bounds(panel.surface, camera));
    widest = std::max(widest, result.boxes.back().width());
    highest = std::max(highest, result.boxes.back().height());
  }
  if (!(widest > 0) || !std::isfinite(widest) || !(highest > 0))
    throw InvalidInput(path.string() + ": the surfaces have no size, or are not finite");

  result.column = (has_values ? 0.84 : 0.99) * result.width / static_cast<double>(result.boxes.size());
  result.bottom = 40 * result.pixels;
  const double above = (picture.title.empty() ? 10 : 46) * result.pixels;
  const double room = result.pixels * picture.size.height - result.bottom - above;
  result.scale = std::min(0.93 * result.column / widest, room / highest);
  const double needed = result.scale * highest + result.bottom + above;
  result.size.height = static_cast<int>(std::ceil(std::max(needed / result.pixels, has_values ? 260.0 : 120.0)));
  result.height = result.pixels * result.size.height;
  result.top = result.height - above;
  return result;
}

}  // namespace

void draw(const std::filesystem::path& path, const MeshPicture& picture) {
  check(path, picture);
  const Camera camera(picture.eye, picture.up);
  const ValueRange values = value_range(picture);
  const Layout layout = cli::layout(path, picture, camera, !values.is_empty());
  Gnuplot plot(path, layout.size);
  plot.add("unset border\nunset tics\nunset key\nset lmargin at screen 0\nset rmargin at screen 1");
  plot.add("set tmargin at screen 1\nset bmargin at screen 0\nset style fill solid 1 noborder");
  plot.add(fmt::format("set xrange [0:{}]\nset yrange [0:{}]", layout.width, layout.height));
  const auto write = [&](const std::string& text, double x, double y) {
    plot.add(fmt::format("set label {} at {}, {} center textcolor rgb '{}'", label(text), x, y, kInk));
  };
  write(picture.title, layout.width / 2, layout.height - 20 * layout.pixels);
  std::string polygons;
  for (size_t i = 0; i < picture.panels.size(); ++i) {
    polygons += Panel(picture.panels[i], camera, layout.placement(i)).polygons(values, picture.wires);
    write(picture.panels[i].caption, layout.middle(i), 18 * layout.pixels);
  }
  std::string layers = fmt::format("plot {} using 1:2:3 with polygons lc rgb variable", plot.data_file(polygons));
  if (!values.is_empty()) {
    add_color_bar(plot, values, picture.value_label);
    std::string outside;  // draws nothing, but brings the colour bar
    append_row(outside, {-layout.width, -layout.height, values.min});
    layers += fmt::format(", {} using 1:2:3 with points pt 0 lc palette", plot.data_file(outside));
  }
  plot.add(layers);
  plot.draw();
}

}  // namespace aspic::cli
