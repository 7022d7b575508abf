#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "base/error.h"
#include "base/printable.h"
#include "io/atomic_file.h"
#include "io/obj.h"
#include "io/ply.h"
#include "io/ply_header.h"
#include "io/text_scanner.h"
#include "recording/formats.h"

namespace aspic {
namespace {

namespace fs = std::filesystem;

using NamedPoints = std::vector<std::pair<std::string, Vec3d>>;

NamedPoints all_vertices(const std::vector<Vec3d>& vertices) {
  NamedPoints points;
  for (size_t v = 0; v < vertices.size(); ++v) points.emplace_back(std::to_string(v), vertices[v]);
  return points;
}

bool has_markers(const PlyHeader& header) {
  for (const PlyElement& element : header.elements)
    if (element.name == "vertex")
      for (const PlyProperty& property : element.properties)
        if (property.name == "marker" && !property.is_list) return true;
  return false;
}

// The vertices whose property "marker" is a number from 0; without the property, all vertices.
NamedPoints points_of_ply(const std::string& file, const std::string& contents) {
  if (!has_markers(parse_ply_header(file, contents))) return all_vertices(parse_ply(file, contents).vertices);
  const PaintedSurface painted = parse_painted_points(file, contents, "marker");
  NamedPoints points;
  for (size_t v = 0; v < painted.value.size(); ++v) {
    const double number = painted.value[v];
    if (number != std::floor(number) || std::abs(number) > 2e9)
      throw InvalidInput(file + ": vertex " + std::to_string(v) + " has marker = " + std::to_string(number) +
                         "; it must be a whole number, negative for other vertices");
    if (number >= 0) points.emplace_back(std::to_string(static_cast<int>(number)), painted.surface.vertices[v]);
  }
  return points;
}

// The vertices of point elements "p", named after their object or group; without such elements, all vertices.
NamedPoints points_of_obj(const std::string& file, const std::string& contents) {
  const std::vector<Vec3d> vertices = parse_obj(file, contents).vertices;
  TextScanner text(file, contents, '#');
  NamedPoints points;
  std::string object;
  int seen = 0;  // vertices above
  while (!text.at_end()) {
    const std::string_view statement = text.word("a statement");
    if (statement == "v") ++seen;
    if ((statement == "o" || statement == "g") && !text.at_line_end()) object = printable(text.word("a name"));
    while (statement == "p" && !text.at_line_end()) {
      const int64_t given = text.integer("a vertex");
      const int64_t vertex = given > 0 ? given - 1 : seen + given;
      if (vertex < 0 || vertex >= static_cast<int64_t>(vertices.size()))
        text.fail("a point names vertex " + std::to_string(given) + " of " + std::to_string(vertices.size()));
      points.emplace_back(object.empty() ? std::to_string(vertex) : object, vertices[static_cast<size_t>(vertex)]);
    }
    text.skip_line();
  }
  return points.empty() ? all_vertices(vertices) : points;
}

class SequenceReader {
 public:
  Recording read(const std::vector<fs::path>& files) {
    recording_.file = printable(files[0].string());
    for (const fs::path& file : files) add(file);
    for (RecordedFrame& frame : recording_.frames) frame.positions.resize(recording_.names.size(), kHidden);
    check_recording(recording_, bytes_);
    return std::move(recording_);
  }

 private:
  static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  static constexpr Vec3d kHidden = {{kNone, kNone, kNone}};

  void add(const fs::path& path) {
    const std::string file = printable(path.string()), contents = read_file(path);
    bytes_ += contents.size();
    std::string extension = path.extension().string();
    const bool is_obj = extension == ".obj" || extension == ".OBJ";
    const NamedPoints points = is_obj ? points_of_obj(file, contents) : points_of_ply(file, contents);
    if (points.empty()) throw InvalidInput(file + ": has no vertices that are markers; number them from 0");
    RecordedFrame frame{static_cast<int>(recording_.frames.size()) + 1, 0, file, {}};
    for (const auto& [name, p] : points) {
      const auto [point, is_new] = index_.try_emplace(name, recording_.names.size());
      if (is_new) recording_.names.push_back(name);
      frame.positions.resize(std::max(frame.positions.size(), point->second + 1), kHidden);
      if (is_seen(frame.positions[point->second]))
        throw InvalidInput(file + ": the marker '" + name + "' is there twice; give each its own number or name");
      frame.positions[point->second] = p;
    }
    recording_.frames.push_back(std::move(frame));
    check_density(recording_.frames.size(), recording_.names.size(), bytes_, file);
  }

  Recording recording_;
  size_t bytes_ = 0;
  std::map<std::string, size_t> index_;
};

}  // namespace

Recording read_surface_sequence(const std::vector<fs::path>& files) { return SequenceReader().read(files); }

}  // namespace aspic
