// What bodies without tets share: sheets and rods.
#pragma once
#include <string>
#include <vector>

#include "base/error.h"
#include "scene/body_mesh.h"

namespace aspic {

struct ThinKind {
  std::string key;                   // that makes a body thin: "shell" or "rod"
  std::string law;                   // why other models than the default are rejected
  std::vector<std::string> refused;  // keys beside those that any thin body rejects
  std::vector<std::string> damping;  // its rejected keys
};

// Rejects keys of a body that need tets. Throws InvalidInput.
void refuse_keys_of_solids(const Value& body, const ThinKind& kind);

// Rejects a thickness or radius, the key `key` of `thin`, out of proportion to the extent of the body.
void require_proportion(const Value& thin, const char* key, double extent);

// Reads the mesh of a body by `read`, and names its file in the results. Throws InvalidInput.
template <class Read>
auto thin_mesh_from_file(Value& body, MeshLoader& loader, const Read& read) {
  const Value mesh = body["mesh"];
  const std::filesystem::path path = loader.files.find(mesh);
  try {
    auto result = read(path.string());
    body.table().set("mesh", {loader.files.keep(path, body["name"].text()), {}});
    return result;
  } catch (const InvalidInput& e) {
    throw error_at(mesh.place, std::string("mesh = ") + toml_string(mesh.text()) + ": " + e.what());
  }
}

}  // namespace aspic
