#include "recording/dic_tables.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>

#include "base/error.h"
#include "base/printable.h"
#include "io/csv_reader.h"
#include "recording/formats.h"

namespace aspic {
namespace {

namespace fs = std::filesystem;

constexpr double kLost = std::numeric_limits<double>::quiet_NaN();
constexpr Vec3d kLostPoint = {{kLost, kLost, kLost}};

// The more specific dialects come first.
const std::vector<DicDialect>& dialects() {
  static const std::vector<DicDialect> table = {
      {.program = "DICe (stereo)",
       .coordinates = {"MODEL_COORDINATES_X", "MODEL_COORDINATES_Y", "MODEL_COORDINATES_Z"},
       .displacements = {"MODEL_DISPLACEMENT_X", "MODEL_DISPLACEMENT_Y", "MODEL_DISPLACEMENT_Z"},
       .name = "SUBSET_ID",
       .failed = "SIGMA"},
      {.program = "DICe (2D)",
       .coordinates = {"COORDINATE_X", "COORDINATE_Y"},
       .displacements = {"DISPLACEMENT_X", "DISPLACEMENT_Y"},
       .name = "SUBSET_ID",
       .failed = "SIGMA"},
      {.program = "pyvale (stereo)",
       .coordinates = {"stereo_x_mm", "stereo_y_mm", "stereo_z_mm"},
       .displacements = {"stereo_disp_u_mm", "stereo_disp_v_mm", "stereo_disp_w_mm"},
       .failed = "stereo_converged",
       .is_flag = true,
       .is_current = true,
       .unit = 1e-3},
      {.program = "pyvale (2D)",
       .coordinates = {"subset_x", "subset_y"},
       .displacements = {"disp_u", "disp_v"},
       .failed = "converged",
       .is_flag = true},
      {.program = "pyvale (2D, displacement_u)",  // earlier versions
       .coordinates = {"subset_x", "subset_y"},
       .displacements = {"displacement_u", "displacement_v"},
       .failed = "converged",
       .is_flag = true},
      {.program = "x, y, z, ux, uy, uz",
       .coordinates = {"x", "y", "z"},
       .displacements = {"ux", "uy", "uz"},
       .name = "id"},
      {.program = "muDIC", .coordinates = {"x", "y"}, .displacements = {"ux", "uy"}, .name = "id", .is_current = true},
      {.program = "X, Y, Z, U, V, W",
       .coordinates = {"X", "Y", "Z"},
       .displacements = {"U", "V", "W"},
       .name = "id",
       .failed = "sigma"}};
  return table;
}

// Required columns of a dialect that a table has, or lacks.
struct Columns {
  size_t present = 0;
  std::vector<std::string> missing;
};

Columns compared(const std::vector<std::string>& columns, const DicDialect& dialect) {
  Columns result;
  for (const auto* names : {&dialect.coordinates, &dialect.displacements})
    for (const char* name : *names) {
      if (std::find(columns.begin(), columns.end(), name) != columns.end())
        ++result.present;
      else
        result.missing.emplace_back(name);
    }
  return result;
}

// Names the columns that are missing for the dialect with the most columns in common; empty without common columns.
std::string missing_columns(const std::vector<std::string>& columns) {
  size_t most = 0;
  std::string text;
  for (const DicDialect& dialect : dialects()) {
    const Columns own = compared(columns, dialect);
    if (own.present <= most) continue;
    most = own.present;
    text.clear();
    for (const std::string& name : own.missing) text += (text.empty() ? "" : ", ") + name;
    text = std::string("; for a table of ") + dialect.program + " it lacks " + text;
  }
  return text;
}

// One table: the points of a frame.
class DicTable {
 public:
  DicTable(const fs::path& path, const DicDialect& dialect) : csv_(path, CsvOrigin::foreign), dialect_(dialect) {
    for (const auto* names : {&dialect.coordinates, &dialect.displacements})
      for (const char* name : *names) columns_.push_back(csv_.column(name));
    if (csv_.has(dialect.name)) name_ = csv_.column(dialect.name);
    if (csv_.has(dialect.failed)) failed_ = csv_.column(dialect.failed);
  }

  bool next() { return csv_.next() && ++row_; }
  // DICe writes whole numbers as 1.000E+00.
  std::string name() const {
    if (!name_) return std::to_string(row_);
    const std::string& text = csv_.text(*name_);
    const std::optional<double> number = csv_.try_number(*name_);
    const bool is_whole = number && *number == std::floor(*number) && std::abs(*number) < 2e9;
    return is_whole && text.find_first_of(".eE") != std::string::npos ? std::to_string(static_cast<int>(*number))
                                                                      : text;
  }
  std::string where() const { return printable(csv_.where()); }

  // Position at rest and in this frame; not seen if the correlation failed.
  std::pair<Vec3d, Vec3d> positions() const {
    const size_t axes = dialect_.coordinates.size();
    Vec3d stated{}, u{};
    for (size_t i = 0; i < axes; ++i) {
      stated[static_cast<int>(i)] = number(columns_[i]);
      u[static_cast<int>(i)] = number(columns_[axes + i]);
    }
    if (has_failed() || !is_seen(u) || !is_seen(stated)) {
      const bool is_rest_known = !dialect_.is_current && is_seen(stated);
      return {is_rest_known ? stated : kLostPoint, kLostPoint};
    }
    return dialect_.is_current ? std::pair(stated - u, stated) : std::pair(stated, stated + u);
  }

 private:
  bool has_failed() const {
    if (!failed_) return false;
    const double value = number(*failed_);
    return dialect_.is_flag ? !(value > 0) : !(value >= 0);
  }

  double number(size_t column) const {
    if (csv_.is_blank(column)) return kLost;
    const std::optional<double> value = csv_.try_number(column);
    if (!value)
      throw InvalidInput(where() + ": " + csv_.columns()[column] + " = " + shown(csv_.text(column)) +
                         " is not a number; leave the cell blank if the point was lost");
    return std::isfinite(*value) ? *value : kLost;
  }

  CsvReader csv_;
  const DicDialect& dialect_;
  std::vector<size_t> columns_;
  std::optional<size_t> name_, failed_;
  size_t row_ = 0;
};

class DicReader {
 public:
  Recording read(const std::vector<fs::path>& files) {
    recording_.file = printable(files[0].string());
    recording_.frames.push_back({0, 0, recording_.file + " (reference)", {}});
    for (const fs::path& file : files) read_table(file);
    for (RecordedFrame& frame : recording_.frames) frame.positions.resize(recording_.names.size(), kLostPoint);
    check_recording(recording_, bytes_);
    return std::move(recording_);
  }

 private:
  const DicDialect& dialect_in(const fs::path& file) {
    const CsvReader csv(file, CsvOrigin::foreign);
    const DicDialect* dialect = dialect_of(csv.columns());
    if (!dialect)
      throw InvalidInput(csv.where() + ": is no table of image correlation" + missing_columns(csv.columns()) +
                         "; known are those of DICe, pyvale and muDIC, and tables with the columns X, Y, Z, U, V, W");
    return *dialect;
  }

  void read_table(const fs::path& file) {
    const DicDialect& dialect = dialect_in(file);
    if (recording_.frames.size() == 1) {
      recording_.is_planar = dialect.coordinates.size() == 2;
      if (dialect.unit > 0) recording_.unit = dialect.unit;
      first_ = &dialect;
      recording_.notes.push_back(recording_.file + ": results of " + dialect.program + "; frame 0 is the reference");
    } else if (first_ != &dialect) {
      throw InvalidInput(file.string() + ":1: has the columns of " + dialect.program +
                         ", but the first file those of " + first_->program + "; export all frames alike");
    }
    std::error_code error;
    bytes_ += static_cast<size_t>(fs::file_size(file, error));
    const int number = static_cast<int>(recording_.frames.size());
    recording_.frames.push_back({number, 0, printable(file.string()), {}});
    DicTable table(file, dialect);
    for (size_t row = 0; table.next(); ++row) add_row(table, row);
    check_density(recording_.frames.size() - 1, recording_.names.size(), bytes_, recording_.frames.back().where);
  }

  void add_row(const DicTable& table, size_t row) {
    std::vector<Vec3d>& rest = recording_.frames.front().positions;
    std::vector<Vec3d>& now = recording_.frames.back().positions;
    const size_t point = index_of(table.name(), row);
    rest.resize(std::max(rest.size(), point + 1), kLostPoint);
    now.resize(std::max(now.size(), point + 1), kLostPoint);
    const auto [X, x] = table.positions();
    if (is_seen(now[point]))
      throw InvalidInput(table.where() + ": the point '" + table.name() + "' is there twice; remove one");
    if (!is_seen(rest[point])) rest[point] = X;
    now[point] = x;
  }

  size_t index_of(const std::string& name, size_t row) {
    if (row < recording_.names.size() && recording_.names[row] == name) return row;  // as in the first file
    const auto [found, is_new] = index_.try_emplace(name, recording_.names.size());
    if (is_new) recording_.names.push_back(name);
    return found->second;
  }

  Recording recording_;
  const DicDialect* first_ = nullptr;
  size_t bytes_ = 0;
  std::unordered_map<std::string, size_t> index_;
};

}  // namespace

const DicDialect* dialect_of(const std::vector<std::string>& columns) {
  for (const DicDialect& dialect : dialects())
    if (compared(columns, dialect).missing.empty()) return &dialect;
  return nullptr;
}

Recording read_dic_tables(const std::vector<fs::path>& files) { return DicReader().read(files); }

}  // namespace aspic
