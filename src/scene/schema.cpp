#include "scene/schema.h"

#include <algorithm>
#include <cmath>

#include "base/check.h"

namespace aspic {

bool Range::contains(double value) const {
  return (min_open ? value > min : value >= min) && (max_open ? value < max : value <= max);
}

std::string Range::text() const {
  const std::string low = std::isinf(min) ? "" : (min_open ? "> " : ">= ") + number_text(min);
  const std::string high = std::isinf(max) ? "" : (max_open ? "< " : "<= ") + number_text(max);
  return low + (low.empty() || high.empty() ? "" : " and ") + high;
}

std::string Range::remedy(double value, const std::string& usual) const {
  const bool is_below = value < min || (min_open && value == min);
  if (is_below && !usual.empty()) return "try " + usual;
  if (is_below) return "try " + number_text(min_open ? (std::isfinite(max) ? 0.5 * (min + max) : min + 1) : min);
  if (max_open) return "try " + number_text(std::isfinite(min) ? max - 0.01 * (max - min) : max - 1);
  return "try " + number_text(max);
}

const Key* Schema::find(std::string_view section, std::string_view name) const {
  for (const Key& k : keys)
    if (k.section == section && k.name == name) return &k;
  return nullptr;
}

const Key& Schema::key(std::string_view section, std::string_view name) const {
  const Key* found = find(section, name);
  ASPIC_CHECK(found);
  return *found;
}

std::vector<std::string> Schema::names(std::string_view section) const {
  std::vector<std::string> result;
  for (const Key& k : keys)
    if (k.section == section) result.push_back(k.name);
  return result;
}

const Alternatives* Schema::alternatives_of(std::string_view section) const {
  for (const Alternatives& a : alternatives)
    if (a.section == section) return &a;
  return nullptr;
}

void put_in_order(Table& table, std::string_view section) {
  const Schema& schema = scene_schema();
  const auto earlier = [&](const Member& a, const Member& b) {
    return &schema.key(section, a.key) < &schema.key(section, b.key);
  };
  std::stable_sort(table.members.begin(), table.members.end(), earlier);
  for (Member& m : table.members) {
    const Key& key = schema.key(section, m.key);
    if (key.table.empty()) continue;
    if (m.value.is_table()) put_in_order(m.value.table(), key.table);
    if (m.value.is_array() && (key.accepts & kTables))
      for (Value& element : m.value.array()) put_in_order(element.table(), key.table);
  }
}

}  // namespace aspic
