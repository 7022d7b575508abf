#include "ranks/supported_scene.h"

#include <algorithm>
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

// A painted selection needs the whole surface of a body.
void refuse_painted(const Value& body, const char* actions) {
  const Value* list = body.find(actions);
  if (!list) return;
  for (const Value& action : list->array())
    if (const Value& where = action["where"]; where.is_table() && where.find("file"))
      throw not_supported(where.place, "a painted selection", "use a formula, box, sphere or vertices, or aspic run");
}

// The files of surfaces that aspic run writes by default are left out.
void refuse_surfaces(const Value& output) {
  for (const char* key : {"obj", "ply", "mechanics"})
    if (output[key].boolean())
      throw not_supported(output[key].place, std::string(key) + " = true",
                          "it writes VTU pieces with the usual fields; remove the key");
}

void require_supported_body(const Value& body) {
  refuse_keys(body.table(),
              {"shell", "friction", "viscoelastic", "fibre", "muscle", "spring", "grab", "pressure", "cavity"});
  const Value& viscosity = body["damping"]["viscosity"];
  if (!viscosity.is_number() || viscosity.number() != 0)
    throw not_supported(viscosity.place, "damping.viscosity", "use damping.mass and damping.stiffness, or aspic run");
  require_number(body, "order", 1);
  if (const Value& elastic = body["elastic"]; !elastic.boolean())
    throw not_supported(elastic.place, "elastic = false", "use aspic run");
  for (const char* actions : {"pin", "traction", "force"}) refuse_painted(body, actions);
}

}  // namespace

void require_supported(const Table& document) {
  refuse_keys(document, {"contact", "obstacle", "attach"});
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
  refuse_surfaces(*document.find("output"));
  for (const Value& body : document.find("body")->array()) require_supported_body(body);
}

}  // namespace aspic::distributed
