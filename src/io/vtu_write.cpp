#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <utility>

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
constexpr size_t kSample = 1 << 13;     // bytes at the start of a block whose compression predicts that of the block
constexpr double kRepetitive = 0.7;     // compression ratio below which repeated strings are worth finding

// A file that is written array by array, so that its text need not fit into memory.
class VtuFile {
 public:
  explicit VtuFile(const std::string& path) : file_(path) {}
  void append(std::string_view text) {
    text_ += text;
    if (text_.size() >= kPiece) write();
  }
  void append_base64(std::string_view bytes) {
    for (size_t first = 0; first < bytes.size(); first += kPiece) {
      aspic::append_base64(bytes.substr(first, kPiece), text_);
      if (text_.size() >= kPiece) write();
    }
  }
  void commit() {
    write();
    file_.commit();
  }

 private:
  static constexpr size_t kPiece = 3 << 20;  // a multiple of 3, so that pieces of base64 need no padding

  void write() {
    file_.append(text_);
    text_.clear();
  }

  AtomicFile file_;
  std::string text_;  // to be written
};

std::string deflated(std::string_view bytes, int strategy) {
  z_stream stream{};
  std::string block;
  if (deflateInit2(&stream, Z_BEST_SPEED, Z_DEFLATED, MAX_WBITS, MAX_MEM_LEVEL, strategy) != Z_OK) return block;
  block.resize(deflateBound(&stream, bytes.size()));
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  stream.avail_in = static_cast<uInt>(bytes.size());
  stream.next_out = reinterpret_cast<Bytef*>(block.data());
  stream.avail_out = static_cast<uInt>(block.size());
  const int result = deflate(&stream, Z_FINISH);
  block.resize(result == Z_STREAM_END ? stream.total_out : 0);
  deflateEnd(&stream);
  return block;
}

// Mantissas of positions and stresses repeat no strings. Huffman codes alone then save as much, in a third of the time.
std::string deflated(std::string_view bytes) {
  const std::string_view sample = bytes.substr(0, kSample);
  std::string block = deflated(sample, Z_DEFAULT_STRATEGY);
  if (sample.size() == bytes.size()) return block;
  const bool is_repetitive = static_cast<double>(block.size()) < kRepetitive * static_cast<double>(sample.size());
  return deflated(bytes, is_repetitive ? Z_DEFAULT_STRATEGY : Z_HUFFMAN_ONLY);
}

template <class Stored, class Number>
std::string bytes_of(std::span<const Number> numbers) {
  std::string bytes(numbers.size() * sizeof(Stored), '\0');
  for (size_t i = 0; i < numbers.size(); ++i) {
    const auto stored = static_cast<Stored>(numbers[i]);
    std::memcpy(bytes.data() + i * sizeof(Stored), &stored, sizeof(Stored));
  }
  return bytes;
}

// [blocks][size of a block][size of the last block, 0: full][compressed size of each block] blocks
template <class Stored, class Number>
void append_compressed(std::span<const Number> numbers, VtuFile& file) {
  constexpr size_t kPerBlock = kBlockSize / sizeof(Stored);
  std::vector<std::string> block((numbers.size() + kPerBlock - 1) / kPerBlock);
  parallel_for(static_cast<int>(block.size()), [&](int i) {
    const size_t first = static_cast<size_t>(i) * kPerBlock;
    block[i] = deflated(bytes_of<Stored>(numbers.subspan(first, std::min(kPerBlock, numbers.size() - first))));
  });
  std::vector<uint32_t> header = {static_cast<uint32_t>(block.size()), kBlockSize,
                                  static_cast<uint32_t>(numbers.size() * sizeof(Stored) % kBlockSize)};
  size_t size = 0;
  for (const std::string& compressed : block) {
    if (compressed.empty()) throw InvalidInput("zlib could not compress the data (out of memory?)");
    header.push_back(static_cast<uint32_t>(compressed.size()));
    size += compressed.size();
  }
  std::string data;
  data.reserve(size);
  for (std::string& compressed : block) data += std::exchange(compressed, {});
  file.append_base64({reinterpret_cast<const char*>(header.data()), header.size() * 4});
  file.append_base64(data);
}

struct ArrayTag {
  std::string_view type, name;
  int components = 1;
  std::string attributes = "";
};

template <class Stored, class Number>
void append_array(const ArrayTag& tag, std::span<const Number> numbers, VtuFile& file) {
  std::string text = "<DataArray type=\"" + std::string(tag.type) + "\" Name=\"" + xml_escaped(tag.name) + "\"";
  // Omitted for scalars, which meshio would otherwise return as a column.
  if (tag.components != 1) text += " NumberOfComponents=\"" + std::to_string(tag.components) + "\"";
  text += tag.attributes + " format=\"binary\">\n";
  file.append(text);
  append_compressed<Stored>(numbers, file);
  file.append("\n</DataArray>\n");
}

void append_field(const Field& field, const std::string& attributes, VtuFile& file) {
  const std::span<const double> values = field.values;
  switch (field.type) {
    case FieldType::float64:
      return append_array<double>({"Float64", field.name, field.components, attributes}, values, file);
    case FieldType::float32:
      return append_array<float>({"Float32", field.name, field.components, attributes}, values, file);
    case FieldType::int32:
      return append_array<int32_t>({"Int32", field.name, field.components, attributes}, values, file);
  }
}

void append_fields(const std::vector<Field>& fields, [[maybe_unused]] size_t count, VtuFile& file) {
  for (const Field& field : fields) {
    ASPIC_CHECK(field.values.size() == count * static_cast<size_t>(field.components));
    append_field(field, "", file);
  }
}

void append_file_fields(const std::vector<Field>& fields, VtuFile& file) {
  if (fields.empty()) return;
  file.append("<FieldData>\n");
  for (const Field& field : fields) {
    const size_t tuples = field.values.size() / static_cast<size_t>(field.components);
    append_field(field, " NumberOfTuples=\"" + std::to_string(tuples) + "\"", file);
  }
  file.append("</FieldData>\n");
}

struct Cells {
  std::vector<int> connectivity;
  std::vector<int64_t> offsets;  // end of each cell in the connectivity
  std::vector<uint8_t> types;

  void reserve(size_t count) {
    connectivity.reserve(4 * count);
    offsets.reserve(count);
    types.reserve(count);
  }
  template <class Nodes>
  void add(const Nodes& nodes, uint8_t type) {
    for (const int node : nodes) connectivity.push_back(node);
    offsets.push_back(static_cast<int64_t>(connectivity.size()));
    types.push_back(type);
  }
};

void append_cells(const Cells& cells, VtuFile& file) {
  append_array<int32_t>({"Int32", "connectivity"}, std::span<const int>(cells.connectivity), file);
  append_array<int64_t>({"Int64", "offsets"}, std::span<const int64_t>(cells.offsets), file);
  append_array<uint8_t>({"UInt8", "types"}, std::span<const uint8_t>(cells.types), file);
}

void write(const std::string& path, std::span<const double> points, const Cells& cells, const VtuFields& fields) {
  const size_t point_count = points.size() / 3;
  VtuFile file(path);
  file.append(
      "<?xml version=\"1.0\"?>\n"
      "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt32\" "
      "compressor=\"vtkZLibDataCompressor\">\n<UnstructuredGrid>\n");
  append_file_fields(fields.file_fields, file);
  file.append("<Piece NumberOfPoints=\"" + std::to_string(point_count) + "\" NumberOfCells=\"" +
              std::to_string(cells.types.size()) + "\">\n<Points>\n");
  append_array<double>({"Float64", "Points", 3}, points, file);
  file.append("</Points>\n<Cells>\n");
  append_cells(cells, file);
  file.append("</Cells>\n<PointData>\n");
  append_fields(fields.point_fields, point_count, file);
  file.append("</PointData>\n<CellData>\n");
  append_fields(fields.cell_fields, cells.types.size(), file);
  file.append("</CellData>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n");
  file.commit();
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
  VtuFile file(path);
  file.append(
      "<?xml version=\"1.0\"?>\n"
      "<VTKFile type=\"PUnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt32\" "
      "compressor=\"vtkZLibDataCompressor\">\n<PUnstructuredGrid GhostLevel=\"0\">\n");
  append_file_fields(fields.file_fields, file);
  std::string text = "<PPoints>\n<PDataArray type=\"Float64\" Name=\"Points\" NumberOfComponents=\"3\"/>\n</PPoints>\n";
  declare_fields("PPointData", fields.point_fields, text);
  declare_fields("PCellData", fields.cell_fields, text);
  for (const std::string& piece : pieces) text += "<Piece Source=\"" + xml_escaped(piece) + "\"/>\n";
  text += "</PUnstructuredGrid>\n</VTKFile>\n";
  file.append(text);
  file.commit();
}

void write_vtu(const std::string& path, std::span<const double> points, const TetMesh& mesh, const VtuFields& fields) {
  Cells cells;
  cells.reserve(static_cast<size_t>(mesh.element_count()));
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
