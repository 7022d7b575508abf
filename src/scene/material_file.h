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
  std::string model;                                                 // "neo_hookean"; empty: the file names none
  std::vector<std::pair<std::string, std::vector<double>>> values;   // one per tet; "young", "poisson", "density", "b"
  std::vector<std::pair<std::string, std::vector<double>>> further;  // deviations and the like, for people

  const std::vector<double>* find(const std::string& quantity) const;  // among the values; null when absent
};

// The quantities that a material of this model is made of: young, poisson and its own. Throws InvalidInput.
std::vector<std::string> quantities_of(const std::string& model);

// Every cell field of one component that a model or the density is made of is a value, the others are further ones.
// Throws InvalidInput.
FittedMaterial read_material(const std::filesystem::path& path);
void write_material(const std::filesystem::path& path, const FittedMaterial& material);

// Throws InvalidInput, which names `file`, when a quantity of the model is missing or a value is out of range.
void check_material(const FittedMaterial& material, const std::string& model, const std::string& file);

// In which tet of the material's mesh points lie.
struct MaterialSampling {
  std::vector<int> tet;      // that contains each point, or is nearest to it
  int outside = 0;           // points that no tet contains
  double farthest = 0;       // of those from the nearest tet [m]
  bool is_same_mesh = true;  // every tet is asked for at its own centroid, and once
};
MaterialSampling sampling(const FittedMaterial& material, std::span<const Vec3d> centroids);

// The value at each tet of another mesh in the same place: that of the tet in which its centroid lies, or the nearest.
std::vector<double> sample(const FittedMaterial& material, std::span<const double> values, const TetMesh& mesh);

}  // namespace aspic
