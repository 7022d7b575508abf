#include "base/error.h"

#include <algorithm>
#include <numeric>
#include <utility>

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

// Names of the literature and of other programs, in lower case, and ours.
constexpr std::pair<std::string_view, std::string_view> kSynonyms[] = {
    {"e", "young"},
    {"youngs_modulus", "young"},
    {"young_modulus", "young"},
    {"elastic_modulus", "young"},
    {"nu", "poisson"},
    {"poissons_ratio", "poisson"},
    {"poisson_ratio", "poisson"},
    {"rho", "density"},
    {"k", "stiffness"},
    {"mu", "friction"},
    {"friction_coefficient", "friction"},
    {"dt", "step"},
    {"h", "step"},
    {"timestep", "step"},
    {"time_step", "step"},
    {"g", "gravity"},
    {"dhat", "reach"},
    {"d_hat", "reach"},
};

// Returns the entry of `known` that means the same as `word`; empty if there is none.
std::string synonym(std::string_view word, const std::vector<std::string>& known) {
  std::string lower(word);
  for (char& c : lower) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  for (const auto& [other, own] : kSynonyms)
    if (other == lower && std::find(known.begin(), known.end(), own) != known.end()) return std::string(own);
  return "";
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
  if (std::string same = synonym(word, known); !same.empty()) return same;
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
