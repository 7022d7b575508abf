// Tables as comma-separated values, read row by row: a long table never lies in memory as a whole.
#pragma once
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace aspic {

// Who wrote a table: Aspic, or a spreadsheet or measuring program. Of the latter, the cells may be apart by semicolons
// (the decimal sign is then a comma, or a point) or tabs, with blanks around them; empty lines and lines that begin
// with # are skipped; the last line needs no line break; a byte order mark is no part of the first name.
enum class CsvOrigin { aspic, foreign };

// Cells and names are printable (base/printable.h), whatever the bytes of the file.
class CsvReader {
 public:
  // Throws InvalidInput when it cannot be read.
  explicit CsvReader(const std::filesystem::path& path, CsvOrigin origin = CsvOrigin::aspic);

  const std::vector<std::string>& columns() const { return columns_; }  // of the head
  bool has(std::string_view column) const;
  size_t column(std::string_view name) const;  // its index; throws InvalidInput

  // The next row; false after the last whole one: a torn last line, without a line break, is no row of Aspic's. Throws
  // InvalidInput for a row with another number of cells than the head.
  bool next();
  int line() const { return line_; }  // of the row, from 1
  std::string where() const;          // "markers.csv:12"
  bool is_blank(size_t column) const { return cells_[column].empty(); }
  const std::string& text(size_t column) const { return cells_[column]; }
  double number(size_t column) const;  // may be infinite or nan; throws InvalidInput for anything else
  int integer(size_t column) const;
  std::optional<double> try_number(size_t column) const;  // none: no number

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
