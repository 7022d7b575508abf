// The file of a fitted material: a VTU with the mesh, the name of the model and a cell field per parameter
// ("young" [Pa], "poisson" [1], ...), with "..._deviation" for standard deviations. A scene on any mesh reads it with
// material = { file = "material.vtu" }.
#pragma once
#include <filesystem>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "mesh/tet_mesh.h"

namespace aspic {

struct FittedMaterial {
  TetMesh mesh;                                                     // at rest
  std::string model;                                                // "neo_hookean"; empty: the file names none
  std::vector<std::pair<std::string, std::vector<double>>> values;  // one per tet; "young", "poisson", "density", "b"
  std::vector<std::pair<std::string, std::vector<double>>>
      further;  // standard deviations and other fields that scenes ignore

  const std::vector<double>* find(const std::string& quantity) const;  // among the values; null if absent
};

// Returns the names of the parameters of a model: young, poisson and its own. Throws InvalidInput.
std::vector<std::string> quantities_of(const std::string& model);

// Cell fields named like a parameter of a model or the density become `values`, the others `further`. Throws
// InvalidInput.
FittedMaterial read_material(const std::filesystem::path& path);
void write_material(const std::filesystem::path& path, const FittedMaterial& material);

// Throws InvalidInput with the name `file` if a parameter of the model is missing or out of range.
void check_material(const FittedMaterial& material, const std::string& model, const std::string& file);

// The tets of the material's mesh that contain given points.
struct MaterialSampling {
  std::vector<int> tet;      // tet that contains each point, or the nearest one
  int outside = 0;           // points that no tet contains
  double farthest = 0;       // largest distance of such a point from its tet [m]
  bool is_same_mesh = true;  // the points are the centroids of all tets, each once
};
MaterialSampling sampling(const FittedMaterial& material, std::span<const Vec3d> centroids);

// Returns a value per tet of `mesh`: that of the tet of the material that contains its centroid, or of the nearest.
std::vector<double> sample(const FittedMaterial& material, std::span<const double> values, const TetMesh& mesh);

}  // namespace aspic
