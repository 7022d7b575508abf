#include "base/error.h"

#include <algorithm>
#include <numeric>

#include "base/printable.h"

namespace aspic {
namespace {

size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), size_t{0});
  for (size_t i = 1; i <= a.size(); ++i) {
    size_t diagonal = row[0];
    row[0] = i;
    for (size_t j = 1; j <= b.size(); ++j) {
      const size_t replaced = diagonal + (a[i - 1] != b[j - 1]);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, replaced});
    }
  }
  return row.back();
}

std::string lines_of(const std::vector<std::string>& messages) {
  std::string lines;
  for (const std::string& message : messages)
    lines += (lines.empty() ? "" : "\n") + elided(message, InvalidInput::kLongestMessage);
  return lines;
}

}  // namespace

InvalidInput::InvalidInput(std::string_view message) : std::runtime_error(elided(message, kLongestMessage)) {}

InvalidInput::InvalidInput(const std::vector<std::string>& messages) : std::runtime_error(lines_of(messages)) {}

std::string nearest_name(std::string_view word, const std::vector<std::string>& known) {
  if (word.size() > 64) return "";  // too long for a typing error
  const std::string* best = nullptr;
  size_t best_distance = std::max<size_t>(2, word.size() / 3) + 1;
  for (const std::string& name : known) {
    const size_t distance = edit_distance(word, name);
    if (distance < best_distance) best = &name, best_distance = distance;
  }
  return best ? *best : "";
}

std::string suggestion(std::string_view word, const std::vector<std::string>& known) {
  if (const std::string name = nearest_name(word, known); !name.empty()) return " (did you mean '" + name + "'?)";
  std::string list;
  for (const std::string& name : known) list += (list.empty() ? "" : ", ") + name;
  return list.empty() ? "" : " (known: " + list + ")";
}

}  // namespace aspic
