#include "io/off.h"

#include "io/number_text.h"
#include "io/text_scanner.h"

namespace aspic {
namespace {

// [ST][C][N]OFF: data announced by the prefixes follows the coordinates of a vertex.
void check_header(TextScanner& text) {
  std::string_view header = text.word("'OFF'");
  for (const std::string_view prefix : {"ST", "C", "N"})
    if (header.starts_with(prefix)) header.remove_prefix(prefix.size());
  if (header == "4OFF" || header == "nOFF" || header == "4nOFF")
    text.fail("vertices of " + std::string(header) + " are not three-dimensional; export the surface as plain OFF");
  if (header != "OFF") text.fail("found " + shown(header) + " where 'OFF' should be; is this an OFF file?");
  if (text.peek() == "BINARY") text.fail("binary OFF is not read; export it as text, or as PLY");
}

}  // namespace

MeshContent parse_off(const std::string& file, std::string_view contents) {
  TextScanner text(file, contents, '#');
  check_header(text);
  // Shortest lines: "0 0 0" and "3 0 0 0".
  const int vertices = text.count("the number of vertices", 6);
  const int faces = text.count("the number of faces", 8);
  text.skip_line();  // the number of edges is not needed

  MeshContent content;
  content.vertices.resize(static_cast<size_t>(vertices));
  for (Vec3d& vertex : content.vertices) {
    for (double& coordinate : vertex.a) {
      if (&coordinate != vertex.a) text.require_on_line("a vertex coordinate");
      coordinate = text.number("a vertex coordinate");
    }
    text.skip_line();
  }
  std::vector<int> corners;
  for (int face = 0; face < faces; ++face) {
    corners.resize(static_cast<size_t>(text.count("the number of corners of a face", 2)));
    if (corners.size() < 3) text.fail("a face has fewer than three corners; remove it");
    for (int& corner : corners) corner = text.index("a corner of a face", 0, vertices);
    add_fan(corners, content.triangles);
    text.skip_line();  // a color may follow
  }
  return content;
}

std::string off_text(const TriMesh& mesh) {
  std::string text = "OFF\n";
  append_number(text, mesh.vertex_count());
  append_indices(text, std::array{mesh.triangle_count(), 0}, 0);
  text += '\n';
  for (const Vec3d& vertex : mesh.vertices) {
    append_point(text, vertex);
    text += '\n';
  }
  for (const Triangle& triangle : mesh.triangles) {
    text += '3';
    append_indices(text, triangle, 0);
    text += '\n';
  }
  return text;
}

}  // namespace aspic
