#include "io/legacy_vtk.h"

#include <algorithm>
#include <array>
#include <limits>
#include <map>

#include "base/error.h"
#include "io/atomic_file.h"
#include "io/legacy_vtk_array.h"
#include "io/vtk_cells.h"

namespace aspic {
namespace {

constexpr int64_t kMost = std::numeric_limits<int>::max() / 4;  // items of an array
constexpr int64_t kMostComponents = 1024;

// The arrays of polygonal data, in the order of its cells; those of an unstructured grid are the first.
struct CellArray {
  std::string_view keyword;
  int64_t type;  // of all cells; 0: the section CELL_TYPES
};
constexpr std::array<CellArray, 5> kCellArrays = {{{"cells", 0},
                                                   {"vertices", kVtkPolyVertex},
                                                   {"lines", kVtkPolyLine},
                                                   {"polygons", kVtkPolygon},
                                                   {"triangle_strips", kVtkStrip}}};

// Attributes with a fixed number of components.
const std::map<std::string_view, int>& attributes() {
  static const std::map<std::string_view, int> components = {{"vectors", 3},   {"normals", 3},    {"tensors", 9},
                                                             {"tensors6", 6},  {"global_ids", 1}, {"pedigree_ids", 1},
                                                             {"edge_flags", 1}};
  return components;
}

class LegacyVtkReader {
 public:
  LegacyVtkReader(std::string_view contents, const std::string& file) : in_(file, contents), text_(in_.text()) {}

  Vtu read() {
    read_head();
    while (!text_.at_end()) read_section(lower_case(text_.word("a section")));
    join_cells();
    const bool has_tets = piece_.has_tets();
    append_piece(std::move(piece_), has_tets, true, grid_);
    fail_if(finish_grid(grid_), place_of_cell_fields_);
    return std::move(grid_);
  }

 private:
  struct Cells {
    size_t place = 0;  // of the keyword
    std::vector<int64_t> offsets, connectivity;
  };

  // "# vtk DataFile Version 3.0", a title, "ASCII" or "BINARY".
  void read_head() {
    const std::string_view first = text_.word("'# vtk DataFile Version'");
    if (first != "#" || next_word() != "vtk")
      text_.fail("found " + shown(first) + " where '# vtk DataFile Version' should be; is this a legacy VTK file?");
    text_.skip_line();
    text_.skip_line();
    const std::string_view encoding = text_.word("'ASCII' or 'BINARY'");
    if (lower_case(encoding) == "binary")
      in_.set_binary();
    else if (lower_case(encoding) != "ascii")
      text_.fail("the third line is " + shown(encoding) + "; it must be ASCII or BINARY");
  }

  // The next word in lower case. Unlike peek(), keeps the line, behind which binary data may begin.
  std::string next_word() {
    const size_t here = text_.position();
    std::string word = lower_case(text_.peek());
    text_.seek(here);
    return word;
  }

  void read_section(const std::string& keyword) {
    for (size_t i = 0; i < kCellArrays.size(); ++i)
      if (keyword == kCellArrays[i].keyword) return read_cells(cells_[i]);
    if (keyword == "dataset") return check_kind(lower_case(text_.word("the kind of the grid")));
    if (keyword == "points") return read_points();
    if (keyword == "cell_types") return read_types();
    if (keyword == "point_data") return begin_fields(piece_.point_fields, piece_.points());
    if (keyword == "cell_data") place_of_cell_fields_ = text_.word_position();
    if (keyword == "cell_data") return begin_fields(piece_.cell_fields, cell_count());
    if (keyword == "metadata") return skip_metadata();
    if (keyword == "field") return read_field_arrays();
    read_attribute(keyword);
  }

  void check_kind(const std::string& kind) {
    if (kind == "unstructured_grid" || kind == "polydata") return;
    text_.fail("the grid is " + shown(kind) +
               "; only UNSTRUCTURED_GRID and POLYDATA are read (in ParaView: Tetrahedralize, then save it as .vtu)");
  }

  void read_points() {
    if (!piece_.positions.empty()) text_.fail("a second section POINTS; merge it with the first");
    const int64_t points = bounded(text_.integer("the number of points"), kMost, "the number of points");
    const LegacyVtkType& type = in_.type();
    const size_t place = text_.word_position();
    piece_.positions = in_.reals(type, 3 * points);
    fail_if(fault_of_positions(piece_.positions), place);
  }

  // Up to version 4: "cells size", then the number of corners and the corners of each cell. Since version 5: the
  // numbers of offsets and corners, then both arrays.
  void read_cells(Cells& cells) {
    cells.place = text_.word_position();
    if (!cells.offsets.empty()) text_.fail("a second section of these cells; merge it with the first");
    const int64_t count = bounded(text_.integer("the number of cells"), kMost, "the number of cells");
    const int64_t size = bounded(text_.integer("the size of the cells"), kMost, "the size of the cells");
    if (next_word() == "offsets")
      read_offsets(count, size, cells);
    else
      split_cells(in_.integers(legacy_vtk_int(), size), static_cast<size_t>(count), cells);
  }

  void read_offsets(int64_t count, int64_t size, Cells& cells) {
    text_.word("OFFSETS");
    const LegacyVtkType& type = in_.type();
    cells.offsets = in_.integers(type, count);
    if (const std::string_view word = text_.word("CONNECTIVITY"); lower_case(word) != "connectivity")
      text_.fail("found " + shown(word) + " where CONNECTIVITY should be; the counts do not fit the file");
    const LegacyVtkType& type_of_corners = in_.type();
    cells.connectivity = in_.integers(type_of_corners, size);
    if (cells.offsets.empty()) return;
    fail_if(cells.offsets.front() == 0 ? "" : "the first offset is not 0; get a complete copy", cells.place);
    fail_if(std::is_sorted(cells.offsets.begin(), cells.offsets.end())
                ? ""
                : "the offsets of the cells do not ascend; get a complete copy",
            cells.place);
    fail_if(cells.offsets.back() == size ? "" : "the last offset is not the number of corners; get a complete copy",
            cells.place);
    cells.offsets.erase(cells.offsets.begin());
  }

  void split_cells(const std::vector<int64_t>& numbers, size_t count, Cells& cells) {
    for (size_t at = 0; at < numbers.size();) {
      const int64_t corners = numbers[at++];
      if (corners < 0 || corners > static_cast<int64_t>(numbers.size() - at))
        fail_if("cell " + std::to_string(cells.offsets.size()) + " has " + std::to_string(corners) +
                    " corners, more than the section holds; get a complete copy",
                cells.place);
      for (int64_t i = 0; i < corners; ++i) cells.connectivity.push_back(numbers[at++]);
      cells.offsets.push_back(static_cast<int64_t>(cells.connectivity.size()));
    }
    if (cells.offsets.size() != count)
      fail_if("the section states " + std::to_string(count) + " cells, but holds " +
                  std::to_string(cells.offsets.size()) + "; get a complete copy",
              cells.place);
  }

  void read_types() {
    const int64_t count = bounded(text_.integer("the number of cell types"), kMost, "the number of cell types");
    types_ = in_.integers(legacy_vtk_int(), count);
  }

  size_t cell_count() const {
    size_t count = 0;
    for (const Cells& cells : cells_) count += cells.offsets.size();
    return count;
  }

  // Polygonal data numbers its cells through its arrays.
  void join_cells() {
    for (size_t i = 0; i < kCellArrays.size(); ++i) {
      const Cells& cells = cells_[i];
      const size_t before = piece_.types.size(), count = cells.offsets.size();
      if (kCellArrays[i].type != 0) {
        piece_.types.resize(before + count, kCellArrays[i].type);
      } else {
        if (types_.size() != count)
          fail_if("there are " + std::to_string(count) + " cells, but CELL_TYPES has " + std::to_string(types_.size()) +
                      "; get a complete copy",
                  cells.place);
        piece_.types = std::move(types_);
      }
      const auto corners = static_cast<int64_t>(piece_.connectivity.size());
      for (const int64_t end : cells.offsets) piece_.offsets.push_back(corners + end);
      piece_.connectivity.insert(piece_.connectivity.end(), cells.connectivity.begin(), cells.connectivity.end());
      fail_if(fault_of_cells(piece_), cells.place);
    }
  }

  // Ends with an empty line.
  void skip_metadata() {
    text_.skip_line();
    while (!text_.at_line_end()) text_.skip_line();
  }

  void begin_fields(std::vector<Field>& fields, size_t count) {
    const int64_t stated = text_.integer("the number of values");
    if (stated != static_cast<int64_t>(count))
      text_.fail("the fields have " + std::to_string(stated) + " values where " + std::to_string(count) +
                 " are needed; get a complete copy");
    fields_ = &fields;
    values_ = stated;
  }

  // "FIELD name arrays", then "name components tuples type" and the numbers of each.
  void read_field_arrays() {
    text_.word("the name of a field");
    for (int arrays = text_.count("the number of arrays", 4); arrays > 0; --arrays) {
      while (next_word() == "metadata") {
        text_.word("METADATA");
        skip_metadata();
      }
      const std::string name = in_.name();
      if (name == "NULL_ARRAY") continue;
      const int components = static_cast<int>(
          bounded(text_.integer("the number of components"), kMostComponents, "the number of components"));
      const int64_t tuples = bounded(text_.integer("the number of tuples"), kMost, "the number of tuples");
      const LegacyVtkType& type = in_.type();
      if (fields_ && tuples != values_)
        text_.fail("array '" + name + "' has " + std::to_string(tuples) + " values where " + std::to_string(values_) +
                   " are needed; get a complete copy");
      add_field(fields_ ? *fields_ : grid_.file_fields, {name, components, {}, type.field}, type, tuples);
    }
  }

  void add_field(std::vector<Field>& fields, Field field, const LegacyVtkType& type, int64_t tuples) {
    const int64_t count = field.components * tuples;
    if (type.name == "string") return in_.skip_texts(count);
    if (type.name == "bit") return in_.skip_bits(count);
    if (count > 0) field.values = in_.reals(type, count);
    if (field.components > 0) fields.push_back(std::move(field));
  }

  int components_on_line(int usual) {
    if (text_.at_line_end()) return usual;
    return static_cast<int>(
        bounded(text_.integer("the number of components"), kMostComponents, "the number of components"));
  }

  void read_attribute(const std::string& keyword) {
    const auto known = attributes().find(keyword);
    const bool is_scalars = keyword == "scalars", is_colors = keyword == "color_scalars",
               is_table = keyword == "lookup_table", is_texture = keyword == "texture_coordinates";
    if (known == attributes().end() && !is_scalars && !is_colors && !is_table && !is_texture)
      text_.fail("unknown section " + shown(keyword) + "; the counts do not fit the file, or it is no legacy VTK file");
    if (!fields_) text_.fail(shown(keyword) + " comes before POINT_DATA and CELL_DATA; put it behind one of them");
    const std::string name = in_.name();
    if (is_table) {
      const int64_t colors = bounded(text_.integer("the number of colors"), kMost, "the number of colors");
      in_.reals(legacy_vtk_color(), 4 * colors);
      return;
    }
    if (is_colors) return add_field(*fields_, {name, components_on_line(3), {}}, legacy_vtk_color(), values_);
    int components = is_texture ? components_on_line(2) : is_scalars ? 1 : known->second;
    const LegacyVtkType& type = in_.type();
    if (is_scalars) {
      components = components_on_line(1);
      if (next_word() == "lookup_table") {
        text_.word("LOOKUP_TABLE");
        text_.word("the name of a table");
      }
    }
    add_field(*fields_, {name, components, {}, type.field}, type, values_);
  }

  void fail_if(const std::string& fault, size_t place) {
    if (fault.empty()) return;
    text_.blame(place);
    text_.fail(fault);
  }

  int64_t bounded(int64_t value, int64_t most, const std::string& what) const {
    if (value < 0 || value > most)
      text_.fail(what + " is " + std::to_string(value) + "; it must be from 0 to " + std::to_string(most));
    return value;
  }

  LegacyVtkSource in_;
  TextScanner& text_;
  std::array<Cells, kCellArrays.size()> cells_;
  std::vector<int64_t> types_;
  VtkPiece piece_;
  Vtu grid_;
  std::vector<Field>* fields_ = nullptr;  // those of points or cells; null: of the file
  int64_t values_ = 0;                    // per component of `fields_`
  size_t place_of_cell_fields_ = 0;
};

}  // namespace

Vtu parse_legacy_vtk(std::string_view contents, const std::string& file) {
  return LegacyVtkReader(contents, file).read();
}

bool is_vtk_or_vtu(const std::filesystem::path& path) {
  const std::string extension = lower_case(path.extension().string());
  return extension == ".vtk" || extension == ".vtu";
}

Vtu read_vtk_or_vtu(const std::string& path) {
  const std::string extension = lower_case(std::filesystem::path(path).extension().string());
  return extension == ".vtk" ? parse_legacy_vtk(read_file(path), path) : read_vtu(path);
}

}  // namespace aspic
