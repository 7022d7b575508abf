#include "scene/painted_fields.h"

#include <algorithm>

#include "base/error.h"
#include "base/formatted.h"
#include "base/parallel.h"
#include "io/atomic_file.h"
#include "io/ply.h"
#include "mesh/doctor.h"
#include "mesh/surface_locator.h"
#include "mesh/tet_nodes.h"

namespace aspic {
namespace {

namespace fs = std::filesystem;

constexpr double kFarthestSurface = 0.5;  // maximum distance in diagonals of the surface
constexpr double kLargestSurface = 10;    // maximum diagonal in diagonals of the body

constexpr const char* kPlacement = " m (it is placed like the body's mesh; export both together, in the same units)";

double diagonal_of(const std::vector<Vec3d>& surface) {
  const Box box = bounding_box(surface);
  return norm(box.upper - box.lower);
}

// A surface in millimeters may surround the corner of a body in meters closely.
void refuse_if_larger(const std::vector<Vec3d>& surface, const TetMesh& mesh, const std::string& body) {
  const double diagonal = diagonal_of(surface), size = size_of(mesh);
  if (diagonal > kLargestSurface * size)
    throw InvalidInput("the diagonal of this surface is " + formatted("%.4g", diagonal) + " m, that of body '" + body +
                       "' is " + formatted("%.4g", size) + kPlacement);
}

}  // namespace

bool is_painted(const fs::path& path) { return path.extension() == ".ply" || path.extension() == ".PLY"; }

void refuse_if_elsewhere(const std::vector<Vec3d>& surface, double farthest, const std::string& body) {
  const double diagonal = diagonal_of(surface);
  if (farthest <= kFarthestSurface * diagonal) return;
  throw InvalidInput("body '" + body + "' is up to " + formatted("%.4g", farthest) +
                     " m away from this surface, whose diagonal is " + formatted("%.4g", diagonal) + kPlacement);
}

PaintedFields::PaintedFields(const AffineMap& place, SceneFiles& files, std::string body)
    : place_(place), files_(files), body_(std::move(body)) {}

const std::vector<double>& PaintedFields::at_vertices(Table& table, const TetMesh& mesh) {
  const Value file = *table.find("file");
  const Value* name = table.find("name");
  const fs::path path = files_.find(file);
  if (!is_painted(path))
    throw error_at(file.place, "file = " + toml_string(file.text()) + "; a painted surface is a PLY file");
  if (!name)
    throw error_at(file.place, "file = " + toml_string(file.text()) + " needs `name`, its attribute of vertices");
  const auto [known, is_new] = known_.try_emplace({path, name->text()});
  if (is_new) {
    try {
      known->second = read(path, name->text(), mesh);
    } catch (const InvalidInput& e) {
      throw error_at(file.place, "file = " + toml_string(file.text()) + ": " + e.what());
    }
  }
  check_fingerprint(table, "hash", fingerprint_of_file(path), path.string());
  std::string& kept = kept_[path];
  if (kept.empty()) kept = files_.keep(path, body_ + ".painted" + std::to_string(kept_.size()));
  table.set("file", {kept, {}});
  return known->second;
}

std::vector<double> PaintedFields::read(const fs::path& path, const std::string& name, const TetMesh& mesh) {
  PaintedSurface painted = parse_painted_ply(path.string(), read_file(path), name);
  TriMesh& surface = painted.surface;
  for (size_t v = 0; v < surface.vertices.size(); ++v) {
    surface.vertices[v] = place_(surface.vertices[v]);
    if (!(norm(surface.vertices[v]) <= kLargestCoordinate))
      throw InvalidInput("vertex " + std::to_string(v) + " is beyond 1e30 m, where distances overflow; correct it");
  }
  refuse_if_larger(surface.vertices, mesh, body_);
  if (!extension_) extension_ = std::make_unique<HarmonicExtension>(linear_parts(mesh).mesh);
  const SurfaceLocator locator(surface.vertices, surface.triangles);
  const std::vector<int>& given = extension_->given();
  std::vector<double> values(mesh.rest.size(), 0.0), distance(given.size());
  parallel_chunks(static_cast<int>(given.size()), [&](int first, int last) {
    for (int i = first; i < last; ++i) {
      const ClosestPoint closest = locator.nearest(mesh.rest[given[i]]);
      distance[i] = closest.distance;
      for (int c = 0; c < 3; ++c)
        values[given[i]] += closest.weights[c] * painted.value[surface.triangles[closest.triangle][c]];
    }
  });
  refuse_if_elsewhere(surface.vertices, *std::max_element(distance.begin(), distance.end()), body_);
  extension_->extend(values);
  return values;
}

}  // namespace aspic
