#include "io/obj.h"

#include <algorithm>
#include <climits>

#include "base/error.h"
#include "io/number_text.h"
#include "io/text_scanner.h"

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
  ObjReader(const std::string& file, std::string_view contents) : text_(file, contents, '#') {}

  MeshContent read() {
    while (!text_.at_end()) {
      const std::string_view statement = text_.word("a statement");
      if (statement == "v") {
        read_vertex();
      } else if (statement == "f" || statement == "fo") {
        read_face();
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

 private:
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
    while (!text_.at_line_end()) corners_.push_back(corner(text_.word("a corner")));
    if (corners_.size() < 3) text_.fail("a face has fewer than three corners; write 'f a b c' or remove it");
    add_fan(corners_, content_.triangles);
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
};

}  // namespace

MeshContent parse_obj(const std::string& file, std::string_view contents) { return ObjReader(file, contents).read(); }

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
