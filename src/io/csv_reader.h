// Tables as comma-separated values, read row by row: a long table never lies in memory as a whole.
#pragma once
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

namespace aspic {

class CsvReader {
 public:
  explicit CsvReader(const std::filesystem::path& path);  // throws InvalidInput when it cannot be read

  const std::vector<std::string>& columns() const { return columns_; }  // of the head
  bool has(std::string_view column) const;
  size_t column(std::string_view name) const;  // its index; throws InvalidInput

  // The next row; false after the last whole one: a torn last line, without a line break, is no row. Throws
  // InvalidInput for a row with another number of cells than the head.
  bool next();
  const std::string& text(size_t column) const { return cells_[column]; }
  double number(size_t column) const;  // may be infinite or nan; throws InvalidInput for anything else
  int integer(size_t column) const;

 private:
  bool read_line();
  [[noreturn]] void fail(size_t column, const char* expected) const;

  std::filesystem::path path_;
  std::ifstream in_;
  std::vector<std::string> columns_, cells_;
  int line_ = 0;
};

}  // namespace aspic
