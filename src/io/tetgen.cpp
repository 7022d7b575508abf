#include "io/tetgen.h"

#include <climits>
#include <cmath>

#include "io/number_text.h"
#include "io/text_scanner.h"

namespace aspic {
namespace {

int optional_integer(TextScanner& text, std::string_view what, int absent) {
  return text.at_line_end() ? absent : text.small_integer(what);
}

// Lines are numbered consecutively; `first` is the first number.
void check_number(TextScanner& text, std::string_view what, int64_t expected) {
  const int64_t number = text.integer(what);
  if (number != expected)
    text.fail(std::string(what) + " is " + std::to_string(number) + " where " + std::to_string(expected) +
              " should be; number them in order");
}

// "count 3 attributes markers", then "number x y z attributes... marker". Returns the number of the first vertex.
int read_vertices(TextScanner& text, std::vector<Vec3d>& vertices) {
  const int count = text.count("the number of vertices", 8);
  if (optional_integer(text, "the dimension", 3) != 3) text.fail("the mesh is not three-dimensional; use a 3-d mesh");
  text.skip_line();
  vertices.resize(static_cast<size_t>(count));
  if (count == 0) return 0;
  text.peek();
  const size_t begin = text.position();
  const int64_t first = text.integer("the number of a vertex");
  if (first != 0 && first != 1) text.fail("the first vertex has number " + std::to_string(first) + "; begin at 0 or 1");
  text.seek(begin);
  for (int v = 0; v < count; ++v) {
    check_number(text, "the number of a vertex", first + v);
    for (double& coordinate : vertices[static_cast<size_t>(v)].a) {
      text.require_on_line("a vertex coordinate");
      coordinate = text.number("a vertex coordinate");
    }
    text.skip_line();  // attributes and the boundary marker
  }
  return static_cast<int>(first);
}

int region_label(TextScanner& text) {
  text.require_on_line("the attribute of a tet");
  const std::string_view word = text.word("the attribute of a tet");
  const auto label = parse_number(word);
  if (!label || *label != std::floor(*label) || std::abs(*label) > INT_MAX)
    text.fail("the attribute of a tet is " + shown(word) + "; a region label is a whole number");
  return static_cast<int>(*label);
}

// "count 4 attributes", then "number a b c d attributes...".
void read_tets(TextScanner& text, int first_vertex, MeshContent& content) {
  const int count = text.count("the number of tets", 10);
  const int corners = optional_integer(text, "the number of corners of a tet", 4);
  if (corners == 10) text.fail("these are 10-node tets (second order); export 4-node tets (without tetgen -o2)");
  if (corners != 4) text.fail("a tet has " + std::to_string(corners) + " corners; it must have 4");
  const bool has_region = optional_integer(text, "the number of attributes", 0) > 0;
  text.skip_line();
  content.tets.resize(static_cast<size_t>(count));
  if (has_region) content.region.resize(content.tets.size());
  for (size_t t = 0; t < content.tets.size(); ++t) {
    text.integer("the number of a tet");  // not used
    for (int& corner : content.tets[t]) {
      text.require_on_line("a corner of a tet");
      corner = text.index("a corner of a tet", first_vertex, static_cast<int>(content.vertices.size()));
    }
    if (has_region) content.region[t] = region_label(text);
    text.skip_line();
  }
}

}  // namespace

MeshContent parse_tetgen(const std::string& node_file, std::string_view node, const std::string& ele_file,
                         std::string_view ele) {
  MeshContent content;
  TextScanner nodes(node_file, node, '#'), tets(ele_file, ele, '#');
  const int first_vertex = read_vertices(nodes, content.vertices);
  read_tets(tets, first_vertex, content);
  return content;
}

TetgenText tetgen_text(const TetMesh& mesh) {
  TetgenText text;
  append_number(text.node, mesh.vertex_count());
  text.node += " 3 0 0\n";
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    append_number(text.node, v);
    text.node += ' ';
    append_point(text.node, mesh.rest[v]);
    text.node += '\n';
  }
  append_number(text.ele, mesh.tet_count());
  text.ele += mesh.region.empty() ? " 4 0\n" : " 4 1\n";
  for (int t = 0; t < mesh.tet_count(); ++t) {
    append_number(text.ele, t);
    append_indices(text.ele, mesh.tets[t], 0);
    if (!mesh.region.empty()) append_indices(text.ele, std::array{mesh.region[t]}, 0);
    text.ele += '\n';
  }
  return text;
}

}  // namespace aspic
