#include "io/ply.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/error.h"
#include "io/byte_cursor.h"
#include "io/number_text.h"
#include "io/ply_header.h"
#include "io/text_scanner.h"

namespace aspic {
namespace {

// Values of the text variant.
class TextSource {
 public:
  TextSource(const std::string& file, std::string_view contents, size_t begin)
      : text_(file, contents, TextScanner::kNoComments) {
    text_.seek(begin);
    text_.blame(begin);
  }
  static size_t least_bytes(PlyScalar) { return 2; }  // a digit and a blank

  double number(PlyScalar, std::string_view what) { return text_.number(what); }
  int64_t integer(PlyScalar, std::string_view what) { return text_.integer(what); }
  void skip(PlyScalar, std::string_view what) { text_.word(what); }
  int checked_count(int64_t value, std::string_view what, size_t bytes) const {
    return text_.checked_count(value, what, bytes);
  }
  [[noreturn]] void fail(std::string_view message) const { text_.fail(message); }

 private:
  TextScanner text_;
};

// Values of the two binary variants.
class PlyByteSource {
 public:
  PlyByteSource(const std::string& file, std::string_view contents, size_t begin, std::endian order)
      : bytes_(file, contents, begin, order) {}
  static size_t least_bytes(PlyScalar type) { return size(type); }

  double number(PlyScalar type, std::string_view what) { return bytes_.checked_finite(value(type, what), what); }
  int64_t integer(PlyScalar type, std::string_view what) {
    const double v = value(type, what);  // a double represents every 32-bit integer
    if (!(std::abs(v) <= 4294967295.0) || v != std::floor(v))
      bytes_.fail(std::string(what) + " is not a whole number; export the file again");
    return static_cast<int64_t>(v);
  }
  void skip(PlyScalar type, std::string_view what) { bytes_.skip(size(type), what); }
  int checked_count(int64_t v, std::string_view what, size_t bytes) const {
    return bytes_.checked_count(v, what, bytes);
  }
  [[noreturn]] void fail(std::string_view message) const { bytes_.fail(message); }

 private:
  double value(PlyScalar type, std::string_view what) {
    switch (type) {
      case PlyScalar::int8:
        return bytes_.read<int8_t>(what);
      case PlyScalar::uint8:
        return bytes_.read<uint8_t>(what);
      case PlyScalar::int16:
        return bytes_.read<int16_t>(what);
      case PlyScalar::uint16:
        return bytes_.read<uint16_t>(what);
      case PlyScalar::int32:
        return bytes_.read<int32_t>(what);
      case PlyScalar::uint32:
        return bytes_.read<uint32_t>(what);
      case PlyScalar::float32:
        return bytes_.read<float>(what);
      case PlyScalar::float64:
        break;
    }
    return bytes_.read<double>(what);
  }

  ByteCursor bytes_;
};

template <class Source>
class PlyReader {
 public:
  // `attribute`: the property of vertices to keep; empty: none.
  PlyReader(const PlyHeader& header, Source source, std::string attribute)
      : header_(header), source_(std::move(source)), attribute_(std::move(attribute)) {}

  std::vector<double> take_attribute() { return std::move(attribute_values_); }

  MeshContent read() {
    for (const PlyElement& element : header_.elements) {
      if (element.name == "tristrips" && element.count > 0)
        source_.fail("triangle strips are not read; export the surface with faces");
      if (element.properties.empty()) continue;  // needs no memory for any count
      if (element.name == "vertex") {
        if (std::exchange(has_vertices_, true))
          source_.fail("the header has a second element 'vertex'; merge it with the first");
        read_vertices(element);
      } else if (element.name == "face") {
        read_faces(element);
      } else {
        const int count = checked_count(element);
        for (int i = 0; i < count; ++i)
          for (const PlyProperty& property : element.properties) skip(property);
      }
    }
    return std::move(content_);
  }

 private:
  int checked_count(const PlyElement& element) const {
    size_t bytes = 0;
    for (const PlyProperty& property : element.properties)
      bytes += Source::least_bytes(property.is_list ? property.count_type : property.type);
    return source_.checked_count(element.count, "the number of elements " + shown(element.name), bytes);
  }

  int read_length(const PlyProperty& list) {
    const int64_t length = source_.integer(list.count_type, "the length of a list");
    return source_.checked_count(length, "the length of a list", Source::least_bytes(list.type));
  }

  void skip(const PlyProperty& property) {
    const int values = property.is_list ? read_length(property) : 1;
    for (int i = 0; i < values; ++i) source_.skip(property.type, "a property");
  }

  void read_vertices(const PlyElement& element) {
    constexpr std::string_view kAxes[] = {"x", "y", "z"};
    for (const std::string_view axis : kAxes)
      if (std::none_of(element.properties.begin(), element.properties.end(),
                       [&](const PlyProperty& p) { return p.name == axis && !p.is_list; }))
        source_.fail("vertices have no property '" + std::string(axis) + "'; export the file with x, y and z");
    if (!attribute_.empty()) require_attribute(element);
    content_.vertices.resize(static_cast<size_t>(checked_count(element)));
    for (Vec3d& vertex : content_.vertices)
      for (const PlyProperty& property : element.properties) {
        const auto axis = std::find(std::begin(kAxes), std::end(kAxes), property.name) - std::begin(kAxes);
        if (axis < 3 && !property.is_list)
          vertex[static_cast<int>(axis)] = source_.number(property.type, "a vertex coordinate");
        else if (!property.is_list && property.name == attribute_)
          attribute_values_.push_back(source_.number(property.type, "a value of '" + attribute_ + "'"));
        else
          skip(property);
      }
  }

  void require_attribute(const PlyElement& element) const {
    std::vector<std::string> known;
    for (const PlyProperty& p : element.properties)
      if (!p.is_list && p.name != "x" && p.name != "y" && p.name != "z") known.push_back(p.name);
    if (std::count(known.begin(), known.end(), attribute_) == 1) return;
    const std::string name = shown(attribute_);
    source_.fail(std::count(known.begin(), known.end(), attribute_) > 1
                     ? "vertices have several properties " + name + "; rename all but one"
                     : "vertices have no number " + name +
                           (known.empty() ? ", only positions; export the file with its vertex attributes"
                                          : suggestion(attribute_, known)));
  }

  void read_faces(const PlyElement& element) {
    const auto is_corners = [](const PlyProperty& p) {
      return p.is_list && (p.name == "vertex_indices" || p.name == "vertex_index");
    };
    if (std::none_of(element.properties.begin(), element.properties.end(), is_corners))
      source_.fail("faces have no list 'vertex_indices'; export the file with faces");
    const int count = checked_count(element);
    for (int i = 0; i < count; ++i)
      for (const PlyProperty& property : element.properties)
        if (is_corners(property))
          read_face(property);
        else
          skip(property);
  }

  void read_face(const PlyProperty& property) {
    corners_.resize(static_cast<size_t>(read_length(property)));
    if (corners_.size() < 3) source_.fail("a face has fewer than three corners; remove it");
    const auto vertices = static_cast<int64_t>(content_.vertices.size());
    for (int& corner : corners_) {
      const int64_t index = source_.integer(property.type, "a corner of a face");
      if (index < 0 || index >= vertices)
        source_.fail("a corner of a face is " + std::to_string(index) + ", but there are " + std::to_string(vertices) +
                     " vertices before it; correct it or get a complete copy");
      corner = static_cast<int>(index);
    }
    add_fan(corners_, content_.triangles);
  }

  const PlyHeader& header_;
  Source source_;
  std::string attribute_;
  MeshContent content_;
  std::vector<double> attribute_values_;
  std::vector<int> corners_;
  bool has_vertices_ = false;
};

PaintedSurface read_ply(const std::string& file, std::string_view contents, const std::string& attribute) {
  const PlyHeader header = parse_ply_header(file, contents);
  const auto read = [&](auto source) {
    PlyReader reader(header, std::move(source), attribute);
    MeshContent content = reader.read();
    return PaintedSurface{{std::move(content.vertices), std::move(content.triangles)}, reader.take_attribute()};
  };
  if (header.format == PlyFormat::ascii) return read(TextSource(file, contents, header.end));
  const std::endian order = header.format == PlyFormat::binary_big_endian ? std::endian::big : std::endian::little;
  return read(PlyByteSource(file, contents, header.end, order));
}

}  // namespace

MeshContent parse_ply(const std::string& file, std::string_view contents) {
  TriMesh surface = read_ply(file, contents, "").surface;
  return {std::move(surface.vertices), {}, {}, std::move(surface.triangles)};
}

PaintedSurface parse_painted_ply(const std::string& file, std::string_view contents, const std::string& attribute) {
  PaintedSurface painted = read_ply(file, contents, attribute);
  if (painted.surface.triangles.empty())
    throw InvalidInput(file + ": has no faces; export the surface that carries '" + attribute + "'");
  return painted;
}

std::string ply_bytes(const TriMesh& mesh, FileEncoding encoding) {
  const bool is_binary = encoding == FileEncoding::binary;
  std::string out = std::string("ply\nformat ") + (is_binary ? "binary_little_endian" : "ascii") +
                    " 1.0\ncomment Aspic\nelement vertex " + std::to_string(mesh.vertices.size()) +
                    "\nproperty double x\nproperty double y\nproperty double z\nelement face " +
                    std::to_string(mesh.triangles.size()) + "\nproperty list uchar int vertex_indices\nend_header\n";
  for (const Vec3d& vertex : mesh.vertices) {
    if (is_binary) {
      append_bytes(out, vertex);
    } else {
      append_point(out, vertex);
      out += '\n';
    }
  }
  for (const Triangle& triangle : mesh.triangles) {
    if (is_binary) {
      append_bytes(out, uint8_t{3});
      append_bytes(out, triangle);
    } else {
      out += '3';
      append_indices(out, triangle, 0);
      out += '\n';
    }
  }
  return out;
}

std::string ply_bytes_of_lines(const TetMesh& mesh) {
  std::string out = "ply\nformat binary_little_endian 1.0\ncomment Aspic\nelement vertex " +
                    std::to_string(mesh.rest.size()) +
                    "\nproperty double x\nproperty double y\nproperty double z\nelement edge " +
                    std::to_string(mesh.rods.size()) + "\nproperty int vertex1\nproperty int vertex2\nend_header\n";
  for (const Vec3d& vertex : mesh.rest) append_bytes(out, vertex);
  for (const Segment& segment : mesh.rods) append_bytes(out, segment);
  return out;
}

}  // namespace aspic
