#include "scene/thin_body.h"

#include "base/formatted.h"

namespace aspic {

void refuse_keys_of_solids(const Value& body, const ThinKind& kind) {
  const auto refuse = [&](const Value& value, const std::string& key) {
    throw error_at(value.place, key + ": body '" + body["name"].text() + "' has `" + kind.key + "`, and " + key +
                                    " needs a solid (remove one of the two)");
  };
  std::vector<std::string> keys = {"skin", "mesh_size", "viscoelastic", "fibre", "muscle", "force", "grab"};
  keys.insert(keys.end(), kind.refused.begin(), kind.refused.end());
  for (const std::string& key : keys)
    if (const Value* value = body.find(key)) refuse(*value, key);
  if (const Value& order = body["order"]; order.number() != 1) refuse(order, "order = 2");
  const Value& material = body["material"];
  if (const Value* file = material.find("file")) refuse(*file, "material.file");
  if (const Value& model = material["model"]; model.text() != "neo_hookean")
    throw error_at(model.place, "model = " + toml_string(model.text()) + "; " + kind.law);
  for (const std::string& key : kind.damping)
    if (const Value& value = body["damping"][key]; !value.is_number() || value.number() != 0)
      refuse(value, "damping." + key);
  if (const Value* springs = body.find("spring"))
    for (const Value& spring : springs->array())
      if (const Value* edges = spring.find("edges")) refuse(*edges, "spring.edges");
}

void require_proportion(const Value& thin, const char* key, double extent) {
  constexpr double kLeast = 1e-12, kMost = 1e3;
  const Value& size = thin[key];
  if (size.number() < kLeast * extent || size.number() > kMost * extent)
    throw error_at(size.place, std::string(key) + " = " + number_text(size.number()) + "; must be from " +
                                   number_text(kLeast) + " to " + number_text(kMost) + " times the extent of " +
                                   three_digits(extent) + " m (check the units)");
}

}  // namespace aspic
