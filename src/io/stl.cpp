#include "io/stl.h"

#include <cctype>
#include <cmath>

#include "base/error.h"
#include "io/byte_cursor.h"
#include "io/number_text.h"
#include "io/text_scanner.h"
#include "io/vertex_merger.h"

namespace aspic {
namespace {

constexpr size_t kHeaderSize = 80, kCountSize = 4, kTriangleSize = 50;  // parts of binary STL [bytes]

std::string_view lower(std::string_view word, std::string& space) {
  space.assign(word);
  for (char& c : space) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return space;
}

// solid NAME / facet normal x y z / outer loop / vertex x y z, three times / endloop / endfacet / endsolid NAME
class StlTextReader {
 public:
  StlTextReader(const std::string& file, std::string_view contents) : text_(file, contents, TextScanner::kNoComments) {}

  MeshContent read() {
    while (!text_.at_end()) {
      expect("solid", "'solid'");
      text_.skip_line();
      while (next_is("facet")) read_facet();
      expect_end();
      text_.skip_line();
    }
    return std::move(content_);
  }

 private:
  void read_facet() {
    expect("facet", "'facet'");
    expect("normal", "'normal'");
    for (int i = 0; i < 3; ++i) text_.word("a normal");  // normals are derived data, often wrong or NaN, and not read
    expect("outer", "'outer loop'");
    expect("loop", "'outer loop'");
    Triangle triangle;
    for (int& corner : triangle) {
      expect("vertex", "'vertex'");
      Vec3d point;
      for (double& coordinate : point.a) coordinate = text_.number("a vertex coordinate");
      corner = merger_.vertex(point, content_.vertices);
    }
    expect("endloop", "'endloop' after three vertices");
    expect("endfacet", "'endfacet'");
    content_.triangles.push_back(triangle);
  }

  // "endsolid", or "end solid" as some programs write it.
  void expect_end() {
    if (!next_is("end")) return expect("endsolid", "'facet' or 'endsolid'");
    expect("end", "'endsolid'");
    expect("solid", "'endsolid'");
  }

  bool next_is(std::string_view word) { return lower(text_.peek(), space_) == word; }

  void expect(std::string_view word, std::string_view what) {
    const std::string_view found = text_.word(what);
    if (lower(found, space_) != word)
      text_.fail("found " + shown(found) + " where " + std::string(what) + " should be; is this an STL file?");
  }

  TextScanner text_;
  MeshContent content_;
  VertexMerger merger_;
  std::string space_;
};

MeshContent parse_binary(ByteCursor bytes, int count) {
  MeshContent content;
  VertexMerger merger;
  content.triangles.reserve(static_cast<size_t>(count));
  for (int i = 0; i < count; ++i) {
    bytes.skip(3 * sizeof(float), "a normal");
    Triangle triangle;
    for (int& corner : triangle) {
      Vec3d point;
      for (double& coordinate : point.a) coordinate = bytes.finite<float>("a vertex coordinate");
      corner = merger.vertex(point, content.vertices);
    }
    bytes.skip(sizeof(uint16_t), "the attribute of a triangle");
    content.triangles.push_back(triangle);
  }
  return content;
}

// Unit normal of a triangle; zero if it has no area.
Vec3d normal(const TriMesh& mesh, const Triangle& triangle) {
  const Vec3d& a = mesh.vertices[triangle[0]];
  const Vec3d n = cross(mesh.vertices[triangle[1]] - a, mesh.vertices[triangle[2]] - a);
  const double length = norm(n);
  return length > 0 && std::isfinite(length) ? (1 / length) * n : Vec3d{{0, 0, 0}};
}

std::string text_of(const TriMesh& mesh) {
  std::string text = "solid aspic\n";
  for (const Triangle& triangle : mesh.triangles) {
    text += "facet normal ";
    append_point(text, normal(mesh, triangle));
    text += "\nouter loop\n";
    for (const int corner : triangle) {
      text += "vertex ";
      append_point(text, mesh.vertices[corner]);
      text += '\n';
    }
    text += "endloop\nendfacet\n";
  }
  return text + "endsolid aspic\n";
}

std::string bytes_of(const std::string& file, const TriMesh& mesh) {
  std::string bytes = "binary STL by Aspic";
  bytes.resize(kHeaderSize, '\0');
  append_bytes(bytes, static_cast<uint32_t>(mesh.triangles.size()));
  const auto append_floats = [&](const Vec3d& point) {
    for (const double coordinate : point.a) append_bytes(bytes, static_cast<float>(coordinate));
  };
  for (const Triangle& triangle : mesh.triangles) {
    append_floats(normal(mesh, triangle));
    for (const int corner : triangle) {
      const Vec3d& point = mesh.vertices[corner];
      for (const double coordinate : point.a)
        if (!std::isfinite(static_cast<float>(coordinate)))
          throw InvalidInput(file + ": not written, since vertex " + std::to_string(corner) +
                             " is too far out for the single precision of binary STL; write ASCII");
      append_floats(point);
    }
    append_bytes(bytes, uint16_t{0});
  }
  return bytes;
}

}  // namespace

// Many binary files begin with "solid", too, so the size decides: a binary file has exactly the size that it states.
MeshContent parse_stl(const std::string& file, std::string_view contents) {
  const size_t first = contents.find_first_not_of(" \t\r\n");
  std::string space;
  const bool starts_with_solid = first != contents.npos && lower(contents.substr(first, 5), space) == "solid";
  if (contents.size() >= kHeaderSize + kCountSize) {
    ByteCursor bytes(file, contents, kHeaderSize);
    const auto count = bytes.read<uint32_t>("the number of triangles");
    if (contents.size() - kHeaderSize - kCountSize == kTriangleSize * uint64_t{count})
      return parse_binary(bytes, bytes.checked_count(count, "the number of triangles", kTriangleSize));
    if (!starts_with_solid)
      bytes.fail("the header states " + std::to_string(count) + " triangles, that is " +
                 std::to_string(kHeaderSize + kCountSize + kTriangleSize * uint64_t{count}) +
                 " bytes, but the file has " + std::to_string(contents.size()) +
                 "; it is damaged or no STL file, get a complete copy");
  }
  if (!starts_with_solid)
    throw InvalidInput(file +
                       ":1: neither begins with 'solid' nor has the 84 bytes of a binary header; is this an STL file?");
  return StlTextReader(file, contents).read();
}

std::string stl_bytes(const std::string& file, const TriMesh& mesh, FileEncoding encoding) {
  return encoding == FileEncoding::ascii ? text_of(mesh) : bytes_of(file, mesh);
}

}  // namespace aspic
