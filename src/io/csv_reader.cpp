#include "io/csv_reader.h"

#include <algorithm>

#include "base/error.h"
#include "base/number_chars.h"
#include "base/printable.h"
#include "io/input_file.h"

namespace aspic {
namespace {

constexpr size_t kLongestLine = size_t{1} << 20;  // longer than any line that Aspic writes

// Splits a line into cells, whose memory is reused. A line break inside quotes ends the line: no table here has such
// cells.
void split(std::string_view line, char separator, std::vector<std::string>& cells) {
  size_t count = 0;
  const auto next_cell = [&]() -> std::string& {
    if (++count > cells.size()) cells.emplace_back();
    cells[count - 1].clear();
    return cells[count - 1];
  };
  std::string* cell = &next_cell();
  bool quoted = false;
  for (size_t i = 0; i < line.size(); ++i) {
    if (line[i] == '"') {
      if (quoted && i + 1 < line.size() && line[i + 1] == '"') {
        *cell += line[++i];
      } else {
        quoted = !quoted;
      }
    } else if (line[i] == separator && !quoted) {
      cell = &next_cell();
    } else if (line[i] != '\r' || quoted) {
      *cell += line[i];
    }
  }
  cells.resize(count);
}

void make_printable(std::vector<std::string>& cells) {
  for (std::string& cell : cells)
    if (!is_printable(cell)) cell = printable(cell);
}

constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

void trim(std::string& text) {
  text.erase(text.find_last_not_of(" \t\r") + 1);
  text.erase(0, std::min(text.find_first_not_of(" \t\r"), text.size()));
}

template <class Number>
bool parse(std::string_view text, Number& value) {
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
  std::streambuf& buffer = *in_.rdbuf();
  for (int c; (c = buffer.sbumpc()) != std::char_traits<char>::eof();) {
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
    split(line, separator_, cells_);
    make_printable(cells_);
    return true;
  }
  do {
    if (!read_text(line)) return false;
    if (line_ == 1 && line.starts_with(kByteOrderMark)) line.erase(0, kByteOrderMark.size());
  } while (line.find_first_not_of(" \t\r") == std::string::npos || line.starts_with('#') ||
           (columns_.empty() && line.starts_with("***")));
  if (columns_.empty()) choose_separator(line);
  split(line, separator_, cells_);
  for (std::string& cell : cells_) trim(cell);
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
    throw InvalidInput(path_.string() + ":1: missing column '" + std::string(name) + "'; found " + column_list());
  return static_cast<size_t>(found - columns_.begin());
}

std::string CsvReader::column_list() const {
  constexpr size_t kMost = 12;
  std::string list;
  for (size_t c = 0; c < std::min(columns_.size(), kMost); ++c) list += (c > 0 ? ", " : "") + columns_[c];
  return list + (columns_.size() > kMost ? ", ..." : "");
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
  std::string_view text = cells_[column];
  if (origin_ == CsvOrigin::foreign && text.starts_with('+')) text.remove_prefix(1);
  std::string with_points;
  if (separator_ != ',' && text.find(',') != std::string_view::npos) {
    with_points = text;
    std::replace(with_points.begin(), with_points.end(), ',', '.');
    text = with_points;
  }
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
