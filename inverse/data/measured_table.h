// Table of measurements with renamed columns, units and blank cells. Collects errors, so that one pass reports all of
// them.
#pragma once
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
  void finish() const;  // throws InvalidInput if there are errors

 private:
  std::vector<std::string> lines_;
  int further_ = 0;
};

struct ColumnNames {
  std::vector<std::string> known;                 // Aspic's names
  std::map<std::string, std::string> as_written;  // names of some of them in the file
};

enum class MissingColumn { refused, zero };

class MeasuredTable {
 public:
  // Throws InvalidInput if the file cannot be read or a renamed column is missing. Notes unknown columns whose names
  // are close to a known one.
  MeasuredTable(const std::filesystem::path& path, const ColumnNames& names, ErrorList& errors,
                std::vector<std::string>& notes);

  bool next();
  int line() const { return csv_.line(); }
  std::string where() const { return csv_.where(); }
  void error(const std::string& text);  // error in this row

  bool has(std::string_view column) const { return index_.contains(column); }
  bool is_blank(std::string_view column) const;            // or no such column
  const std::string& text(std::string_view column) const;  // empty: blank or no such column
  // Empty if blank, if there is no such column, or after adding an error: not a number, or not finite.
  std::optional<double> number(std::string_view column, double unit = 1);
  std::optional<int> integer(std::string_view column);
  std::optional<double> positive(std::string_view column, double unit = 1);
  // Reads columns "force_x", "force_y", "force_z" for "force_"; empty if all are blank; an error if only some are, or
  // if a column is missing and does not count as 0.
  std::optional<Vec3d> vector(const std::string& prefix, double unit = 1,
                              MissingColumn missing = MissingColumn::refused);
  // Axis whose column is the only one of the three, such as 2 of "force_z"; -1: there are several, or none.
  int only_axis(const std::string& prefix) const;
  // Reads one column for all directions, or three: "force_sd", or "force_sd_x" and so on.
  std::optional<Vec3d> sigma(const std::string& name, double unit);
  // Index of a name in a column; blank selects the only one. -1 after adding an error: unknown.
  int index_of(const std::string& column, const std::map<std::string, int>& known);

 private:
  CsvReader csv_;
  ErrorList& errors_;
  std::map<std::string, size_t, std::less<>> index_;  // column indices by Aspic's names
};

}  // namespace aspic
