#include "viewer/scene_json.h"

#include <cmath>

namespace aspic::viewer {

Json json_of(const Vec3d& x) { return {x[0], x[1], x[2]}; }

Json tip_json(const Tip& tip) {
  return {{"shape", tip.shape == TipShape::disc ? "disc" : "sphere"},
          {"contact", tip.contact == TipContact::sliding ? "sliding" : "bonded"},
          {"radius", tip.radius},
          {"stiffness", tip.stiffness}};
}

Json fields_json(const std::vector<Field>& fields) {
  Json list = Json::array();
  for (const Field& field : fields)
    list.push_back({{"name", field.name},
                    {"label", field.label},
                    {"unit", field.unit},
                    {"diverging", field.is_diverging},
                    {"center", field.center},
                    {"log", field.is_log}});
  return list;
}

Vec3d up_of(const Table& document) {
  const Vec3d gravity = document.find("gravity")->vector();
  const double size = norm(gravity);
  return size > 0 ? (-1 / size) * gravity : Vec3d{{0, 1, 0}};
}

}  // namespace aspic::viewer
