#include "material/registry.h"

#include "material/list.h"

namespace aspic {

const std::vector<MaterialInfo>& materials() {
  static const std::vector<MaterialInfo> all = [] {
    std::vector<MaterialInfo> list;
    for_each_material([&]<class M>() { list.push_back(M::info()); });
    return list;
  }();
  return all;
}

const MaterialInfo& material_info(std::string_view name) {
  std::vector<std::string> known;
  for (const MaterialInfo& info : materials()) {
    if (info.name == name) return info;
    known.push_back(info.name);
  }
  throw InvalidInput("material '" + std::string(name) + "' is unknown" + suggestion(name, known));
}

}  // namespace aspic
