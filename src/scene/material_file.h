// A material that was fitted, as a file: a VTU with the mesh, the name of the model and one cell field per quantity
// ("young" [Pa], "poisson" [1], ...), with "..._deviation" beside what is uncertain. ParaView opens it; a scene takes
// it as material = { file = "material.vtu" }, on whatever mesh.
#pragma once
#include <filesystem>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "mesh/tet_mesh.h"

namespace aspic {

struct FittedMaterial {
  TetMesh mesh;                                                      // at rest
  std::string model;                                                 // "neo_hookean"
  std::vector<std::pair<std::string, std::vector<double>>> values;   // one per tet; "young", "poisson", "density", "b"
  std::vector<std::pair<std::string, std::vector<double>>> further;  // deviations and the like, for people
};

FittedMaterial read_material(const std::filesystem::path& path);  // throws InvalidInput
void write_material(const std::filesystem::path& path, const FittedMaterial& material);

// The value at each tet of another mesh in the same place: that of the tet in which its centroid lies, or the nearest.
std::vector<double> sample(const FittedMaterial& material, std::span<const double> values, const TetMesh& mesh);

}  // namespace aspic
