// Reads tables of comma-separated values row by row, without holding a table in memory.
#pragma once
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace aspic {

// Origin of a table: Aspic, or another program. Foreign tables may separate cells by semicolons (with decimal commas or
// points) or tabs, with blanks around them. Their empty lines, lines that begin with # and lines above the header that
// begin with *** (DICe) are skipped, the last line needs no line break, and a byte order mark is ignored.
enum class CsvOrigin { aspic, foreign };

// Cells and column names are printable (base/printable.h) for any bytes in the file.
class CsvReader {
 public:
  // Throws InvalidInput if the file cannot be read.
  explicit CsvReader(const std::filesystem::path& path, CsvOrigin origin = CsvOrigin::aspic);

  const std::vector<std::string>& columns() const { return columns_; }  // column names of the header
  bool has(std::string_view column) const;
  size_t column(std::string_view name) const;  // index of a column; throws InvalidInput if missing
  std::string column_list() const;             // the first names, for messages

  // Reads the next row; false after the last complete one. In tables of Aspic a last line without a line break is
  // incomplete. Throws InvalidInput if the number of cells differs from the header.
  bool next();
  int line() const { return line_; }  // line of the row, from 1
  std::string where() const;          // "markers.csv:12"
  bool is_blank(size_t column) const { return cells_[column].empty(); }
  const std::string& text(size_t column) const { return cells_[column]; }
  double number(size_t column) const;  // may be infinite or NaN; throws InvalidInput if it is no number
  int integer(size_t column) const;
  std::optional<double> try_number(size_t column) const;  // empty if it is no number

 private:
  bool read_text(std::string& line);
  bool read_line();
  void choose_separator(const std::string& head);
  [[noreturn]] void fail(size_t column, const char* expected) const;

  std::filesystem::path path_;
  std::ifstream in_;
  std::vector<std::string> columns_, cells_;
  CsvOrigin origin_;
  char separator_ = ',';
  int line_ = 0;
};

}  // namespace aspic
