#include "io/medit.h"

#include <algorithm>
#include <cctype>
#include <map>

#include "base/error.h"
#include "io/number_text.h"
#include "io/text_scanner.h"

namespace aspic {
namespace {

// Sections that can be skipped without losing data beside tets and triangles.
const std::vector<std::string>& skipped_sections() {
  static const std::vector<std::string> names = {"Edges",
                                                 "Corners",
                                                 "Ridges",
                                                 "RequiredVertices",
                                                 "RequiredEdges",
                                                 "RequiredTriangles",
                                                 "RequiredQuadrilaterals",
                                                 "RequiredTetrahedra",
                                                 "ParallelVertices",
                                                 "ParallelEdges",
                                                 "ParallelTriangles",
                                                 "ParallelQuadrilaterals",
                                                 "ParallelTetrahedra",
                                                 "Normals",
                                                 "NormalAtVertices",
                                                 "NormalAtTriangles",
                                                 "NormalAtTriangleVertices",
                                                 "NormalAtQuadrilaterals",
                                                 "NormalAtQuadrilateralVertices",
                                                 "Tangents",
                                                 "TangentAtVertices",
                                                 "TangentAtEdges",
                                                 "TangentAtEdgeVertices",
                                                 "Geometry",
                                                 "Identifier",
                                                 "IncludeFile",
                                                 "AngleOfCornerBound",
                                                 "BoundingBox",
                                                 "SubDomainFromMesh",
                                                 "SubDomainFromGeom",
                                                 "SubDomain",
                                                 "VertexOnGeometricVertex",
                                                 "VertexOnGeometricEdge",
                                                 "VertexOnGeometricTriangle",
                                                 "VertexOnGeometricQuadrilateral",
                                                 "EdgeOnGeometricEdge",
                                                 "VertexOnSupportVertex",
                                                 "VertexOnSupportEdge",
                                                 "VertexOnSupportTriangle",
                                                 "VertexOnSupportQuadrilateral",
                                                 "VertexOnSupportTetrahedron",
                                                 "VertexOnSupportPentahedron",
                                                 "VertexOnSupportHexahedron",
                                                 "CrackedEdges",
                                                 "CrackedTriangles",
                                                 "CrackedQuadrilaterals",
                                                 "EquivalentEdges",
                                                 "EquivalentTriangles",
                                                 "EquivalentQuadrilaterals",
                                                 "PhysicsReference",
                                                 "Time",
                                                 "Iterations"};
  return names;
}

// Sections that contain parts of the solid and must not be skipped.
const std::map<std::string_view, std::string_view>& lost_solids() {
  static const std::map<std::string_view, std::string_view> names = {{"Hexahedra", "hexahedra"},
                                                                     {"Hexaedra", "hexahedra"},
                                                                     {"Prisms", "prisms"},
                                                                     {"Pentahedra", "prisms"},
                                                                     {"Wedges", "prisms"},
                                                                     {"Pyramids", "pyramids"},
                                                                     {"TetrahedraP3", "20-node tets (third order)"},
                                                                     {"TetrahedraP4", "35-node tets (fourth order)"}};
  return names;
}

class MeditReader {
 public:
  MeditReader(const std::string& file, std::string_view contents) : text_(file, contents, '#') {}

  MeshContent read() {
    find_sections();
    if (!seek("Vertices")) text_.fail("the file has no 'Vertices'; export the mesh again");
    read_vertices();
    if (seek("Tetrahedra")) read_tets<4>();
    if (seek("TetrahedraP2")) read_tets<10>();
    clear_labels_of_zero();
    if (seek("Triangles")) read_polygons<3>("the number of triangles");
    if (seek("Quadrilaterals")) read_polygons<4>("the number of quadrilaterals");
    for (auto& [label, triangles] : surfaces_) content_.groups.surfaces.push_back({label, "", std::move(triangles)});
    return std::move(content_);
  }

 private:
  // Sections have any order, and tets may precede their vertices, so their positions are collected first.
  void find_sections() {
    if (const auto word = text_.word("'MeshVersionFormatted'"); word != "MeshVersionFormatted")
      text_.fail("found " + shown(word) + " where 'MeshVersionFormatted' should be; is this a Medit .mesh file?");
    text_.small_integer("the version");
    while (!text_.at_end()) {
      const std::string_view word = text_.quoted("a keyword");
      if (text_.text()[text_.word_position()] == '"')
        continue;  // a name of a file, such as that of the section Geometry
      if (!std::isalpha(static_cast<unsigned char>(word[0]))) continue;  // a number of the previous section
      if (word == "End") return;
      if (word == "nan" || word == "inf" || word == "NaN" || word == "Inf")
        text_.fail("a number is " + shown(word) + "; it must be finite");
      if (word == "Dimension") {
        if (text_.integer("the dimension") != 3) text_.fail("the mesh is not three-dimensional; use a 3-d mesh");
      } else {
        note_section(word);
      }
    }
  }

  void note_section(std::string_view word) {
    const bool is_read = std::find(std::begin(kRead), std::end(kRead), word) != std::end(kRead);
    if (is_read && !sections_.emplace(word, text_.position()).second)
      text_.fail("a second section " + shown(word) + "; merge it with the first");
    if (const auto lost = lost_solids().find(word); lost != lost_solids().end() && text_.integer("a count") != 0)
      text_.fail("the mesh has " + std::string(lost->second) +
                 ", which are not read; export it with 4-node or 10-node tets only");
    const auto& skipped = skipped_sections();
    if (is_read || lost_solids().contains(word) || std::find(skipped.begin(), skipped.end(), word) != skipped.end())
      return;
    std::vector<std::string> known(std::begin(kRead), std::end(kRead));
    text_.fail("unknown keyword " + shown(word) + suggestion(word, known) + "; correct or remove this section");
  }

  bool seek(std::string_view section) {
    const auto place = sections_.find(section);
    if (place != sections_.end()) text_.seek(place->second);
    return place != sections_.end();
  }

  void read_vertices() {
    content_.vertices.resize(static_cast<size_t>(text_.count("the number of vertices", 8)));
    for (Vec3d& vertex : content_.vertices) {
      for (double& coordinate : vertex.a) coordinate = text_.number("a vertex coordinate");
      text_.integer("the reference of a vertex");
    }
  }

  template <size_t corners>
  std::array<int, corners> read_corners() {
    std::array<int, corners> element;
    for (int& corner : element) corner = text_.index("a corner", 1, static_cast<int>(content_.vertices.size()));
    return element;
  }

  template <size_t nodes>
  void read_tets() {
    const int count = text_.count("the number of tets", 2 * (nodes + 1));
    for (int t = 0; t < count; ++t) {
      const std::array<int, nodes> tet = read_corners<nodes>();
      content_.tets.push_back({tet[0], tet[1], tet[2], tet[3]});
      content_.region.push_back(text_.small_integer("the reference of a tet"));
      if (nodes == 4) continue;
      content_.mids.resize(content_.tets.size(), {-1, -1, -1, -1, -1, -1});
      std::copy(tet.begin() + 4, tet.end(), content_.mids.back().begin());
    }
  }

  // Reference 0 means no label.
  void clear_labels_of_zero() {
    if (std::all_of(content_.region.begin(), content_.region.end(), [](int label) { return label == 0; }))
      content_.region.clear();
  }

  template <size_t corners>
  void read_polygons(std::string_view what) {
    const int count = text_.count(what, 2 * (corners + 1));
    for (int i = 0; i < count; ++i) {
      const std::array<int, corners> face = read_corners<corners>();
      add_fan(face, content_.triangles);
      const int label = text_.small_integer("the reference of a face");
      if (label != 0 && !content_.tets.empty()) add_fan(face, surfaces_[label]);
    }
  }

  static constexpr std::string_view kRead[] = {"Vertices", "Tetrahedra", "TetrahedraP2", "Triangles", "Quadrilaterals"};

  TextScanner text_;
  MeshContent content_;
  std::map<std::string_view, size_t> sections_;
  std::map<int, std::vector<Triangle>> surfaces_;  // by reference
};

void append_section(std::string& text, std::string_view keyword, size_t count) {
  text += keyword;
  text += '\n';
  append_number(text, count);
  text += '\n';
}

std::string head(const std::vector<Vec3d>& vertices) {
  std::string text = "MeshVersionFormatted 2\nDimension 3\n";
  append_section(text, "Vertices", vertices.size());
  for (const Vec3d& vertex : vertices) {
    append_point(text, vertex);
    text += " 0\n";
  }
  return text;
}

// "i j k reference"
template <class Corners>
void append_element(std::string& text, const Corners& corners, int reference) {
  append_indices(text, corners, 1);
  append_indices(text, std::array{reference}, 0);
  text += '\n';
}

}  // namespace

MeshContent parse_medit(const std::string& file, std::string_view contents) {
  return MeditReader(file, contents).read();
}

std::string medit_text(const TetMesh& mesh) {
  std::string text = head(mesh.rest);
  append_section(text, "Tetrahedra", mesh.tets.size());
  for (size_t t = 0; t < mesh.tets.size(); ++t)
    append_element(text, mesh.tets[t], mesh.region.empty() ? 0 : mesh.region[t]);
  return text + "End\n";
}

std::string medit_text(const TriMesh& mesh) {
  std::string text = head(mesh.vertices);
  append_section(text, "Triangles", mesh.triangles.size());
  for (const Triangle& triangle : mesh.triangles) append_element(text, triangle, 0);
  return text + "End\n";
}

}  // namespace aspic
