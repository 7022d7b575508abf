// docs/scene.md, from the schema.
#include "scene/expression.h"
#include "scene/scene.h"
#include "scene/schema.h"

namespace aspic {
namespace {

std::string list_of(const std::vector<std::string>& words) {
  std::string out;
  for (const std::string& w : words) out += (out.empty() ? "`" : ", `") + w + "`";
  return out;
}

std::string kinds(const Key& key) {
  std::string out;
  const auto add = [&](unsigned kind, const std::string& words) {
    if (key.accepts & kind) out += (out.empty() ? "" : " or ") + words;
  };
  add(kNumber, "number");
  add(kInteger, "integer");
  add(kBoolean, "true or false");
  add(kText, key.choices.empty() ? "string" : "one of " + list_of(key.choices));
  add(kExpression, "formula");
  add(kMovingExpression, "formula with `t`");
  add(kNumbers, "3 numbers");
  add(kExpressions, "3 numbers or formulas");
  add(kMovingExpressions, "3 numbers or formulas with `t`");
  add(kIntegers, "list of integers");
  add(kMatrix, "3 rows of 3 numbers");
  add(kPairs, "list of pairs of integers");
  add(kNames, "list of " + list_of(key.choices));
  add(kTable, "[" + key.table + "](#" + key.table + ")");
  add(kTables, "list of [" + key.table + "](#" + key.table + ")");
  add(kAnyTable, "table of numbers");
  return out;
}

// Cells of a Markdown table end at a bar.
std::string cell(const std::string& text) {
  std::string out;
  for (const char c : text) out += c == '|' ? std::string("\\|") : std::string(1, c);
  return out;
}

std::string row(const Key& key) {
  std::string kind = kinds(key);
  if (!key.range.text().empty()) kind += ", " + key.range.text();
  if (!key.unit.empty()) kind += " [" + key.unit + "]";
  std::string fallback = key.required ? "required" : "";
  if (!key.fallback.empty()) fallback = "`" + key.fallback + "`";
  if (!key.reason.empty()) fallback += ": " + key.reason;
  return "| `" + key.name + "` | " + cell(kind) + " | " + cell(fallback) + " | " + cell(key.meaning) + " |\n";
}

std::string alternatives_text(const Alternatives& rule) {
  std::string out = rule.required ? "One of: " : "At most one of: ";
  for (size_t i = 0; i < rule.groups.size(); ++i) out += (i ? "; or " : "") + list_of(rule.groups[i]);
  return out + ".\n\n";
}

std::string formulas() {
  std::string out =
      "## Formulas\n\nA formula is a string such as `\"1e5 * (1 + 3 * exp(-Y^2 / 0.02))\"`: at most " +
      std::to_string(kMaxExpressionLength) + " characters and " + std::to_string(kMaxExpressionDepth) +
      " open parentheses, with `+ - * / ^`, comparisons, `&& || !` and `condition ? a : b`. `X`, `Y`, `Z` (or `x`, "
      "`y`, `z`) is a point of the placed rest shape [m]; in a motion it is where the point was at time 0. In "
      "motions and loads `t` is "
      "the time [s]. A value that is not finite is an error. Functions:\n\n| name | meaning |\n|---|---|\n";
  for (const NamedMeaning& f : expression_functions()) out += "| `" + f.name + "` | " + cell(f.meaning) + " |\n";
  for (const NamedMeaning& c : expression_constants()) out += "| `" + c.name + "` | " + cell(c.meaning) + " |\n";
  return out;
}

const char* const kIntroduction =
    "# Scenes\n\n"
    "A scene is a TOML file in SI units: metres, kilograms, seconds, newtons, pascals; angles are in degrees where "
    "the key says so. This page is generated from the schema that checks scenes; a test keeps the two equal.\n\n"
    "```toml\n"
    "[[body]]\n"
    "shape = { box = { upper = [1, 0.2, 0.2], cells = [20, 4, 4] } }\n"
    "material = { model = \"neo_hookean\", young = 1e6, poisson = 0.4, density = 1000 }\n"
    "[[body.pin]]\n"
    "where = \"x < 0.001\"\n"
    "```\n\n"
    "* Unknown keys, wrong types, missing files and values out of range are errors with file, line, column, value and "
    "remedy.\n"
    "* File names are relative to the scene's folder. A scene reads its own folder and the folder above with what is "
    "in it, such as `../assets/bunny.mesh`; absolute paths and `../..` are refused unless they come from the command "
    "line (`--set mesh=...`, relative to the working directory), so that a scene from elsewhere cannot open files all "
    "over the disk.\n"
    "* `--set PATH=VALUE` replaces a value: `time.step=0.005`; several may follow one `--set`; `material.young=2e5` "
    "for every body; "
    "`body.bunny.pin.0.where=\"y < 0.1\"` for one, lists by name or index from 0.\n"
    "* A run stores the resolved scene: every default filled in, with the meshes it used beside it and their hashes. "
    "Running that file again gives the same bits.\n"
    "* Dead loads (gravity, `traction`, `force`) have the energy -f . x, with x measured from the origin of "
    "coordinates. "
    "It is not zero at rest and changes when a body is moved; only its differences have a meaning, and forces do not "
    "depend on it.\n"
    "* A pinned vertex moves as its pin says and has the velocity of the pin: initial velocities of a body are those "
    "of "
    "its free vertices.\n"
    "* A mesh without a scene runs too, with defaults that are stated with their reasons.\n\n";

}  // namespace

std::string scene_reference() {
  const Schema& schema = scene_schema();
  std::string out = kIntroduction;
  for (const Section& section : schema.sections) {
    out += "## " + section.name + "\n\n`" + section.where + "`. " + section.about + "\n\n";
    if (const Alternatives* rule = schema.alternatives_of(section.name)) out += alternatives_text(*rule);
    out += "| key | value | default | meaning |\n|---|---|---|---|\n";
    for (const Key& key : schema.keys)
      if (key.section == section.name) out += row(key);
    out += "\n";
  }
  return out + formulas();
}

}  // namespace aspic
