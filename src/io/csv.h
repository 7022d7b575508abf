// Writes tables as comma-separated values [RFC 4180] row by row. Numbers read back to the same bits.
#pragma once
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "io/checksum.h"
#include "io/output_file.h"

namespace aspic {

// One row of a table: row.add(1).add("converged").add(0.1)
class CsvRow {
 public:
  CsvRow& add(std::string_view word);  // quoted where necessary
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

  // Continues a table whose first column is an ascending step number: removes rows of steps after `last_step` and an
  // incomplete last line. Throws InvalidInput if the header differs from `columns`, a row does not begin with a number,
  // or the table ends before `last_step` (unless steps may lack rows: Rows::optional).
  enum class Rows { every_step, optional };
  static CsvFile resume(const std::filesystem::path& path, const std::vector<std::string>& columns, int last_step,
                        Rows rows);

  void append(const CsvRow& row);                 // one write per row, so that a killed run leaves complete lines
  uint64_t size() const { return file_.size(); }  // [bytes]
  uint32_t checksum() const { return checksum_.value(); }
  const std::filesystem::path& path() const { return file_.path(); }
  void sync() { file_.sync(); }
  void close() { file_.close(); }

 private:
  OutputFile file_;
  Checksum checksum_;  // of the whole file
};

}  // namespace aspic
