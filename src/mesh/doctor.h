// Examines meshes for errors and suspicious values. Each finding has a name, the indices and a remedy.
#pragma once
#include <string>
#include <vector>

#include "mesh/tet_mesh.h"

namespace aspic {

enum class Severity { error, warning, note };  // an error stops a simulation

// Coordinate limit [m] beyond which volumes and angles overflow. Larger meshes cannot be examined.
inline constexpr double kLargestCoordinate = 1e30;

struct Finding {
  Severity severity = Severity::note;
  std::string name;          // "inverted_tets", "zero_volume_tets", "slivers", "duplicate_vertices", ...
  std::string message;       // one sentence with the count and the worst value
  std::string remedy;        // recommended action; "--repair" if that helps
  std::vector<int> indices;  // affected elements, vertices or triangles
};

struct MeshQuality {
  double min_volume = 0, max_volume = 0, total_volume = 0;  // [m^3]
  double min_dihedral = 0, max_dihedral = 0;                // [degrees]
  double min_mean_ratio = 0, average_mean_ratio = 0;        // 1: regular; 0: flat
  std::vector<int> mean_ratio_histogram;                    // 10 bins of [0, 1]
  int components = 0;
  Vec3d lower{}, upper{};  // bounding box [m]
};

std::vector<Finding> diagnose(const TetMesh& mesh);
std::vector<Finding> diagnose(const TriMesh& mesh);  // open, non-manifold, self-intersecting, orientation, degenerate
bool is_sheet(const TriMesh& mesh);                  // planar, or with a border so long that it encloses little
MeshQuality quality(const TetMesh& mesh);

// Performs the unambiguous repairs: flips inverted tets, removes zero-volume tets, merges duplicate vertices and
// removes unreferenced ones. Returns one sentence per action, or nothing if the mesh is unchanged.
std::vector<std::string> repair(TetMesh& mesh);
std::vector<std::string> repair(TriMesh& mesh);

bool has_errors(const std::vector<Finding>& findings);

}  // namespace aspic
