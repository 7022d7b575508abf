#include "scene/surface_motion.h"

#include <algorithm>
#include <array>
#include <map>

#include "base/error.h"
#include "io/mesh_file.h"
#include "mesh/doctor.h"
#include "mesh/surface_locator.h"
#include "mesh/triangle_shape.h"
#include "scene/painted_fields.h"
#include "scene/recording.h"

namespace aspic {
namespace {

// Orthonormal columns that rotate with the triangle; zero for a degenerate one.
Mat3d frame(const TriangleCorners& x) {
  if (is_degenerate(x)) return {};
  const Vec3d edge = x[1] - x[0], normal = cross(edge, x[2] - x[0]);
  const Vec3d u = (1 / norm(edge)) * edge, n = (1 / norm(normal)) * normal;
  return from_columns(u, cross(n, u), n);
}

// A point near a triangle of the surface.
struct Follower {
  Triangle vertices;
  std::array<double, 3> weights;  // of the closest point
  Vec3d offset;                   // from there, at rest [m]
  Vec3d local;                    // the offset in the frame of the triangle; zero without a frame

  Vec3d at(const Recording& recording, double time) const {
    TriangleCorners x;
    recording.interpolate(vertices, time, x);
    const Vec3d p = weights[0] * x[0] + weights[1] * x[1] + weights[2] * x[2];
    const bool has_frame = dot(local, local) > 0 && !is_degenerate(x);
    return p + (has_frame ? frame(x) * local : offset);
  }
};

TriMesh placed_surface(Table& table, const AffineMap& place, const std::string& stem, SceneFiles& files) {
  const Value mesh = *table.find("mesh");
  const std::filesystem::path path = files.find(mesh);
  try {
    TriMesh surface = read_tri_mesh(path);
    for (Vec3d& X : surface.vertices) {
      X = place(X);
      if (!(norm(X) <= kLargestCoordinate)) throw InvalidInput("a vertex is beyond 1e30 m, where distances overflow");
    }
    check_fingerprint(table, "mesh_hash", fingerprint_of_file(path), path.string());
    table.set("mesh", {files.keep(path, stem), {}});
    return surface;
  } catch (const InvalidInput& e) {
    throw error_at(mesh.place, std::string("mesh = ") + toml_string(mesh.text()) + ": " + e.what());
  }
}

// A surface at rest with the points that follow it.
class FollowedSurface {
 public:
  FollowedSurface(TriMesh surface, std::shared_ptr<const Recording> recording)
      : surface_(std::move(surface)),
        recording_(std::move(recording)),
        locator_(surface_.vertices, surface_.triangles) {}
  FollowedSurface(const FollowedSurface&) = delete;
  FollowedSurface& operator=(const FollowedSurface&) = delete;

  // Returns the distance from the surface.
  double add(const Vec3d& rest, const Vec3d& start) {
    const ClosestPoint closest = locator_.nearest(rest);
    known_.emplace(key(start), follower(rest, closest));
    return closest.distance;
  }
  Vec3d position(const Vec3d& start, double time) const {
    const auto known = known_.find(key(start));
    if (known != known_.end()) return known->second.at(*recording_, time);
    return follower(start, locator_.nearest(start)).at(*recording_, time);  // of a point that was added later
  }

 private:
  static std::array<double, 3> key(const Vec3d& x) { return {x[0], x[1], x[2]}; }
  Follower follower(const Vec3d& rest, const ClosestPoint& closest) const {
    const Triangle& t = surface_.triangles[closest.triangle];
    const TriangleCorners X = {surface_.vertices[t[0]], surface_.vertices[t[1]], surface_.vertices[t[2]]};
    const Vec3d offset = rest - closest.position;
    return {t, closest.weights, offset, transpose(frame(X)) * offset};
  }

  TriMesh surface_;
  std::shared_ptr<const Recording> recording_;
  SurfaceLocator locator_;
  std::map<std::array<double, 3>, Follower> known_;  // by position at time 0
};

}  // namespace

Motion make_surface_motion(Table& table, const FollowingPoints& points, SceneFiles& files) {
  const Place place = table.find("mesh")->place;
  TriMesh surface = placed_surface(table, points.place, points.stem, files);
  const std::vector<Vec3d> vertices = surface.vertices;
  auto recording = read_recording(table, points.place, vertices.size(), files, points.stem);
  const auto followed = std::make_shared<FollowedSurface>(std::move(surface), std::move(recording));
  double farthest = 0;
  for (size_t i = 0; i < points.rest.size(); ++i)
    farthest = std::max(farthest, followed->add(points.rest[i], points.starts[i]));
  try {
    refuse_if_elsewhere(vertices, farthest, points.body);
  } catch (const InvalidInput& e) {
    throw error_at(place, std::string("mesh: ") + e.what());
  }
  return [followed](const Vec3d& start, double time) { return followed->position(start, time); };
}

}  // namespace aspic
