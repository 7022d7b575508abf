// Frames of several processes: an index (.pvtu) of pieces, whose fields "vertex" and "tet" number points and cells.
#include <algorithm>
#include <filesystem>

#include "base/error.h"
#include "io/atomic_file.h"
#include "io/vtu.h"
#include "io/vtu_array.h"

namespace aspic {
namespace {

namespace fs = std::filesystem;

struct PieceFile {
  std::string file;
  Vtu grid;
  std::vector<size_t> vertex, tet;  // numbers in the whole
};

[[noreturn]] void fail_piece(const std::string& file, const std::string& problem) {
  throw InvalidInput(file + ": " + problem + "; run the scene again, or open the pieces in ParaView");
}

// Returns the numbers of a piece, which must be below `limit`, and removes their field.
std::vector<size_t> take_numbers(const std::string& file, const std::string& name, size_t limit,
                                 std::vector<Field>& fields) {
  const auto field = std::find_if(fields.begin(), fields.end(), [&](const Field& f) { return f.name == name; });
  if (field == fields.end() || field->components != 1) fail_piece(file, "has no field '" + name + "' of numbers");
  std::vector<size_t> numbers;
  for (const double value : field->values) {
    if (!(value >= 0 && value < static_cast<double>(limit)))
      fail_piece(file, "the field '" + name + "' has the value " + std::to_string(value) + ", but all pieces have " +
                           std::to_string(limit));
    numbers.push_back(static_cast<size_t>(value));
  }
  fields.erase(field);
  return numbers;
}

std::vector<std::string> pvtu_pieces(const std::string& path) {
  const std::string contents = read_file(path);
  const XmlElement root = parse_xml(contents, path, "AppendedData");
  const VtkFile file = vtk_file(root, "PUnstructuredGrid", path);
  std::vector<std::string> pieces;
  if (const XmlElement* grid = root.child("PUnstructuredGrid"))
    for (const XmlElement& piece : grid->children) {
      if (piece.name != "Piece") continue;
      const std::string* source = piece.attribute("Source");
      if (!source || fs::path(*source).has_parent_path() || *source == "..")
        fail_at(file, piece, "a piece needs a Source in the same folder");
      pieces.push_back((fs::path(path).parent_path() / *source).string());
    }
  if (pieces.empty()) throw InvalidInput(path + ": names no pieces; run the scene again");
  return pieces;
}

std::vector<PieceFile> read_pieces(const std::string& path) {
  std::vector<PieceFile> pieces;
  size_t points = 0, tets = 0;
  for (std::string& file : pvtu_pieces(path)) {
    PieceFile& piece = pieces.emplace_back(PieceFile{std::move(file), {}, {}, {}});
    piece.grid = read_vtu(piece.file);
    points += piece.grid.mesh.rest.size();
    tets += piece.grid.mesh.tets.size();
    // Without tets, points are those of a surface.
    points += piece.grid.triangles.vertices.size();
  }
  for (PieceFile& piece : pieces) {
    TetMesh& mesh = piece.grid.mesh;
    if (mesh.rest.empty()) mesh.rest = std::move(piece.grid.triangles.vertices);
    piece.vertex = take_numbers(piece.file, "vertex", points, piece.grid.point_fields);
    piece.tet = take_numbers(piece.file, "tet", tets, piece.grid.cell_fields);
    for (Tet& corners : mesh.tets)
      for (int& v : corners) v = static_cast<int>(piece.vertex[v]);
  }
  return pieces;
}

// Copies the values of a piece, `width` each, to their places.
template <class T>
void put(const std::vector<T>& values, const std::vector<size_t>& place, size_t width, std::vector<T>& all) {
  for (size_t i = 0; i < values.size(); ++i) {
    const size_t to = width * place[i / width] + i % width;
    if (to >= all.size()) all.resize(to + 1);
    all[to] = values[i];
  }
}

void put_fields(const PieceFile& piece, const std::vector<size_t>& place, const std::vector<Field>& fields,
                std::vector<Field>& all) {
  const bool is_alike =
      std::equal(fields.begin(), fields.end(), all.begin(), all.end(),
                 [](const Field& a, const Field& b) { return a.name == b.name && a.components == b.components; });
  if (!is_alike) fail_piece(piece.file, "has other fields than the first piece");
  for (size_t f = 0; f < fields.size(); ++f)
    put(fields[f].values, place, static_cast<size_t>(all[f].components), all[f].values);
}

// Throws unless the numbers of the pieces are 0, 1, 2, ... without gaps.
void require_all(const std::string& path, const std::vector<PieceFile>& pieces, std::vector<size_t> PieceFile::*numbers,
                 const char* what) {
  std::vector<char> found;
  for (const PieceFile& piece : pieces) put(std::vector<char>((piece.*numbers).size(), 1), piece.*numbers, 1, found);
  const auto missing = std::find(found.begin(), found.end(), 0);
  if (missing != found.end())
    fail_piece(path, std::string("no piece has the ") + what + " " + std::to_string(missing - found.begin()));
}

std::vector<Field> without_values(const std::vector<Field>& fields) {
  std::vector<Field> result;
  for (const Field& field : fields) result.push_back({field.name, field.components, {}, field.type});
  return result;
}

}  // namespace

Vtu read_pvtu(const std::string& path) {
  const std::vector<PieceFile> pieces = read_pieces(path);
  require_all(path, pieces, &PieceFile::vertex, "vertex");
  require_all(path, pieces, &PieceFile::tet, "tet");
  Vtu whole;
  whole.file_fields = pieces[0].grid.file_fields;
  whole.point_fields = without_values(pieces[0].grid.point_fields);
  whole.cell_fields = without_values(pieces[0].grid.cell_fields);
  for (const PieceFile& piece : pieces) {
    put(piece.grid.mesh.rest, piece.vertex, 1, whole.mesh.rest);
    put(piece.grid.mesh.tets, piece.tet, 1, whole.mesh.tets);
    put(piece.grid.mesh.region, piece.tet, 1, whole.mesh.region);
    put_fields(piece, piece.vertex, piece.grid.point_fields, whole.point_fields);
    put_fields(piece, piece.tet, piece.grid.cell_fields, whole.cell_fields);
  }
  return whole;
}

Vtu read_frame(const std::string& path) {
  return fs::path(path).extension() == ".pvtu" ? read_pvtu(path) : read_vtu(path);
}

}  // namespace aspic
