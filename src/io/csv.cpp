#include "io/csv.h"

#include <cmath>

#include "base/error.h"
#include "base/number_chars.h"
#include "io/atomic_file.h"
#include "io/number_text.h"

namespace aspic {
namespace {

std::string head_line(const std::vector<std::string>& columns) {
  CsvRow row;
  for (const std::string& column : columns) row.add(column);
  return row.text() + "\n";
}

}  // namespace

void CsvRow::separate() {
  if (!text_.empty()) text_ += ',';
}

CsvRow& CsvRow::add(std::string_view word) {
  separate();
  if (!word.empty() && word.find_first_of(",\"\r\n") == std::string_view::npos) {
    text_ += word;
    return *this;
  }
  text_ += '"';
  for (const char c : word) text_ += c == '"' ? "\"\"" : std::string(1, c);
  text_ += '"';
  return *this;
}

CsvRow& CsvRow::add(double number) {
  separate();
  if (std::isnan(number)) {
    text_ += "nan";  // the sign has no meaning
  } else {
    append_number(text_, number);
  }
  return *this;
}

CsvRow& CsvRow::add(int number) {
  separate();
  append_number(text_, number);
  return *this;
}

CsvFile CsvFile::create(const std::filesystem::path& path, const std::vector<std::string>& columns) {
  CsvFile table;
  write_file(path, head_line(columns));  // the file always has its header line
  table.file_ = OutputFile::open_existing(path);
  table.checksum_.add(head_line(columns));
  return table;
}

CsvFile CsvFile::resume(const std::filesystem::path& path, const std::vector<std::string>& columns, int last_step,
                        Rows rows) {
  const std::string text = read_file(path);
  const std::string head = head_line(columns);
  if (!text.starts_with(head)) throw InvalidInput(path.string() + ":1: other columns than this run writes");
  size_t kept = head.size();
  int step = 0, line = 1;
  for (size_t end; (end = text.find('\n', kept)) != std::string::npos; kept = end + 1) {
    ++line;
    int next = 0;
    if (from_chars(text.data() + kept, text.data() + end, next).ec != std::errc() || next < step) {
      throw InvalidInput(path.string() + ":" + std::to_string(line) + ": the row does not begin with the next step");
    }
    if (next > last_step) break;
    step = next;
  }
  if (rows == Rows::every_step && step != last_step) {
    throw InvalidInput(path.string() + ": ends at step " + std::to_string(step) + ", before the checkpoint at step " +
                       std::to_string(last_step) + "; the run cannot be continued");
  }
  CsvFile table;
  table.file_ = OutputFile::open_existing(path);
  table.file_.truncate(kept);
  table.checksum_.add(std::string_view(text).substr(0, kept));
  return table;
}

void CsvFile::append(const CsvRow& row) {
  const std::string line = row.text() + "\n";
  file_.append(line);
  checksum_.add(line);
}

}  // namespace aspic
