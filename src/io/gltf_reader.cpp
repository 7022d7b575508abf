#include "io/gltf_reader.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>
#include <utility>

#include "io/atomic_file.h"
#include "io/gltf_animation.h"
#include "io/vertex_merger.h"

namespace aspic {
namespace {

using Json = GltfFile::Json;

constexpr uint64_t kTriangles = 4;         // mode of a primitive
constexpr double kWeightTolerance = 0.02;  // of sums of weights, which may be bytes
constexpr size_t kNone = SIZE_MAX;

// x -> linear x + translation
struct Placement {
  Mat3d linear = identity3<double>();
  Vec3d translation = {};

  Vec3d operator()(const Vec3d& x) const { return linear * x + translation; }
};

Placement operator*(const Placement& outer, const Placement& inner) {
  return {outer.linear * inner.linear, outer(inner.translation)};
}

Placement placement_of(const GltfTransform& node) {
  const auto& [x, y, z, w] = node.rotation;
  Mat3d linear = {{1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w),  //
                   2 * (x * y - z * w), 1 - 2 * (x * x + z * z), 2 * (y * z + x * w),  //
                   2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y)}};
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) linear(r, c) *= node.scale[static_cast<size_t>(c)];
  return {linear, {{node.translation[0], node.translation[1], node.translation[2]}}};
}

// `m`: 16 numbers, column by column.
Placement placement_of(const double* m) {
  return {{{m[0], m[1], m[2], m[4], m[5], m[6], m[8], m[9], m[10]}}, {{m[12], m[13], m[14]}}};
}

bool is_affine(const double* m) { return m[3] == 0 && m[7] == 0 && m[11] == 0 && std::abs(m[15] - 1) < 1e-6; }

// The meshes of the default scene. A vertex is the weighted mean of its images under maps: of its node, or of joints.
class GltfSurface {
 public:
  explicit GltfSurface(GltfFile& file, bool reads_texture = false)
      : file_(file), reads_texture_(reads_texture), transforms_(file.list("nodes").size()) {
    slot_of_.resize(transforms_.size(), kNone);
    std::vector<std::pair<uint64_t, size_t>> pending;
    add_nodes(file.list(file.scene(), "nodes"), kNone, pending);
    while (!pending.empty()) {
      const std::pair<uint64_t, size_t> next = pending.back();
      pending.pop_back();
      add_node(next.first, next.second);
      add_nodes(file.list(file.item("nodes", next.first), "children"), nodes_.size() - 1, pending);
    }
    const std::vector<Placement> rest = places(transforms_);
    for (size_t slot = 0; slot < nodes_.size(); ++slot) add_mesh(slot, rest);
  }

  const std::vector<GltfTransform>& transforms() const { return transforms_; }  // at rest, of all nodes
  const std::vector<Triangle>& triangles() const { return triangles_; }
  const std::vector<TriangleCorners>& texture() const { return texture_; }  // of the triangles that have any
  size_t vertex_count() const { return points_.size(); }
  size_t map_count() const { return nodes_.size() + maps_.size(); }
  size_t influence_count() const { return influences_.size(); }

  std::vector<Vec3d> vertices(const std::vector<GltfTransform>& transforms) const {
    const std::vector<Placement> place = places(transforms);
    std::vector<Placement> images;
    for (const Map& map : maps_) images.push_back(place[map.slot] * map.before);
    std::vector<Vec3d> x(points_.size());
    for (size_t v = 0; v < x.size(); ++v) {
      for (size_t i = first_[v]; i < first_[v + 1]; ++i)
        x[v] = x[v] + influences_[i].weight * images[influences_[i].map](points_[v]);
      if (!std::isfinite(x[v][0] + x[v][1] + x[v][2])) file_.fail("vertex " + std::to_string(v) + " is not finite");
    }
    return x;
  }

 private:
  struct Node {
    uint64_t index;
    size_t parent;                    // slot; kNone: the scene
    std::optional<Placement> matrix;  // instead of a transform
  };
  struct Map {
    size_t slot;
    Placement before;  // the inverse bind matrix of a joint
  };
  struct Maps {
    size_t first, count;
  };
  struct Influence {
    size_t map;
    double weight;
  };

  void add_nodes(const Json& nodes, size_t parent, std::vector<std::pair<uint64_t, size_t>>& pending) const {
    for (const Json& node : nodes) {
      if (!node.is_number_unsigned() || node.get<uint64_t>() >= transforms_.size())
        file_.fail("a list of nodes names none of the " + std::to_string(transforms_.size()));
      pending.emplace_back(node.get<uint64_t>(), parent);
    }
    if (pending.size() > transforms_.size()) file_.fail("a node has two parents");
  }

  void add_node(uint64_t index, size_t parent) {
    const std::string owner = GltfFile::name("nodes", index);
    if (slot_of_[index] != kNone) file_.fail(owner + " has two parents");
    slot_of_[index] = nodes_.size();
    const Json& node = file_.item("nodes", index);
    nodes_.push_back({index, parent, {}});
    GltfTransform& own = transforms_[index];
    own.translation = file_.numbers(node, "translation", own.translation);
    own.rotation = file_.numbers(node, "rotation", own.rotation);
    own.scale = file_.numbers(node, "scale", own.scale);
    if (!node.contains("matrix")) return;
    const auto m = file_.numbers<16>(node, "matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1});
    if (!is_affine(m.data())) file_.fail("matrix of " + owner + " is not affine");
    nodes_.back().matrix = placement_of(m.data());
  }

  // Returns the places of the nodes in the scene. Parents come before their children.
  std::vector<Placement> places(const std::vector<GltfTransform>& transforms) const {
    std::vector<Placement> place;
    for (const Node& node : nodes_) {
      const Placement own = node.matrix ? *node.matrix : placement_of(transforms[node.index]);
      place.push_back(node.parent == kNone ? own : place[node.parent] * own);
    }
    return place;
  }

  void add_mesh(size_t slot, const std::vector<Placement>& rest) {
    const Json& node = file_.item("nodes", nodes_[slot].index);
    if (!node.contains("mesh")) return;
    const uint64_t mesh = file_.integer(node, "mesh", "a node");
    const bool has_skin = node.contains("skin");
    const Maps maps = has_skin ? add_skin(file_.integer(node, "skin", "a node")) : Maps{maps_.size(), 1};
    if (!has_skin) maps_.push_back({slot, {}});
    VertexMerger merger;
    for (const Json& primitive : file_.list(file_.item("meshes", mesh), "primitives")) {
      const uint64_t mode = file_.integer(primitive, "mode", "a primitive", kTriangles);
      if (mode < kTriangles) continue;  // points and lines
      const std::string owner = GltfFile::name("meshes", mesh);
      if (mode > kTriangles) file_.fail(owner + " has strips or fans", "triangulate it");
      const Json* attributes = GltfFile::member(primitive, "attributes");
      if (!attributes) file_.fail(owner + " has no attributes");
      const std::vector<double> points = file_.reals(file_.integer(*attributes, "POSITION", owner), "VEC3");
      std::vector<std::vector<Influence>> influences(points.size() / 3);
      if (has_skin) add_influences(*attributes, owner, maps, influences);
      std::vector<int> vertices;
      for (size_t i = 0; i < influences.size(); ++i) {
        vertices.push_back(merger.vertex({{points[3 * i], points[3 * i + 1], points[3 * i + 2]}}, points_));
        if (first_.size() > points_.size()) continue;  // merged with an earlier one
        if (!has_skin) influences_.push_back({maps.first, 1});
        influences_.insert(influences_.end(), influences[i].begin(), influences[i].end());
        first_.push_back(influences_.size());
      }
      const Map& map = maps_[has_skin && !influences.empty() ? influences[0][0].map : maps.first];
      std::vector<size_t> corners = corners_of(primitive, vertices.size());
      if (determinant((rest[map.slot] * map.before).linear) < 0)  // mirrored
        for (size_t i = 2; i < corners.size(); i += 3) std::swap(corners[i - 1], corners[i]);
      for (size_t i = 0; i < corners.size(); i += 3)
        triangles_.push_back({vertices[corners[i]], vertices[corners[i + 1]], vertices[corners[i + 2]]});
      if (reads_texture_ && attributes->contains("TEXCOORD_0")) add_texture(*attributes, owner, corners);
    }
  }

  // Adds the maps of the joints.
  Maps add_skin(uint64_t index) {
    const auto known = maps_of_skin_.find(index);
    if (known != maps_of_skin_.end()) return known->second;
    const Json& skin = file_.item("skins", index);
    const std::string owner = GltfFile::name("skins", index);
    const Json& joints = file_.list(skin, "joints");
    if (joints.empty()) file_.fail(owner + " has no joints");
    std::vector<double> inverse;
    if (skin.contains("inverseBindMatrices"))
      inverse = file_.reals(file_.integer(skin, "inverseBindMatrices", owner), "MAT4");
    if (!inverse.empty() && inverse.size() < 16 * joints.size())
      file_.fail(owner + " has " + std::to_string(joints.size()) + " joints, but " +
                 std::to_string(inverse.size() / 16) + " inverse bind matrices");
    for (size_t j = 0; j < joints.size(); ++j) {
      const uint64_t node = joints[j].is_number_unsigned() ? joints[j].get<uint64_t>() : kNone;
      if (node >= slot_of_.size() || slot_of_[node] == kNone)
        file_.fail("joint " + std::to_string(j) + " of " + owner + " is no node of the scene");
      const double* m = inverse.empty() ? nullptr : &inverse[16 * j];
      if (m && !is_affine(m)) file_.fail("an inverse bind matrix of " + owner + " is not affine");
      maps_.push_back({slot_of_[node], m ? placement_of(m) : Placement{}});
    }
    return maps_of_skin_[index] = {maps_.size() - joints.size(), joints.size()};
  }

  // Reads JOINTS_0, WEIGHTS_0 and further sets, and normalizes the weights.
  void add_influences(const Json& attributes, const std::string& owner, Maps maps,
                      std::vector<std::vector<Influence>>& influences) const {
    for (int set = 0; set == 0 || attributes.contains("JOINTS_" + std::to_string(set)); ++set) {
      const std::string suffix = std::to_string(set), joints_key = "JOINTS_" + suffix, key = "WEIGHTS_" + suffix;
      const std::vector<double> joints = file_.indices(file_.integer(attributes, joints_key.c_str(), owner), "VEC4");
      const std::vector<double> weights = file_.reals(file_.integer(attributes, key.c_str(), owner), "VEC4");
      if (joints.size() != 4 * influences.size() || weights.size() != joints.size())
        file_.fail(joints_key + " and " + key + " of " + owner + " do not have a row per vertex");
      for (size_t i = 0; i < weights.size(); ++i) {
        if (weights[i] == 0) continue;
        if (weights[i] < 0 || joints[i] >= static_cast<double>(maps.count))
          file_.fail("vertex " + std::to_string(i / 4) + " of " + owner + " has the weight " +
                     std::to_string(weights[i]) + " at joint " + std::to_string(static_cast<uint64_t>(joints[i])) +
                     " of " + std::to_string(maps.count));
        influences[i / 4].push_back({maps.first + static_cast<size_t>(joints[i]), weights[i]});
      }
    }
    for (size_t v = 0; v < influences.size(); ++v) {
      double sum = 0;
      for (const Influence& influence : influences[v]) sum += influence.weight;
      if (!(std::abs(sum - 1) <= kWeightTolerance))
        file_.fail("the weights of vertex " + std::to_string(v) + " of " + owner + " have the sum " +
                       std::to_string(sum) + " instead of 1",
                   "normalize them");
      for (Influence& influence : influences[v]) influence.weight /= sum;
    }
  }

  // Returns three vertices of the primitive per triangle.
  std::vector<size_t> corners_of(const Json& primitive, size_t vertices) const {
    std::vector<size_t> corners(vertices);
    std::iota(corners.begin(), corners.end(), size_t{0});
    if (primitive.contains("indices")) {
      const uint64_t accessor = file_.integer(primitive, "indices", "a primitive");
      corners.clear();
      for (const double corner : file_.indices(accessor, "SCALAR")) {
        if (corner >= static_cast<double>(vertices))
          file_.fail(GltfFile::name("accessors", accessor) + " names vertex " +
                     std::to_string(static_cast<uint64_t>(corner)) + " of " + std::to_string(vertices));
        corners.push_back(static_cast<size_t>(corner));
      }
    }
    if (corners.size() % 3 != 0) file_.fail("the corners of a mesh are no multiple of 3");
    return corners;
  }

  // v points down in glTF.
  void add_texture(const Json& attributes, const std::string& owner, const std::vector<size_t>& corners) {
    const std::vector<double> uv = file_.reals(file_.integer(attributes, "TEXCOORD_0", owner), "VEC2");
    for (size_t i = 0; i < corners.size(); ++i) {
      if (2 * corners[i] >= uv.size()) file_.fail("TEXCOORD_0 of " + owner + " does not have a row per vertex");
      if (i % 3 == 0) texture_.emplace_back();
      texture_.back()[i % 3] = {{uv[2 * corners[i]], 1 - uv[2 * corners[i] + 1], 0}};
    }
  }

  GltfFile& file_;
  bool reads_texture_;
  std::vector<GltfTransform> transforms_;
  std::vector<size_t> slot_of_;  // of each node, in nodes_
  std::vector<Node> nodes_;      // of the scene
  std::vector<Map> maps_;
  std::map<uint64_t, Maps> maps_of_skin_;
  std::vector<Vec3d> points_;
  std::vector<size_t> first_ = {0};  // of each vertex, in influences_
  std::vector<Influence> influences_;
  std::vector<Triangle> triangles_;
  std::vector<TriangleCorners> texture_;
};

}  // namespace

std::string read_self_contained(const std::filesystem::path& path) {
  std::string contents = read_file(path);
  const std::string extension = path.extension().string();
  if (extension != ".gltf" && extension != ".GLTF" && extension != ".glb" && extension != ".GLB") return contents;
  bool has_others = false;
  const GltfFile gltf(path.string(), contents, [&](const std::string& name) {
    has_others = true;
    return read_file(path.parent_path() / name);
  });
  return has_others ? gltf.self_contained() : contents;
}

MeshContent parse_gltf(const std::string& file, std::string_view contents, const ReadBeside& read_beside) {
  GltfFile gltf(file, contents, read_beside);
  const GltfSurface surface(gltf);
  return {surface.vertices(surface.transforms()), {}, {}, surface.triangles()};
}

std::vector<TriangleCorners> parse_gltf_texture(const std::string& file, std::string_view contents,
                                                const ReadBeside& read_beside) {
  GltfFile gltf(file, contents, read_beside);
  const GltfSurface surface(gltf, true);
  if (!surface.texture().empty() && surface.texture().size() != surface.triangles().size())
    gltf.fail("some triangles have no TEXCOORD_0", "unwrap all meshes");
  return surface.texture();
}

GltfMotion parse_gltf_motion(const std::string& file, std::string_view contents, const ReadBeside& read_beside,
                             const GltfSampling& sampling) {
  constexpr double kMostSamples = 1e5, kMostPoints = (1 << 30) / sizeof(Vec3d);
  GltfFile gltf(file, contents, read_beside);
  const GltfSurface surface(gltf);
  const GltfAnimation animation(gltf, sampling.animation);
  const double duration = animation.duration(), samples = std::ceil(duration * sampling.rate - 1e-6) + 1;
  // Influences need time, but no memory.
  const auto points = static_cast<double>(surface.vertex_count() + surface.map_count() + animation.channel_count() +
                                          surface.influence_count() / 8);
  if (!(samples <= kMostSamples && samples * points <= kMostPoints))
    gltf.fail("the animation of " + Json(duration).dump() + " s has " + Json(samples).dump() + " samples of " +
                  std::to_string(surface.vertex_count()) + " vertices; at most 100000 and 1 GiB are read",
              "shorten it, or lower fps");
  GltfMotion motion;
  std::vector<GltfTransform> transforms = surface.transforms();
  for (int k = 0; k < static_cast<int>(samples); ++k) {
    motion.times.push_back(std::min(k / sampling.rate, duration));
    animation.apply(motion.times.back(), transforms);
    motion.vertices.push_back(surface.vertices(transforms));
  }
  return motion;
}

}  // namespace aspic
