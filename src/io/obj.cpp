#include "io/obj.h"

#include <algorithm>
#include <climits>

#include "base/error.h"
#include "base/formatted.h"
#include "io/number_text.h"
#include "io/text_scanner.h"
#include "io/vertex_merger.h"

namespace aspic {
namespace {

// Statements without positions, polygons or lines.
const std::vector<std::string>& other_statements() {
  static const std::vector<std::string> names = {
      "vt",    "vn",     "vp",     "g",     "o",        "s",        "mg",   "usemtl",     "mtllib",
      "p",     "usemap", "maplib", "bevel", "c_interp", "d_interp", "lod",  "shadow_obj", "trace_obj",
      "ctech", "stech",  "call",   "csh",   "cstype",   "deg",      "bmat", "step",       "curv",
      "curv2", "surf",   "parm",   "trim",  "hole",     "scrv",     "sp",   "end",        "con"};
  return names;
}

class ObjReader {
 public:
  ObjReader(const std::string& file, std::string_view contents, bool reads_uv = false)
      : text_(file, contents, '#'), reads_uv_(reads_uv) {}

  MeshContent read() {
    while (!text_.at_end()) {
      const std::string_view statement = text_.word("a statement");
      if (statement == "v") {
        read_vertex();
      } else if (statement == "f" || statement == "fo") {
        read_face();
      } else if (statement == "vt" && reads_uv_) {
        read_texture_vertex();
      } else if (statement == "l") {
        read_line();
      } else {
        check_ignored(statement);
      }
      text_.skip_line();
    }
    check_forward_references();
    return std::move(content_);
  }

  bool has_uv() const {
    return std::any_of(uv_corners_.begin(), uv_corners_.end(), [](const Triangle& t) { return t != kNoUv; });
  }

  // Requires reads_uv and read().
  std::vector<TriangleCorners> uv(bool needs_area) {
    std::vector<TriangleCorners> uv;
    for (size_t t = 0; t < uv_corners_.size(); ++t) {
      text_.blame(positions_[t]);
      for (const int corner : uv_corners_[t])
        if (corner < 0 || corner >= static_cast<int>(uv_.size()))
          text_.fail(corner < 0 ? "a corner has no texture coordinates; unwrap the mesh and export it with UVs"
                                : "a corner names texture coordinates " + std::to_string(corner + 1) + " of " +
                                      std::to_string(uv_.size()) + "; correct it or get a complete copy");
      const auto& [a, b, c] = uv_corners_[t];
      uv.push_back({uv_[a], uv_[b], uv_[c]});
      if (needs_area && is_degenerate(uv.back()))
        text_.fail("a triangle has no area in its texture coordinates " + uv_text(uv_[a]) + ", " + uv_text(uv_[b]) +
                   ", " + uv_text(uv_[c]) + "; unwrap the mesh again");
    }
    return uv;
  }

 private:
  static constexpr Triangle kNoUv = {-1, -1, -1};

  static std::string uv_text(const Vec3d& p) { return formatted("(%g, %g)", p[0], p[1]); }

  void read_texture_vertex() {
    Vec3d vertex{};
    for (int r = 0; r < 2; ++r) {
      text_.require_on_line("a texture coordinate");
      vertex[r] = text_.number("a texture coordinate");
    }
    uv_.push_back(vertex);
    leave_line();  // a third one may follow
  }

  void read_vertex() {
    Vec3d vertex;
    for (double& coordinate : vertex.a) {
      text_.require_on_line("a vertex coordinate");
      coordinate = text_.number("a vertex coordinate");
    }
    content_.vertices.push_back(vertex);  // a weight or a color may follow
    leave_line();
  }

  void read_face() {
    corners_.clear();
    std::vector<int> uv;
    while (!text_.at_line_end()) {
      const std::string_view word = text_.word("a corner");
      corners_.push_back(corner(word));
      if (reads_uv_) uv.push_back(uv_corner(word));
    }
    if (corners_.size() < 3) text_.fail("a face has fewer than three corners; write 'f a b c' or remove it");
    add_fan(corners_, content_.triangles);
    if (!reads_uv_) return;
    add_fan(uv, uv_corners_);
    positions_.resize(uv_corners_.size(), text_.word_position());
  }

  void read_line() {
    corners_.clear();
    while (!text_.at_line_end()) corners_.push_back(corner(text_.word("an end of a line")));
    for (size_t i = 1; i < corners_.size(); ++i) content_.segments.push_back({corners_[i - 1], corners_[i]});
  }

  // "vertex", "vertex/texture", "vertex//normal" or "vertex/texture/normal"; counted from 1, or backward from -1.
  int corner(std::string_view word) {
    const auto given = parse_integer(word.substr(0, word.find('/')));
    if (!given) text_.fail("a corner is " + shown(word) + "; it must be a vertex number such as 1 or 1/1/1");
    const auto vertices = static_cast<int64_t>(content_.vertices.size());
    if (*given == 0 || *given < -vertices || *given > INT_MAX)
      text_.fail("a corner names vertex " + std::to_string(*given) + " of " + std::to_string(vertices) +
                 "; vertices count from 1, or from -1 backwards");
    const int64_t index = *given > 0 ? *given - 1 : vertices + *given;
    if (index > largest_) largest_ = index, largest_position_ = text_.word_position();
    return static_cast<int>(index);
  }

  // Returns the texture coordinates of a corner, -1 if it has none.
  int uv_corner(std::string_view word) const {
    const size_t first = word.find('/');
    if (first == std::string_view::npos) return -1;
    const auto given = parse_integer(word.substr(first + 1, word.find('/', first + 1) - first - 1));
    if (!given || *given == 0 || *given > INT_MAX) return -1;
    return static_cast<int>(std::max<int64_t>(*given > 0 ? *given - 1 : static_cast<int64_t>(uv_.size()) + *given, -1));
  }

  // After a continued line, skip_line() ends the line on which the statement ends.
  void leave_line() {
    while (!text_.at_line_end()) text_.word("");
  }

  void check_ignored(std::string_view statement) {
    const auto& known = other_statements();
    if (std::find(known.begin(), known.end(), statement) == known.end())
      text_.fail("unknown statement " + shown(statement) + suggestion(statement, {"v", "vt", "vn", "f"}) +
                 "; is this a Wavefront OBJ file?");
    leave_line();
  }

  // A face may precede its vertices, so this is checked at the end.
  void check_forward_references() {
    const auto vertices = static_cast<int64_t>(content_.vertices.size());
    if (largest_ < vertices) return;
    text_.blame(largest_position_);
    text_.fail("a corner names vertex " + std::to_string(largest_ + 1) + ", but the file has only " +
               std::to_string(vertices) + "; correct it or get a complete copy");
  }

  TextScanner text_;
  MeshContent content_;
  std::vector<int> corners_;
  int64_t largest_ = -1;
  size_t largest_position_ = 0;
  bool reads_uv_;
  std::vector<Vec3d> uv_;             // texture coordinates
  std::vector<Triangle> uv_corners_;  // of each triangle
  std::vector<size_t> positions_;     // of each triangle in the text
};

}  // namespace

MeshContent parse_obj(const std::string& file, std::string_view contents) { return ObjReader(file, contents).read(); }

std::vector<TriangleCorners> parse_obj_uv(const std::string& file, std::string_view contents) {
  ObjReader reader(file, contents, true);
  reader.read();
  return reader.uv(true);
}

std::vector<TriangleCorners> parse_obj_texture(const std::string& file, std::string_view contents) {
  ObjReader reader(file, contents, true);
  reader.read();
  return reader.has_uv() ? reader.uv(false) : std::vector<TriangleCorners>();
}

std::string obj_text(const TriMesh& mesh) {
  std::string text = "# Aspic\n";
  for (const Vec3d& vertex : mesh.vertices) {
    text += "v ";
    append_point(text, vertex);
    text += '\n';
  }
  for (const Triangle& triangle : mesh.triangles) {
    text += 'f';
    append_indices(text, triangle, 1);
    text += '\n';
  }
  return text;
}

std::string obj_text(const TriMesh& mesh, std::span<const TriangleUv> uv) {
  std::string text = obj_text(TriMesh{mesh.vertices, {}}), faces;
  VertexMerger merger;
  std::vector<Vec3d> distinct;
  for (size_t t = 0; t < uv.size(); ++t) {
    faces += 'f';
    for (size_t c = 0; c < 3; ++c) {
      append_indices(faces, std::array{mesh.triangles[t][c]}, 1);
      faces += '/';
      append_number(faces, merger.vertex({{uv[t][c][0], uv[t][c][1], 0}}, distinct) + 1);
    }
    faces += '\n';
  }
  for (const Vec3d& point : distinct) {
    text += "vt ";
    append_number(text, static_cast<float>(point[0]));
    text += ' ';
    append_number(text, static_cast<float>(point[1]));
    text += '\n';
  }
  return text + faces;
}

std::string obj_text_of_lines(const TetMesh& mesh) {
  std::string text = obj_text(TriMesh{mesh.rest, {}});
  for (const Segment& segment : mesh.rods) {
    text += 'l';
    append_indices(text, segment, 1);
    text += '\n';
  }
  return text;
}

}  // namespace aspic
