#include "bench/shapes.h"

#include <algorithm>

#include "base/error.h"
#include "io/mesh_file.h"
#include "io/tetrahedralize.h"
#include "mesh/generators.h"
#include "mesh/numbering.h"

namespace aspic::bench {
namespace {

namespace fs = std::filesystem;

constexpr int kX = 0, kY = 1, kZ = 2;
constexpr char kCgal[] = "Debian package libcgal-demo";

TetMesh filled(const Shape& shape, const Detail& detail, const fs::path& folder) {
  if (shape.file.empty()) return make_torus(0.35, 0.15, detail.edge);
  const fs::path kept = folder / (shape.name + "_" + detail.name + ".mesh");
  if (fs::exists(kept)) return read_tet_mesh(kept);
  const TetMesh mesh = tetrahedralize(folder / shape.file, {.size = detail.edge, .program = {}}).tets;
  write_mesh(kept, mesh);
  return mesh;
}

}  // namespace

const std::vector<Shape>& shapes() {
  static const std::vector<Shape> all = {
      {"torus", "generated", "", kY, {{"tiny", 0.15}, {"3k", 0.04}, {"10k", 0.026}, {"30k", 0.018}, {"100k", 0.012}}},
      {"bunny", "npm package bunny", "bunny.obj", kY, {{"3k", 0.53}, {"10k", 0.34}, {"30k", 0.23}, {"100k", 0.15}}},
      {"armadillo", kCgal, "armadillo.off", kY, {{"3k", 6.3}, {"10k", 3.9}, {"30k", 2.5}, {"100k", 1.7}}},
      {"elephant", kCgal, "elephant.off", kY, {{"3k", 0.035}, {"10k", 0.022}, {"30k", 0.0145}, {"100k", 0.0095}}},
      {"hand", kCgal, "hand.off", kZ, {{"3k", 0.058}, {"10k", 0.037}, {"30k", 0.0245}, {"100k", 0.0163}}},
      {"homer", kCgal, "homer.off", kY, {{"3k", 0.0315}, {"10k", 0.0201}, {"30k", 0.0133}, {"100k", 0.0088}}},
      {"liver", kCgal, "liver.inr.gz", kZ, {{"3k", 12.2}, {"10k", 8}, {"30k", 5.4}, {"100k", 3.5}}},
  };
  return all;
}

const Shape& shape_named(const std::string& name) {
  std::vector<std::string> names;
  for (const Shape& shape : shapes()) {
    if (shape.name == name) return shape;
    names.push_back(shape.name);
  }
  throw InvalidInput("there is no shape '" + name + "'" + suggestion(name, names));
}

bool is_available(const Shape& shape, const fs::path& folder) {
  return shape.file.empty() || fs::exists(folder / shape.file);
}

TetMesh standing_mesh(const Shape& shape, const Detail& detail, const fs::path& folder) {
  TetMesh mesh = filled(shape, detail, folder);
  mesh.region.clear();
  Vec3d lower = mesh.rest.at(0), upper = lower;
  for (const Vec3d& X : mesh.rest)
    for (int i = 0; i < 3; ++i) lower[i] = std::min(lower[i], X[i]), upper[i] = std::max(upper[i], X[i]);
  const double height = upper[shape.up] - lower[shape.up];
  for (Vec3d& X : mesh.rest) {  // a cyclic change of axes keeps the orientation
    Vec3d turned;
    for (int i = 0; i < 3; ++i) turned[(i + kY - shape.up + 3) % 3] = (X[i] - lower[i]) / height;
    X = turned;
  }
  return from_user(locality_numbering(mesh), mesh);  // numbered as in scenes
}

}  // namespace aspic::bench
