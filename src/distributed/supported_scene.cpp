#include "distributed/supported_scene.h"

#include <algorithm>
#include <cctype>
#include <string>

namespace aspic::distributed {
namespace {

InvalidInput not_supported(const Place& place, const std::string& what, const std::string& remedy) {
  return error_at(place, what + " is not supported by aspic-mpi; " + remedy);
}

// Refuses keys that have no default.
void refuse_keys(const Table& table, std::initializer_list<const char*> keys) {
  for (const Member& member : table.members)
    if (std::find(keys.begin(), keys.end(), member.key) != keys.end())
      throw not_supported(member.place, member.key, "remove it, or use aspic run");
}

void require_text(const Value& table, const char* key, std::initializer_list<const char*> supported) {
  const Value& value = table[key];
  if (std::find(supported.begin(), supported.end(), value.text()) != supported.end()) return;
  std::string names;
  for (const char* name : supported) names += (names.empty() ? "" : ", ") + std::string(name);
  throw not_supported(value.place, std::string(key) + " = '" + value.text() + "'", "it has " + names);
}

void require_number(const Value& table, const char* key, double supported) {
  const Value& value = table[key];
  if (value.number() == supported) return;
  throw not_supported(value.place, std::string(key) + " = " + number_text(value.number()),
                      "use " + number_text(supported) + ", or aspic run");
}

// Whether a formula uses the variable t.
bool uses_time(const Value& value) {
  if (value.is_array()) return std::any_of(value.array().begin(), value.array().end(), uses_time);
  if (!value.is_text()) return false;
  const std::string& text = value.text();
  const auto is_name = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '.'; };
  for (size_t i = 0; i < text.size(); ++i)
    if (text[i] == 't' && (i == 0 || !is_name(text[i - 1])) && (i + 1 == text.size() || !is_name(text[i + 1])))
      return true;
  return false;
}

void require_constant_loads(const Value& body, const char* loads, std::initializer_list<const char*> keys) {
  const Value* list = body.find(loads);
  if (!list) return;
  for (const Value& load : list->array())
    for (const char* key : keys)
      if (const Value* value = load.find(key); value && uses_time(*value))
        throw not_supported(value->place, "a " + std::string(loads) + " that depends on t",
                            "make it constant, or use aspic run");
}

void require_supported_body(const Value& body) {
  refuse_keys(body.table(), {"friction", "viscoelastic", "fibre", "muscle", "spring", "grab", "pressure"});
  for (const Member& member : body["damping"].table().members)
    if (!member.value.is_number() || member.value.number() != 0)
      throw not_supported(member.value.place, "damping." + member.key, "remove it, or use aspic run");
  require_number(body, "order", 1);
  if (const Value& elastic = body["elastic"]; !elastic.boolean())
    throw not_supported(elastic.place, "elastic = false", "use aspic run");
  refuse_keys(body["material"].table(), {"file"});
  require_constant_loads(body, "traction", {"value", "dead_pressure"});
  require_constant_loads(body, "force", {"value"});
}

}  // namespace

void require_supported(const Table& document) {
  refuse_keys(document, {"contact", "obstacle"});
  const Value& time = *document.find("time");
  require_text(time, "integrator", {"backward_euler", "quasi_static"});
  require_number(time["adaptive"], "tolerance", 0);
  const Value& solver = *document.find("solver");
  require_text(solver, "method", {"newton"});
  if (const Value& fallback = solver["fallback"]; !fallback.array().empty())
    throw not_supported(fallback.place, "fallback", "remove it, or use aspic run");
  require_number(solver, "time_budget", 0);
  require_text(solver, "linear", {"auto", "multigrid", "block_jacobi"});
  require_text(solver, "definiteness", {"auto", "on_demand", "clamped", "absolute", "exact"});
  for (const Value& body : document.find("body")->array()) require_supported_body(body);
}

}  // namespace aspic::distributed
