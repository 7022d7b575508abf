#include "viewer/settings.h"

#include <fmt/format.h>

#include <cmath>

#include "base/error.h"
#include "base/number_chars.h"
#include "scene/schema.h"

namespace aspic::viewer {
namespace {

// A row of the page: a key of the scene, how it is labeled, and the span of its slider.
struct Row {
  std::string key, label, group;
  double min = 0, max = 1;
  bool is_log = false;
};

const std::vector<Row>& rows() {
  static const std::vector<Row> list = {
      {"material.model", "Material model", "Material"},
      {"material.young", "Young's modulus E", "Material", 1e3, 1e9, true},
      {"material.poisson", "Poisson's ratio ν", "Material", 0, 0.49},
      {"material.density", "Density", "Material", 10, 1e4, true},
      {"damping.mass", "Mass damping", "Material", 0, 10},
      {"damping.stiffness", "Stiffness damping", "Material", 0, 0.1},
      {"damping.viscosity", "Viscosity", "Material", 0, 1e4},
      {"time.step", "Time step h", "Time", 1e-5, 0.1, true},
      {"time.integrator", "Integrator", "Time"},
      {"gravity", "Gravity", "World", -20, 20},
      {"contact.friction", "Friction coefficient", "World", 0, 1},
      {"solver.method", "Method", "Solver"},
      {"solver.definiteness", "Indefinite Hessian", "Solver"},
      {"solver.linear", "Linear solver", "Solver"},
      {"solver.preconditioner", "Preconditioner", "Solver"},
      {"solver.initial_guess", "Initial guess", "Solver"},
      {"solver.criterion", "Criterion", "Solver"},
      {"solver.tolerance", "Tolerance", "Solver", 1e-12, 1e-1, true},
      {"solver.max_iterations", "Maximum iterations", "Solver", 1, 1e4, true},
      {"solver.line_search.test", "Decrease test", "Line search"},
      {"solver.line_search.alpha_max", "Largest step α_max", "Line search", 0.1, 10, true},
      {"solver.line_search.c", "Slope fraction c", "Line search", 1e-6, 0.9, true},
      {"solver.line_search.p", "Shrink factor p", "Line search", 0.05, 0.95},
      {"solver.line_search.tol", "Smallest step tol", "Line search", 1e-16, 1e-1, true},
  };
  return list;
}

// "material" and "young" of "material.young"; the top level of a scene is the section "scene".
const Key& schema_key(const std::string& key) {
  const size_t dot = key.rfind('.');
  if (dot == std::string::npos) return scene_schema().key("scene", key);
  const size_t before = key.rfind('.', dot - 1);
  const size_t first = before == std::string::npos ? 0 : before + 1;
  return scene_schema().key(key.substr(first, dot - first), key.substr(dot + 1));
}

// Returns the value of a key in a complete document; null: none. Keys of bodies refer to the first body.
const Value* find(const Table& document, const std::string& key) {
  const Table* table = &document;
  if (key.starts_with("material.") || key.starts_with("damping."))
    table = &document.find("body")->array().front().table();
  size_t begin = 0;
  while (true) {
    const size_t dot = key.find('.', begin);
    const Value* value = table->find(std::string_view(key).substr(begin, dot - begin));
    if (!value || dot == std::string::npos) return value;
    table = &value->table();
    begin = dot + 1;
  }
}

std::string kind_of(const Key& key, const Value& value) {
  if (!key.choices.empty()) return "choice";
  if (key.accepts & kBoolean) return "switch";
  if (key.accepts & kNumbers) return "vector";
  if (!value.is_number()) return "text";
  return key.accepts & kNumber ? "number" : "integer";
}

Json value_json(const Value& value) {
  if (value.is_text()) return value.text();
  if (std::holds_alternative<bool>(value.data)) return value.boolean();
  if (std::holds_alternative<std::int64_t>(value.data)) return std::get<std::int64_t>(value.data);
  if (value.is_number()) return value.number();
  if (!value.is_array()) return inline_toml(value);
  Json list = Json::array();
  for (const Value& element : value.array()) list.push_back(value_json(element));
  return list;
}

Json setting_json(const Table& document, const Row& row, const Value& value) {
  const Key& key = schema_key(row.key);
  const size_t bodies = document.find("body")->array().size();
  std::string meaning = key.meaning;
  if (bodies > 1 && (row.key.starts_with("material.") || row.key.starts_with("damping.")))
    meaning += fmt::format(" (value of the first body; a change applies to all {})", bodies);
  return {{"key", row.key},     {"label", row.label},          {"group", row.group},         {"unit", key.unit},
          {"meaning", meaning}, {"kind", kind_of(key, value)}, {"value", value_json(value)}, {"min", row.min},
          {"max", row.max},     {"log", row.is_log},           {"choices", key.choices}};
}

bool is_number_text(const std::string& text) {
  double number = 0;
  const auto [end, error] = from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc() && end == text.data() + text.size() && std::isfinite(number);
}

// Returns the value as TOML. Numbers of integer keys have no fraction.
std::string toml_of(const std::string& name, const Key& key, const Json& value) {
  if (value.is_boolean()) return value.get<bool>() ? "true" : "false";
  if (value.is_number()) {
    const double number = value.get<double>();
    if (!std::isfinite(number)) refuse(name, value, "a finite number is expected");
    const bool is_whole = number == std::floor(number) && std::abs(number) < 1e15;
    return is_whole && !(key.accepts & (kNumber | kNumbers)) ? fmt::format("{:.0f}", number) : number_text(number);
  }
  if (value.is_string()) {
    const auto text = value.get<std::string>();
    if (text.size() > 1000) refuse(name, value, "a text of at most 1000 bytes is expected");
    return is_number_text(text) && key.choices.empty() ? text : toml_string(text);
  }
  if (!value.is_array() || value.size() > 3) refuse(name, value, "a number, a text or three numbers are expected");
  std::string list;
  for (const Json& element : value) {
    if (element.is_array()) refuse(name, value, "three numbers are expected");
    list += (list.empty() ? "" : ", ") + toml_of(name, key, element);
  }
  return "[" + list + "]";
}

// Throws InvalidInput for a key that is not a setting; with a document: not a setting of it.
void check_known(const std::string& key, const Table* document) {
  std::vector<std::string> known;
  for (const Row& row : rows())
    if (!document || find(*document, row.key)) known.push_back(row.key);
  if (std::find(known.begin(), known.end(), key) != known.end()) return;
  throw InvalidInput(
      fmt::format("'{}' cannot be changed while the simulation runs{}", shortened(key), suggestion(key, known)));
}

}  // namespace

Json settings_json(const Table& document) {
  Json list = Json::array();
  for (const Row& row : rows())
    if (const Value* value = find(document, row.key)) list.push_back(setting_json(document, row, *value));
  return list;
}

std::string setting_override(const Table& document, const std::string& key, const Json& value) {
  check_known(key, &document);
  return key + "=" + toml_of(key, schema_key(key), value);
}

std::string setting_key(const std::string& key) {
  check_known(key, nullptr);
  return key;
}

std::string key_of(const std::string& override_text) {
  std::string key = override_text.substr(0, override_text.find('='));
  std::erase(key, ' ');
  return key;
}

std::vector<std::string> with_override(std::vector<std::string> overrides, const std::string& override_text) {
  std::erase_if(overrides, [&](const std::string& o) { return key_of(o) == key_of(override_text); });
  if (override_text.find('=') != std::string::npos) overrides.push_back(override_text);
  return overrides;
}

}  // namespace aspic::viewer
