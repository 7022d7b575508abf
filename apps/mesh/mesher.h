// Domains that aspic-mesh can fill with tets. Each kind is one instantiation of CGAL's Mesh_3, in its own file because
// each takes a minute to compile. All are serial with fixed seeds, so equal input gives equal output.
#pragma once
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "mesh/tet_mesh.h"

namespace aspic {

struct MesherOptions {
  double size = 0;                    // target edge length in units of the input; 0: bounding box diagonal / 25
  std::map<int, double> region_size;  // label -> target edge length of the region
  double most_tets = 1.5e5;           // limit of the predicted number if thin parts need edges smaller than `size`
  bool has_sharp_edges = true;        // whether to keep sharp edges of a surface; those of a wrap are artifacts
};

struct FilledSurface {
  TetMesh tets;
  std::vector<std::string> notes;  // one sentence each
};

// Fills a closed surface without self-intersections, such as the result of `checked_surface`. `name` is the file in
// messages. Throws InvalidInput if thin parts need too many tets or the result differs from the shape.
FilledSurface mesh_surface(const std::string& name, const TriMesh& surface, const MesherOptions& options);

// {f < 0} inside the box `bounds`. f is a function of x, y, z with the operators and functions of muParser.
struct ImplicitShape {
  std::string expression;
  Vec3d lower, upper;
};
TetMesh mesh_implicit(const ImplicitShape& shape, const MesherOptions& options);

// Fills the voxels with a label other than 0 of an .inr or .inr.gz image. Labels become regions.
TetMesh mesh_image(const std::filesystem::path& image, const MesherOptions& options);

// Fills the holes with a border of at most `longest`.
TriMesh with_holes_filled(const TriMesh& surface, double longest);

// Closed surface around any triangles, without their holes, overlaps and inner walls. `name` is the file in messages.
// Throws InvalidInput if the triangles enclose almost no volume.
struct Rebuilt {
  TriMesh surface;
  double detail = 0;  // width below which holes and grooves are closed
};
Rebuilt rebuilt(const std::string& name, const TriMesh& surface);

}  // namespace aspic
