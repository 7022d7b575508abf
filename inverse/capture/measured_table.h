// A table of measurements: columns under the names of the program that wrote it, units, blank cells. Errors are
// gathered, so that one pass reports them all.
#pragma once
#include <array>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "io/csv_reader.h"
#include "math/small.h"

namespace aspic {

// The first few errors of a data set, one per line.
class ErrorList {
 public:
  void add(const std::string& error);
  bool is_empty() const { return lines_.empty(); }
  void finish() const;  // throws InvalidInput when there is any

 private:
  std::vector<std::string> lines_;
  int further_ = 0;
};

struct ColumnNames {
  std::vector<std::string> known;                 // by Aspic's names
  std::map<std::string, std::string> as_written;  // what some of them are called in the file
};

class MeasuredTable {
 public:
  // Throws InvalidInput when the file cannot be read or a renamed column is not there. Columns that are not known are
  // noted when their name is near a known one.
  MeasuredTable(const std::filesystem::path& path, const ColumnNames& names, ErrorList& errors,
                std::vector<std::string>& notes);

  bool next();
  int line() const { return csv_.line(); }
  void error(const std::string& text);  // of this row

  bool has(std::string_view column) const { return index_.contains(column); }
  std::string text(std::string_view column) const;  // empty: blank, or no such column
  // None: blank, or no such column, or an error that was added: no number, not finite.
  std::optional<double> number(std::string_view column, double unit = 1);
  std::optional<int> integer(std::string_view column);
  std::optional<double> positive(std::string_view column, double unit = 1);
  // Of the columns "force_x", "force_y", "force_z" for "force_"; none: all are blank. Some are: an error.
  std::optional<Vec3d> vector(const std::string& prefix, double unit = 1);
  // Of one column for all directions, or of three: "force_sd", or "force_sd_x" and so on.
  std::optional<Vec3d> deviation(const std::string& name, double unit);
  // Of a name in a column; blank means the only one. -1: it is not known, an error.
  int index_of(const std::string& column, const std::map<std::string, int>& known);

 private:
  CsvReader csv_;
  ErrorList& errors_;
  std::map<std::string, size_t, std::less<>> index_;  // of columns, by Aspic's names
};

}  // namespace aspic
