#include "io/csv_reader.h"

#include <algorithm>

#include "base/error.h"
#include "base/number_chars.h"
#include "base/printable.h"
#include "io/input_file.h"

namespace aspic {
namespace {

constexpr size_t kLongestLine = size_t{1} << 20;  // longer than any line that Aspic writes

// A line break inside quotes ends the line: no table here has such cells.
std::vector<std::string> split(std::string_view line, char separator) {
  std::vector<std::string> cells(1);
  bool quoted = false;
  for (size_t i = 0; i < line.size(); ++i) {
    if (line[i] == '"') {
      if (quoted && i + 1 < line.size() && line[i + 1] == '"') {
        cells.back() += line[++i];
      } else {
        quoted = !quoted;
      }
    } else if (line[i] == separator && !quoted) {
      cells.emplace_back();
    } else if (line[i] != '\r' || quoted) {
      cells.back() += line[i];
    }
  }
  return cells;
}

void make_printable(std::vector<std::string>& cells) {
  for (std::string& cell : cells)
    if (!is_printable(cell)) cell = printable(cell);
}

constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

std::string trimmed(const std::string& text) {
  const size_t first = text.find_first_not_of(" \t\r");
  return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(" \t\r") + 1 - first);
}

template <class Number>
bool parse(const std::string& text, Number& value) {
  const auto [end, error] = from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size();
}

}  // namespace

CsvReader::CsvReader(const std::filesystem::path& path, CsvOrigin origin)
    : path_(path), in_(open_input(path)), origin_(origin) {
  if (!read_line()) throw InvalidInput(path.string() + ": is empty; a table begins with its column names");
  // A separator at the end of the header names no column.
  while (origin == CsvOrigin::foreign && cells_.size() > 1 && cells_.back().empty()) cells_.pop_back();
  columns_ = cells_;
}

// Reads the next line without its line break; false at the end. The last line of a foreign table may lack the break.
bool CsvReader::read_text(std::string& line) {
  line.clear();
  for (int c; (c = in_.get()) != std::char_traits<char>::eof();) {
    if (c == '\n') {
      ++line_;
      return true;
    }
    line += static_cast<char>(c);
    if (line.size() > kLongestLine)
      throw InvalidInput(path_.string() + ":" + std::to_string(line_ + 1) + ": is too long for a line of a table");
  }
  if (origin_ == CsvOrigin::aspic || line.empty()) return false;
  ++line_;
  return true;
}

// Splits a line into cells_; false at the end.
bool CsvReader::read_line() {
  std::string line;
  if (origin_ == CsvOrigin::aspic) {
    if (!read_text(line)) return false;
    cells_ = split(line, separator_);
    make_printable(cells_);
    return true;
  }
  do {
    if (!read_text(line)) return false;
    if (line_ == 1 && line.starts_with(kByteOrderMark)) line.erase(0, kByteOrderMark.size());
  } while (trimmed(line).empty() || line.starts_with('#'));
  if (columns_.empty()) choose_separator(line);
  cells_ = split(line, separator_);
  for (std::string& cell : cells_) cell = trimmed(cell);
  make_printable(cells_);
  while (!columns_.empty() && cells_.size() > columns_.size() && cells_.back().empty()) cells_.pop_back();
  return true;
}

void CsvReader::choose_separator(const std::string& head) {
  for (const char candidate : {',', ';', '\t'})
    if (head.find(candidate) != std::string::npos) {
      separator_ = candidate;
      return;
    }
}

bool CsvReader::has(std::string_view column) const {
  return std::find(columns_.begin(), columns_.end(), column) != columns_.end();
}

size_t CsvReader::column(std::string_view name) const {
  const auto found = std::find(columns_.begin(), columns_.end(), name);
  if (found == columns_.end())
    throw InvalidInput(path_.string() + ":1: has no column '" + std::string(name) +
                       "'; it is another table, or damaged");
  return static_cast<size_t>(found - columns_.begin());
}

bool CsvReader::next() {
  if (!read_line()) return false;
  if (cells_.size() != columns_.size())
    throw InvalidInput(path_.string() + ":" + std::to_string(line_) + ": has " + std::to_string(cells_.size()) +
                       " cells; the header has " + std::to_string(columns_.size()) +
                       " (is the row torn, or a separator inside a text without quotes?)");
  return true;
}

std::string CsvReader::where() const { return path_.string() + ":" + std::to_string(line_); }

std::optional<double> CsvReader::try_number(size_t column) const {
  std::string text = cells_[column];
  if (origin_ == CsvOrigin::foreign && text.starts_with('+')) text.erase(0, 1);
  if (separator_ != ',') std::replace(text.begin(), text.end(), ',', '.');
  double value = 0;
  return parse(text, value) ? std::optional(value) : std::nullopt;
}

double CsvReader::number(size_t column) const {
  const std::optional<double> value = try_number(column);
  if (!value) fail(column, "a number");
  return *value;
}

int CsvReader::integer(size_t column) const {
  int value = 0;
  if (!parse(cells_[column], value)) fail(column, "a whole number");
  return value;
}

void CsvReader::fail(size_t column, const char* expected) const {
  throw InvalidInput(path_.string() + ":" + std::to_string(line_) + ": " + columns_[column] + " = " +
                     shown(cells_[column]) + " is not " + expected);
}

}  // namespace aspic
