// `aspic schema`: prints the keys of scenes as JSON Schema.
#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

#include "aspic/commands.h"
#include "scene/schema.h"
#include "scene/toml_reader.h"

namespace aspic::cli {
namespace {

using Json = nlohmann::ordered_json;

Json to_json(const Value& value) {
  if (value.is_table()) {
    Json object = Json::object();
    for (const Member& m : value.table().members) object[m.key] = to_json(m.value);
    return object;
  }
  if (value.is_array()) {
    Json list = Json::array();
    for (const Value& v : value.array()) list.push_back(to_json(v));
    return list;
  }
  if (value.is_text()) return value.text();
  if (const auto* integer = std::get_if<std::int64_t>(&value.data)) return *integer;
  return value.is_number() ? Json(value.number()) : Json(value.boolean());
}

Json in_range(const char* type, const Range& range) {
  Json schema = {{"type", type}};
  if (std::isfinite(range.min)) schema[range.min_open ? "exclusiveMinimum" : "minimum"] = range.min;
  if (std::isfinite(range.max)) schema[range.max_open ? "exclusiveMaximum" : "maximum"] = range.max;
  return schema;
}

Json list_of(const Json& items, int count = 0) {  // 0: any length
  Json schema = {{"type", "array"}, {"items", items}};
  if (count > 0) schema["minItems"] = schema["maxItems"] = count;
  return schema;
}

// Accepts a value of any of the schemas. Schemas of different types are merged, so that a validator can name the key.
Json any_of(const Json& schemas) {
  if (schemas.size() == 1) return schemas[0];
  Json merged, types = Json::array();
  for (const Json& schema : schemas)
    for (const auto& [keyword, value] : schema.items()) {
      if (keyword == "type") {
        types.push_back(value);
      } else if (keyword == "enum" || (merged.contains(keyword) && merged[keyword] != value)) {
        return {{"anyOf", schemas}};
      } else {
        merged[keyword] = value;
      }
    }
  merged["type"] = types;
  return merged;
}

Json table_of(const std::string& section) {
  return {{"type", "object"}, {"allOf", {{{"$ref", "#/definitions/" + section}}}}};
}

// One schema for each kind of value that the key accepts.
Json kinds(const Key& key) {
  const Json number = in_range("number", key.range), integer = in_range("integer", key.range);
  const Json formula = {{"type", "string"}, {"minLength", 1}};
  const Json text = key.choices.empty() ? formula : Json{{"type", "string"}, {"enum", key.choices}};
  const Json numbers = list_of(number, 3), formulas = list_of(any_of({number, formula}), 3);
  const Json table = key.table.empty() ? Json() : table_of(key.table);
  const std::pair<unsigned, Json> all[] = {
      {kInteger, integer},
      {kNumber, number},
      {kBoolean, {{"type", "boolean"}}},
      {kText, text},
      {kExpression | kMovingExpression, formula},
      {kTwoNumbers, list_of(number, 2)},
      {kNumbers, numbers},
      {kExpressions | kMovingExpressions, formulas},
      {kIntegers, list_of(integer)},
      {kMatrix, list_of(numbers, 3)},
      {kPairs, list_of(list_of(integer, 2))},
      {kNames, list_of(text)},
      {kTable | kTables, table},
      {kTables, list_of(table)},
      {kAnyTable, {{"type", "object"}, {"additionalProperties", number}}},
  };
  Json accepted = Json::array();
  for (const auto& [kind, schema] : all)
    if (key.accepts & kind) accepted.push_back(schema);
  return accepted;
}

Json property(const Key& key) {
  Json schema = any_of(kinds(key));
  std::string text = key.meaning;
  if (!key.unit.empty()) text += " [" + key.unit + "]";
  if (!key.reason.empty()) text += " (default: " + key.reason + ")";
  schema["description"] = text;
  if (!key.fallback.empty()) schema["default"] = to_json(read_toml_value(key.fallback, key.name));
  return schema;
}

// A key of one group excludes the keys of the others and needs the required ones of its own.
void add_alternatives(const Schema& all, const Alternatives& rule, Json& schema) {
  Json any = Json::array();
  bool is_needed = rule.required;
  for (const auto& group : rule.groups) {
    Json excluded = Json::object(), required = Json::array();
    for (const auto& other : rule.groups)
      if (&other != &group)
        for (const std::string& name : other) excluded[name] = false;
    for (const std::string& name : group)
      if (all.key(rule.section, name).required) required.push_back(name);
    for (const std::string& name : group) {
      schema["dependencies"][name] = {{"properties", excluded}, {"required", required}};
      any.push_back({{"required", {name}}});
    }
    is_needed = is_needed || (&group == &rule.groups.front() && !required.empty());
  }
  if (is_needed) schema["anyOf"] = any;
}

bool is_alternative(const Alternatives* rule, const std::string& name) {
  return rule && std::any_of(rule->groups.begin(), rule->groups.end(), [&](const std::vector<std::string>& group) {
           return std::find(group.begin(), group.end(), name) != group.end();
         });
}

Json object(const Schema& all, const Section& section) {
  const Alternatives* rule = all.alternatives_of(section.name);
  Json properties = Json::object(), required = Json::array();
  for (const Key& key : all.keys) {
    if (key.section != section.name) continue;
    properties[key.name] = property(key);
    if (key.required && !is_alternative(rule, key.name)) required.push_back(key.name);
  }
  Json schema = {{"description", section.about}, {"properties", properties}, {"additionalProperties", false}};
  if (!required.empty()) schema["required"] = required;
  if (rule) add_alternatives(all, *rule, schema);
  return schema;
}

// Returns the scene schema as JSON Schema, draft 7, with which editors complete and check scenes. It cannot express the
// grammar of formulas, the parameters of each material, files, and conditions between keys other than alternatives.
std::string scene_json_schema() {
  const Schema& all = scene_schema();
  Json schema = {{"$schema", "http://json-schema.org/draft-07/schema#"}, {"title", "Aspic scene"}, {"type", "object"}};
  Json definitions = Json::object();
  for (const Section& section : all.sections) {
    if (section.name == "scene")
      schema.update(object(all, section));
    else
      definitions[section.name] = object(all, section);
  }
  schema["definitions"] = definitions;
  return schema.dump(2);
}

}  // namespace

void add_schema(CLI::App& app, Action& action) {
  CLI::App* command = app.add_subcommand("schema", "Prints the JSON Schema of scenes, for completion in editors");
  command->footer(R"(
Examples:
  aspic schema > aspic.schema.json

If a scene begins with the line '#:schema ./aspic.schema.json', it is completed and checked in every
editor that uses Taplo, such as VS Code with the extension Even Better TOML.)");
  command->callback([&action] {
    action = [] {
      fmt::print("{}\n", scene_json_schema());
      return exit_done;
    };
  });
}

}  // namespace aspic::cli
