// What aspic-mesh can fill with tets. Each kind of domain is one instantiation of CGAL's Mesh_3, in a file of its own
// because each takes a minute to compile. All are serial and use fixed seeds, so equal input gives equal output.
#pragma once
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "mesh/tet_mesh.h"

namespace aspic {

struct MesherOptions {
  double size = 0;                    // target edge length in units of the input; 0: bounding box diagonal / 25
  std::map<int, double> region_size;  // label -> target edge length there
  double most_tets = 1.5e5;           // predicted, where thin parts of a surface ask for smaller edges than `size`
  bool has_sharp_edges = true;        // of a surface; those of a wrap are none of the shape
};

struct FilledSurface {
  TetMesh tets;
  std::vector<std::string> notes;  // one sentence each
};

// Fills a closed surface without self-intersections; `checked_surface` gives one. `name` is the file in messages.
// Throws InvalidInput when thin parts need too many tets or the result is not the shape.
FilledSurface mesh_surface(const std::string& name, const TriMesh& surface, const MesherOptions& options);

// {f < 0} inside the box `bounds`; f in x, y, z with muParser's operators and functions.
struct ImplicitShape {
  std::string expression;
  Vec3d lower, upper;
};
TetMesh mesh_implicit(const ImplicitShape& shape, const MesherOptions& options);

// The voxels with a label other than 0 of an .inr or .inr.gz image; the labels become regions.
TetMesh mesh_image(const std::filesystem::path& image, const MesherOptions& options);

// Fills the holes whose border is at most `longest`.
TriMesh with_holes_filled(const TriMesh& surface, double longest);

// A closed surface around any triangles: holes, overlaps and inner walls disappear. `name` is the file in messages.
// Throws InvalidInput where the triangles enclose next to no volume.
struct Rebuilt {
  TriMesh surface;
  double detail = 0;  // smaller holes and grooves are closed
};
Rebuilt rebuilt(const std::string& name, const TriMesh& surface);

}  // namespace aspic
