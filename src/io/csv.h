// Tables as comma-separated values [RFC 4180] that grow row by row; numbers read back to the same bits.
#pragma once
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "io/output_file.h"

namespace aspic {

// One line of a table: row.add(1).add("converged").add(0.1)
class CsvRow {
 public:
  CsvRow& add(std::string_view word);  // quoted where it needs to be
  CsvRow& add(double number);
  CsvRow& add(int number);
  const std::string& text() const { return text_; }  // without the line break

 private:
  void separate();
  std::string text_;
};

class CsvFile {
 public:
  CsvFile() = default;
  static CsvFile create(const std::filesystem::path& path, const std::vector<std::string>& columns);

  // Continues a table whose first column is a step number, ascending: rows of steps after `last_step` and a torn last
  // line are dropped. Throws InvalidInput when the head is not `columns`, a row does not begin with a number, or the
  // table ends before `last_step` (unless it may hold no row for a step: Rows::optional).
  enum class Rows { every_step, optional };
  static CsvFile resume(const std::filesystem::path& path, const std::vector<std::string>& columns, int last_step,
                        Rows rows);

  void append(const CsvRow& row);                 // with one write, so that a killed run leaves whole lines
  uint64_t size() const { return file_.size(); }  // [bytes]
  const std::filesystem::path& path() const { return file_.path(); }
  void sync() { file_.sync(); }
  void close() { file_.close(); }

 private:
  OutputFile file_;
};

}  // namespace aspic
