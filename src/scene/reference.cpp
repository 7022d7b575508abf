// Generates docs/scene.md from the schema.
#include <algorithm>

#include "scene/expression.h"
#include "scene/scene.h"
#include "scene/schema.h"

namespace aspic {
namespace {

// Hashes of files, which only resolved scenes have; the introduction describes all of them.
bool is_hash(const std::string& name) { return name.ends_with("hash"); }

std::string list_of(const std::vector<std::string>& names) {
  std::string out;
  for (const std::string& name : names)
    if (!is_hash(name)) out += (out.empty() ? "`" : ", `") + name + "`";
  return out;
}

std::string kinds(const Key& key) {
  if (key.table == "field") return "[per tet](#field)";
  std::string out;
  const auto add = [&](unsigned kind, const std::string& text) {
    if (key.accepts & kind) out += (out.empty() ? "" : " or ") + text;
  };
  add(kNumber, "number");
  add(kInteger, "integer");
  add(kBoolean, "true or false");
  add(kText, key.choices.empty() ? "string" : list_of(key.choices));
  add(kExpression, "formula");
  add(kMovingExpression, "formula with `t`");
  add(kTwoNumbers, "2 numbers");
  add(kNumbers, "3 numbers");
  add(kExpressions, "3 formulas");
  add(kMovingExpressions, "3 formulas with `t`");
  add(kIntegers, "list of integers");
  add(kMatrix, "3 rows of 3 numbers");
  add(kPairs, "list of pairs of integers");
  add(kNames, "list of " + (key.choices.empty() ? "names" : list_of(key.choices)));
  add(kTable, "[" + key.table + "](#" + key.table + ")");
  add(kTables, "list of [" + key.table + "](#" + key.table + ")");
  add(kAnyTable, "table of numbers");
  return out;
}

bool is_alternative(const Key& key) {
  const Alternatives* rule = scene_schema().alternatives_of(key.section);
  return rule && std::any_of(rule->groups.begin(), rule->groups.end(), [&](const std::vector<std::string>& group) {
           return std::find(group.begin(), group.end(), key.name) != group.end();
         });
}

// Returns type, unit, range and default. The rule above the list of a section states which alternatives are required.
std::string facts(const Key& key) {
  std::string out = kinds(key);
  if (!key.unit.empty()) out += " [" + key.unit + "]";
  if (!key.range.text().empty()) out += ", " + key.range.text();
  if (!key.fallback.empty() && key.fallback != "{}") out += ", default `" + key.fallback + "`";
  return out + (key.required && !is_alternative(key) ? ", required" : "");
}

// Two meanings that differ in the middle: "about 1 (only spline)", "about 10 (only spline)" -> "about 1 to 10 (only
// spline)".
std::string range_of_meanings(const std::string& a, const std::string& b) {
  const auto word = [](const std::string& text) { return text.substr(0, text.find(' ')); };
  const auto place = std::mismatch(a.begin(), a.end(), b.begin(), b.end()).first - a.begin();
  const size_t start = place == 0 ? 0 : a.rfind(' ', place - 1) + 1;
  return a.substr(0, start) + word(a.substr(start)) + " to " + b.substr(start);
}

// Position after the keys name_1, name_2, ... that begin at `i`; i + 1 for any other key.
size_t end_of_series(const std::vector<Key>& keys, size_t i) {
  const std::string& first = keys[i].name;
  if (!first.ends_with("_1")) return i + 1;
  const std::string stem = first.substr(0, first.size() - 1);
  size_t end = i + 1;
  while (end < keys.size() && keys[end].name == stem + std::to_string(end - i + 1)) ++end;
  return end;
}

// Items of the keys of a section; a numbered series is one item.
std::string items(const std::vector<Key>& keys, const std::string& section) {
  std::string out;
  for (size_t i = 0, end = 0; i < keys.size(); i = end) {
    end = end_of_series(keys, i);
    if (keys[i].section != section || is_hash(keys[i].name)) continue;
    const Key &first = keys[i], &last = keys[end - 1];
    const bool series = end > i + 1;
    out += "* `" + first.name + (series ? "` ... `" + last.name : "") + "` (" + facts(first) +
           "): " + (series ? range_of_meanings(first.meaning, last.meaning) : first.meaning) + "\n";
  }
  return out;
}

std::string alternatives_text(const Alternatives& rule) {
  std::string out = rule.required ? "One of: " : "At most one of: ";
  for (size_t i = 0; i < rule.groups.size(); ++i) out += (i ? "; or " : "") + list_of(rule.groups[i]);
  return out + ".\n\n";
}

std::string formulas() {
  std::string out =
      "## Formulas\n\nA formula is a number or a string such as `\"1e5 * (1 + 3 * exp(-Y^2 / 0.02))\"`: at most " +
      std::to_string(kMaxExpressionLength) + " characters and " + std::to_string(kMaxExpressionDepth) +
      " open parentheses, with `+ - * / ^`, comparisons, `&& || !` and `condition ? a : b`. `X`, `Y`, `Z` (or `x`, "
      "`y`, `z`) is a point of the placed rest shape [m]; in a motion, of the shape at time 0. In motions and loads "
      "`t` is the time [s]. A value that is not finite is an error. Functions and constants: ";
  std::vector<NamedMeaning> names = expression_functions();
  for (const NamedMeaning& constant : expression_constants()) names.push_back(constant);
  for (size_t i = 0; i < names.size(); ++i)
    out += (i ? ", `" : "`") + names[i].name + "`" + (names[i].meaning.empty() ? "" : " " + names[i].meaning);
  return out + ".\n";
}

const char* const kIntroduction =
    "# Scenes\n\n"
    "For everyone who writes scenes. Afterwards you know every key with its unit, range and default, as the schema "
    "checks them.\n\n"
    "A scene is a TOML file in SI units:\n\n"
    "```toml\n"
    "[[body]]\n"
    "shape = { box = { upper = [1, 0.2, 0.2], cells = [20, 4, 4] } }\n"
    "material = { model = \"neo_hookean\", young = 1e6, poisson = 0.4, density = 1000 }\n"
    "[[body.pin]]\n"
    "where = \"x < 0.001\"\n"
    "```\n\n"
    "* Mistakes are errors with file, line, column, value and remedy.\n"
    "* File names are relative to the scene's folder. A scene can read that folder and the one above; other paths only "
    "on the command line (`--set mesh=...`, relative to the working directory).\n"
    "* `--set PATH=VALUE ...` replaces values: `time.step=0.005`, `material.young=2e5` of every body, "
    "`body.bunny.pin.0.where=\"y < 0.1\"` of one; lists by name, or index from 0.\n"
    "* A run stores the resolved scene with all defaults and meshes, and beside each file name its `hash` or "
    "`mesh_hash`. It is bit-reproducible.\n"
    "* Dead loads (gravity, `traction`, `force`) have the energy -f . x about the origin, so only differences have a "
    "meaning.\n"
    "* A mesh runs without a scene, with other defaults (`young` for its weight), printed with reasons.\n\n";

}  // namespace

std::string scene_reference() {
  const Schema& schema = scene_schema();
  std::string out = kIntroduction;
  for (const Section& section : schema.sections) {
    out += "## " + section.name + "\n\n`" + section.where + "`. " + section.about + "\n\n";
    if (const Alternatives* rule = schema.alternatives_of(section.name)) out += alternatives_text(*rule);
    out += items(schema.keys, section.name);
    out += "\n";
  }
  return out + formulas();
}

}  // namespace aspic
