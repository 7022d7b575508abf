// Walks a document along the schema: types, ranges, choices, unknown and missing keys, defaults.
#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/number_chars.h"
#include "base/printable.h"
#include "scene/expression.h"
#include "scene/schema.h"
#include "scene/toml_reader.h"

namespace aspic {
namespace {

constexpr size_t kMaxErrors = 5;  // the first ones explain the rest

std::string join(const std::vector<std::string>& words, const std::string& separator) {
  std::string out;
  for (const std::string& w : words) out += (out.empty() ? "" : separator) + w;
  return out;
}

bool is_array_of(const Value& value, size_t size, bool (*accepted)(const Value&)) {
  return value.is_array() && (size == 0 || value.array().size() == size) &&
         std::all_of(value.array().begin(), value.array().end(), accepted);
}
bool is_number(const Value& v) { return v.is_number(); }
bool is_integer(const Value& v) { return std::holds_alternative<std::int64_t>(v.data); }
bool is_number_or_text(const Value& v) { return v.is_number() || v.is_text(); }
bool is_text(const Value& v) { return v.is_text(); }
bool is_row(const Value& v) { return is_array_of(v, 3, is_number); }
bool is_pair(const Value& v) { return is_array_of(v, 2, is_integer); }
bool is_table(const Value& v) { return v.is_table(); }

// Returns the kind of the value among those that the key accepts; 0: none.
unsigned kind_of(const Value& v, unsigned accepts) {
  const auto is = [&](unsigned kind, bool fits) { return (accepts & kind) && fits; };
  if (is(kInteger, is_integer(v))) return kInteger;
  if (is(kNumber, v.is_number())) return kNumber;
  if (is(kBoolean, std::holds_alternative<bool>(v.data))) return kBoolean;
  if (is(kText, v.is_text())) return kText;
  if (is(kExpression, v.is_text())) return kExpression;
  if (is(kMovingExpression, v.is_text())) return kMovingExpression;
  if (is(kTwoNumbers, is_array_of(v, 2, is_number))) return kTwoNumbers;
  if (is(kNumbers, is_array_of(v, 3, is_number))) return kNumbers;
  if (is(kExpressions, is_array_of(v, 3, is_number_or_text))) return kExpressions;
  if (is(kMovingExpressions, is_array_of(v, 3, is_number_or_text))) return kMovingExpressions;
  if (is(kIntegers, is_array_of(v, 0, is_integer))) return kIntegers;
  if (is(kMatrix, is_array_of(v, 3, is_row))) return kMatrix;
  if (is(kPairs, is_array_of(v, 0, is_pair))) return kPairs;
  if (is(kNames, is_array_of(v, 0, is_text))) return kNames;
  if (is(kTable, v.is_table())) return kTable;
  if (is(kTables, v.is_table() || is_array_of(v, 0, is_table))) return kTables;
  if (is(kAnyTable, v.is_table())) return kAnyTable;
  return 0;
}

std::string expected(const Key& key) {
  std::vector<std::string> kinds;
  const auto add = [&](unsigned kind, const char* words) {
    if (key.accepts & kind) kinds.push_back(words);
  };
  add(kNumber, "a number");
  add(kInteger, "an integer");
  add(kBoolean, "true or false");
  add(kText, "a string");
  add(kExpression, "a formula in a string");
  add(kMovingExpression, "a formula of X, Y, Z, t in a string");
  add(kTwoNumbers, "two numbers");
  add(kNumbers, "three numbers");
  add(kExpressions, "three numbers or formulas");
  add(kMovingExpressions, "three numbers or formulas of X, Y, Z, t");
  add(kIntegers, "a list of integers");
  add(kMatrix, "three rows of three numbers");
  add(kPairs, "a list of pairs of integers");
  add(kNames, "a list of names");
  add(kTable, "a table { ... }");
  add(kTables, "one or more tables");
  add(kAnyTable, "a table { name = number }");
  std::string text = join(kinds, " or ");
  if (!key.unit.empty()) text += " [" + key.unit + "]";
  return text;
}

// "in pascals: 2e4" for "20 kPa"; empty for other texts.
std::string in_si_units(const std::string& text) {
  struct Unit {
    const char *name, *si;
    double factor;
  };
  constexpr Unit kUnits[] = {{"Pa", "pascals", 1},      {"kPa", "pascals", 1e3}, {"MPa", "pascals", 1e6},
                             {"GPa", "pascals", 1e9},   {"mm", "meters", 1e-3},  {"cm", "meters", 1e-2},
                             {"m", "meters", 1},        {"ms", "seconds", 1e-3}, {"s", "seconds", 1},
                             {"g/cm^3", "kg/m^3", 1e3}, {"kg/m^3", "kg/m^3", 1}};
  double number = 0;
  const char* end = text.data() + text.size();
  auto [rest, error] = from_chars(text.data(), end, number);
  if (error != std::errc()) return "";
  while (rest != end && *rest == ' ') ++rest;
  for (const Unit& unit : kUnits)
    if (std::string_view(rest, end - rest) == unit.name)
      return std::string("in ") + unit.si + ": " + number_text(unit.factor * number);
  return "";
}

class Checker {
 public:
  explicit Checker(const Schema& schema) : schema_(schema) {}

  void check_section(Table& table, const std::string& section, const Place& place) {
    for (Member& m : table.members) {
      const Key* key = schema_.find(section, m.key);
      if (key) {
        check_value(m.value, *key);
      } else {
        unknown_key(m, section);
      }
    }
    const std::vector<std::string> idle = check_alternatives(table, section, place);
    complete(table, section, place, idle);
  }

  void finish() const {
    if (!errors_.empty()) throw InvalidInput(errors_);
  }

 private:
  void error(const Place& place, const std::string& text) {
    if (errors_.size() < kMaxErrors) errors_.push_back(to_string(place) + ": " + text);
  }
  void wrong(const Value& value, const Key& key, const std::string& remedy) {
    error(value.place, key.name + " = " + shortened(inline_toml(value)) + "; " + remedy);
  }

  void unknown_key(const Member& m, const std::string& section) {
    const std::vector<std::string> known = schema_.names(section);
    std::string hint = suggestion(m.key, known);
    if (nearest_name(m.key, known).empty())
      for (const Key& k : schema_.keys)
        if (k.name == m.key && !(k.accepts & kTables)) {
          hint.insert(0, std::string(" (it belongs to ").append(k.section).append(")"));
          break;
        }
    error(m.place,
          "unknown key " + shortened(m.key) + " = " + shortened(inline_toml(m.value)) + " in " + section + hint);
  }

  void check_number(Value& value, const Value& whole, const Key& key) {
    const double number = value.number();
    if (!std::isfinite(number)) {
      wrong(whole, key, "a finite number is needed");
    } else if (!key.range.contains(number)) {
      const std::string usual = whole.is_array() ? "" : key.fallback;
      wrong(whole, key, "must be " + key.range.text() + " (" + key.range.remedy(number, usual) + ")");
    }
  }
  void check_float(Value& value, const Value& whole, const Key& key) {
    check_number(value, whole, key);
    value.data = value.number();
  }
  void check_expression(const Value& value, const Key& key) {
    try {
      const bool moves = key.accepts & (kMovingExpression | kMovingExpressions);
      Expression(value.text(), moves ? ExpressionVariables::position_and_time : ExpressionVariables::position);
    } catch (const InvalidInput& e) {
      const std::string si = in_si_units(value.text());
      if (!si.empty()) return wrong(value, key, si);
      error(value.place, key.name + ": " + e.what());
    }
  }

  void check_value(Value& value, const Key& key) {
    switch (kind_of(value, key.accepts)) {
      case 0:
        return wrong(
            value, key,
            "this is " + type_name(value) + "; expected " + expected(key) +
                (value.is_text() && !in_si_units(value.text()).empty() ? ", " + in_si_units(value.text()) : ""));
      case kInteger:
        return check_number(value, value, key);
      case kNumber:
        return check_float(value, value, key);
      case kText:
        return check_choice(value, key);
      case kExpression:
      case kMovingExpression:
        return check_expression(value, key);
      case kIntegers:
      case kPairs:
        return check_integers(value, value, key);
      case kTwoNumbers:
      case kNumbers:
      case kExpressions:
      case kMovingExpressions:
      case kMatrix:
        return check_components(value, key);
      case kNames:
        for (const Value& name : value.array()) check_choice(name, key);
        return;
      case kTable:
        return check_section(value.table(), key.table, value.place);
      case kTables:
        return check_tables(value, key);
      case kAnyTable:
        return check_any_table(value, key);
    }
  }

  void check_choice(const Value& value, const Key& key) {
    if (key.choices.empty()) {
      if (value.text().empty()) wrong(value, key, "must not be empty");
      if (!is_printable(value.text())) wrong(value, key, "must be UTF-8 without control characters");
      return;
    }
    if (std::find(key.choices.begin(), key.choices.end(), value.text()) != key.choices.end()) return;
    wrong(value, key, "unknown name" + suggestion(value.text(), key.choices));
  }

  void check_integers(const Value& value, const Value& whole, const Key& key) {
    for (const Value& v : value.array()) {
      if (v.is_array()) {
        check_integers(v, whole, key);
      } else if (!key.range.contains(v.number())) {
        return error(v.place, key.name + ": " + inline_toml(v) + " must be " + key.range.text());
      }
    }
  }

  void check_components(Value& value, const Key& key) {
    const Value whole = value;  // as the user wrote it, for the messages
    for (Value& v : value.array()) {
      if (v.is_array()) {
        check_components(v, key);
      } else if (v.is_text()) {
        check_expression(v, key);
      } else {
        check_float(v, whole, key);
      }
    }
  }

  void check_tables(Value& value, const Key& key) {
    if (value.is_table()) {  // a single table is a list of one
      Value list{Array{}, value.place};
      list.array().push_back(std::move(value));
      value = std::move(list);
    }
    for (Value& element : value.array()) check_section(element.table(), key.table, element.place);
  }

  void check_any_table(Value& value, const Key& key) {
    for (Member& m : value.table().members) {
      if (m.value.is_number()) {
        check_float(m.value, m.value, key);
      } else {
        error(m.value.place,
              key.name + "." + shortened(m.key) + " = " + shortened(inline_toml(m.value)) + "; a number is needed");
      }
    }
  }

  // Returns the keys of the groups that were not chosen: they get no defaults.
  std::vector<std::string> check_alternatives(const Table& table, const std::string& section, const Place& place) {
    std::vector<std::string> idle;
    for (const Alternatives& rule : schema_.alternatives)
      if (rule.section == section) check_rule(rule, table, place, idle);
    return idle;
  }

  void check_rule(const Alternatives& rule, const Table& table, const Place& place, std::vector<std::string>& idle) {
    std::vector<std::string> all;
    for (const auto& group : rule.groups) all.push_back(join(group, ", "));
    const std::vector<std::string>* chosen = nullptr;
    std::string chosen_key;
    for (const auto& group : rule.groups) {
      for (const std::string& name : group) {
        const Value* value = table.find(name);
        if (!value || chosen == &group) continue;
        if (chosen) {
          error(value->place, std::string(name).append(" = ").append(shortened(inline_toml(*value))) + " excludes " +
                                  chosen_key + "; keep one of: " + join(all, " | "));
        } else {
          chosen = &group;
          chosen_key = name;
        }
      }
    }
    if (!chosen && rule.required) error(place, rule.section + " needs one of: " + join(all, " | "));
    if (!chosen && !rule.required) chosen = &rule.groups.front();
    for (const auto& group : rule.groups)
      if (&group != chosen) idle.insert(idle.end(), group.begin(), group.end());
  }

  void complete(Table& table, const std::string& section, const Place& place, const std::vector<std::string>& idle) {
    Table complete;
    for (const Key& key : schema_.keys) {
      if (key.section != section) continue;
      const bool is_idle = std::find(idle.begin(), idle.end(), key.name) != idle.end();
      if (Value* given = table.find(key.name)) {
        complete.members.push_back({key.name, given->place, std::move(*given)});
      } else if (!key.fallback.empty() && !is_idle) {
        Value value = read_toml_value(key.fallback, "default of " + key.name);
        check_value(value, key);
        complete.members.push_back({key.name, {}, std::move(value)});
      } else if (key.required && !is_idle) {
        error(place, section + " needs the key '" + key.name + "': " + expected(key));
      }
    }
    table = std::move(complete);
  }

  const Schema& schema_;
  std::vector<std::string> errors_;
};

}  // namespace

void check_and_complete(Table& document, const std::string& source) {
  check_and_complete(document, source, scene_schema(), "scene");
}

void check_and_complete(Table& document, const std::string& source, const Schema& schema, const std::string& section) {
  Checker checker(schema);
  checker.check_section(document, section, {std::make_shared<const std::string>(source), 1, 1});
  checker.finish();
}

}  // namespace aspic
