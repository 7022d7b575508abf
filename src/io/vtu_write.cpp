#include <zlib.h>

#include <array>
#include <bit>
#include <cstdint>
#include <cstring>

#include "base/check.h"
#include "base/error.h"
#include "base/parallel.h"
#include "io/atomic_file.h"
#include "io/base64.h"
#include "io/vtk_cells.h"
#include "io/vtu.h"
#include "io/xml.h"
#include "mesh/tet_nodes.h"

namespace aspic {
namespace {

static_assert(std::endian::native == std::endian::little, "the files say LittleEndian");

constexpr size_t kBlockSize = 1 << 18;  // bytes per compressed block, so that threads share the work
constexpr int kCompression = 1;         // fastest: mantissas of positions hardly compress at any level

template <class Stored, class Number>
std::string bytes_of(std::span<const Number> numbers) {
  std::string bytes(numbers.size() * sizeof(Stored), '\0');
  for (size_t i = 0; i < numbers.size(); ++i) {
    const auto stored = static_cast<Stored>(numbers[i]);
    std::memcpy(bytes.data() + i * sizeof(Stored), &stored, sizeof(Stored));
  }
  return bytes;
}

std::string deflated(std::string_view bytes) {
  uLongf size = compressBound(bytes.size());
  std::string block(size, '\0');
  const int result = compress2(reinterpret_cast<Bytef*>(block.data()), &size,
                               reinterpret_cast<const Bytef*>(bytes.data()), bytes.size(), kCompression);
  block.resize(result == Z_OK ? size : 0);
  return block;
}

// [blocks][size of a block][size of the last block, 0: full][compressed size of each block] blocks
void append_compressed(std::string_view bytes, std::string& text) {
  const size_t blocks = (bytes.size() + kBlockSize - 1) / kBlockSize;
  std::vector<std::string> block(blocks);
  parallel_for(static_cast<int>(blocks),
               [&](int i) { block[i] = deflated(bytes.substr(static_cast<size_t>(i) * kBlockSize, kBlockSize)); });
  std::vector<uint32_t> header = {static_cast<uint32_t>(blocks), kBlockSize,
                                  static_cast<uint32_t>(bytes.size() % kBlockSize)};
  std::string data;
  for (const std::string& compressed : block) {
    if (compressed.empty()) throw InvalidInput("zlib could not compress the data (out of memory?)");
    header.push_back(static_cast<uint32_t>(compressed.size()));
    data += compressed;
  }
  append_base64({reinterpret_cast<const char*>(header.data()), header.size() * 4}, text);
  append_base64(data, text);
}

struct ArrayTag {
  std::string_view type, name;
  int components = 1;
  std::string attributes = "";
};

void append_array(const ArrayTag& tag, std::string_view bytes, std::string& text) {
  text += "<DataArray type=\"" + std::string(tag.type) + "\" Name=\"" + xml_escaped(tag.name) + "\"";
  // Omitted for scalars, which meshio would otherwise return as a column.
  if (tag.components != 1) text += " NumberOfComponents=\"" + std::to_string(tag.components) + "\"";
  text += tag.attributes + " format=\"binary\">\n";
  append_compressed(bytes, text);
  text += "\n</DataArray>\n";
}

void append_field(const Field& field, const std::string& attributes, std::string& text) {
  const std::span<const double> values = field.values;
  switch (field.type) {
    case FieldType::float64:
      return append_array({"Float64", field.name, field.components, attributes}, bytes_of<double>(values), text);
    case FieldType::float32:
      return append_array({"Float32", field.name, field.components, attributes}, bytes_of<float>(values), text);
    case FieldType::int32:
      return append_array({"Int32", field.name, field.components, attributes}, bytes_of<int32_t>(values), text);
  }
}

void append_fields(const std::vector<Field>& fields, [[maybe_unused]] size_t count, std::string& text) {
  for (const Field& field : fields) {
    ASPIC_CHECK(field.values.size() == count * static_cast<size_t>(field.components));
    append_field(field, "", text);
  }
}

void append_file_fields(const std::vector<Field>& fields, std::string& text) {
  if (fields.empty()) return;
  text += "<FieldData>\n";
  for (const Field& field : fields) {
    const size_t tuples = field.values.size() / static_cast<size_t>(field.components);
    append_field(field, " NumberOfTuples=\"" + std::to_string(tuples) + "\"", text);
  }
  text += "</FieldData>\n";
}

struct Cells {
  std::vector<int> connectivity;
  std::vector<int64_t> offsets;  // end of each cell in the connectivity
  std::string types;

  template <class Nodes>
  void add(const Nodes& nodes, uint8_t type) {
    connectivity.insert(connectivity.end(), nodes.begin(), nodes.end());
    offsets.push_back(static_cast<int64_t>(connectivity.size()));
    types.push_back(static_cast<char>(type));
  }
};

void append_cells(const Cells& cells, std::string& text) {
  append_array({"Int32", "connectivity"}, bytes_of<int32_t>(std::span<const int>(cells.connectivity)), text);
  append_array({"Int64", "offsets"}, bytes_of<int64_t>(std::span<const int64_t>(cells.offsets)), text);
  append_array({"UInt8", "types"}, cells.types, text);
}

void write(const std::string& path, std::span<const double> points, const Cells& cells, const VtuFields& fields) {
  const size_t point_count = points.size() / 3;
  std::string text =
      "<?xml version=\"1.0\"?>\n"
      "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt32\" "
      "compressor=\"vtkZLibDataCompressor\">\n<UnstructuredGrid>\n";
  append_file_fields(fields.file_fields, text);
  text += "<Piece NumberOfPoints=\"" + std::to_string(point_count) + "\" NumberOfCells=\"" +
          std::to_string(cells.types.size()) + "\">\n<Points>\n";
  append_array({"Float64", "Points", 3}, bytes_of<double>(points), text);
  text += "</Points>\n<Cells>\n";
  append_cells(cells, text);
  text += "</Cells>\n<PointData>\n";
  append_fields(fields.point_fields, point_count, text);
  text += "</PointData>\n<CellData>\n";
  append_fields(fields.cell_fields, cells.types.size(), text);
  text += "</CellData>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n";
  write_file(path, text);
}

const char* type_name(FieldType type) {
  switch (type) {
    case FieldType::float64:
      return "Float64";
    case FieldType::float32:
      return "Float32";
    case FieldType::int32:
      return "Int32";
  }
  return "";
}

void declare_fields(const char* section, const std::vector<Field>& fields, std::string& text) {
  text += std::string("<") + section + ">\n";
  for (const Field& field : fields) {
    text += std::string("<PDataArray type=\"") + type_name(field.type) + "\" Name=\"" + xml_escaped(field.name) + "\"";
    if (field.components != 1) text += " NumberOfComponents=\"" + std::to_string(field.components) + "\"";
    text += "/>\n";
  }
  text += std::string("</") + section + ">\n";
}

}  // namespace

void write_pvtu(const std::string& path, const std::vector<std::string>& pieces, const VtuFields& fields) {
  std::string text =
      "<?xml version=\"1.0\"?>\n"
      "<VTKFile type=\"PUnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt32\" "
      "compressor=\"vtkZLibDataCompressor\">\n<PUnstructuredGrid GhostLevel=\"0\">\n";
  append_file_fields(fields.file_fields, text);
  text += "<PPoints>\n<PDataArray type=\"Float64\" Name=\"Points\" NumberOfComponents=\"3\"/>\n</PPoints>\n";
  declare_fields("PPointData", fields.point_fields, text);
  declare_fields("PCellData", fields.cell_fields, text);
  for (const std::string& piece : pieces) text += "<Piece Source=\"" + xml_escaped(piece) + "\"/>\n";
  text += "</PUnstructuredGrid>\n</VTKFile>\n";
  write_file(path, text);
}

void write_vtu(const std::string& path, std::span<const double> points, const TetMesh& mesh, const VtuFields& fields) {
  Cells cells;
  for (int e = 0; e < mesh.element_count(); ++e) {
    const TetNodes nodes = nodes_of(mesh, e);
    cells.add(nodes, nodes.count == 2   ? kVtkLine
                     : nodes.count == 3 ? kVtkTriangle
                     : nodes.count == 4 ? kVtkTet
                                        : kVtkQuadraticTet);
  }
  write(path, points, cells, fields);
}

void write_vtu(const std::string& path, std::span<const double> points, const std::vector<Tet>& tets,
               const VtuFields& fields) {
  write_vtu(path, points, TetMesh{.rest = {}, .tets = tets, .region = {}}, fields);
}

void write_surface_vtu(const std::string& path, const TriMesh& surface, const VtuFields& fields) {
  std::vector<double> points;
  for (const Vec3d& x : surface.vertices) points.insert(points.end(), x.a, x.a + 3);
  Cells cells;
  for (const Triangle& triangle : surface.triangles) cells.add(triangle, kVtkTriangle);
  write(path, points, cells, fields);
}

}  // namespace aspic
