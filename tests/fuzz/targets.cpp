#include "targets.h"

#include <algorithm>
#include <array>

namespace aspic::fuzz {

std::span<const Target> targets() {
  static constexpr auto kTargets = std::to_array<Target>({
      {"gmsh", gmsh},
      {"gmsh_slices", gmsh_slices},
      {"medit", medit},
      {"tetgen", tetgen},
      {"vtu", vtu},
      {"vtk", vtk},
      {"obj", obj},
      {"off", off},
      {"ply", ply},
      {"stl", stl},
      {"gltf", gltf},
      {"doctor", doctor},
      {"gzip", gzip},
      {"base64", base64},
      {"xml", xml},
      {"csv", csv},
      {"checkpoint", checkpoint},
      {"point_cache", point_cache},
      {"run_folder", run_folder},
      {"run_recording", run_recording},
      {"material", material},
#ifdef ASPIC_HAS_FIT
      {"journal", journal},
      {"data_set", data_set},
      {"motion_table", motion_table},
#endif
      {"toml", toml},
      {"scene", scene},
      {"obstacle", obstacle},
      {"thin", thin},
      {"values", values},
      {"expression", expression},
      {"overrides", overrides},
      {"page_text", page_text},
      {"session", session},
  });
  return kTargets;
}

const Target* target_named(std::string_view name) {
  const std::span<const Target> all = targets();
  const auto found = std::find_if(all.begin(), all.end(), [&](const Target& target) { return target.name == name; });
  return found == all.end() ? nullptr : &*found;
}

}  // namespace aspic::fuzz
