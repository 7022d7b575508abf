#include "aspic/lecture/result_json.h"

#include <fmt/format.h>

#include <cmath>

namespace aspic::cli::lecture {
namespace {

using Json = nlohmann::ordered_json;

// JSON has no infinity, so exploded values are the text "inf".
Json number_json(double value) { return std::isfinite(value) ? Json(value) : Json(fmt::format("{}", value)); }

Json to_json(const Measure& m) {
  Json json = {{"what", m.what}, {"value", number_json(m.value)}, {"unit", m.unit}};
  if (m.relation == Relation::shown) return json;
  json["relation"] = to_string(m.relation);
  json["bound"] = number_json(m.bound);
  json["holds"] = m.holds();
  json["reason"] = m.reason;
  return json;
}

}  // namespace

nlohmann::ordered_json to_json(const Result& result) {
  const Demonstration& d = *result.demonstration;
  Json json = {{"key", d.key},
               {"pages", d.pages},
               {"title", d.title},
               {"claim", d.claim},
               {"passes", result.sheet.passes()},
               {"seconds", result.seconds}};
  json["measures"] = Json::array();
  for (const Measure& m : result.sheet.measures()) json["measures"].push_back(to_json(m));
  json["remarks"] = result.sheet.remarks();
  json["pictures"] = Json::array();
  for (const Figure& f : result.sheet.figures())
    json["pictures"].push_back({{"file", d.key + "/" + f.picture.filename().string()}, {"caption", f.caption}});
  return json;
}

}  // namespace aspic::cli::lecture
