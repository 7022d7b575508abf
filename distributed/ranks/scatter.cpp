#include "ranks/scatter.h"

#include <algorithm>
#include <cstring>
#include <string>
#include <type_traits>

#include "base/check.h"
#include "math/vectors.h"
#include "ranks/exchange.h"
#include "ranks/mpi_ranks.h"

namespace aspic::distributed {
namespace {

// Appends objects to bytes.
class Packer {
 public:
  std::string bytes;

  template <class T>
  void operator()(std::vector<T>& values) {
    size_t count = values.size();
    append(&count, sizeof(count));
    if constexpr (std::is_trivially_copyable_v<T>)
      append(values.data(), count * sizeof(T));
    else
      for (T& value : values) visit(*this, value);
  }
  void operator()(std::string& text) {
    size_t count = text.size();
    append(&count, sizeof(count));
    append(text.data(), count);
  }
  template <class T>
  void number(T& value) {
    append(&value, sizeof(T));
  }

 private:
  void append(const void* data, size_t size) { bytes.append(static_cast<const char*>(data), size); }
};

// Reads them in the same order.
class Unpacker {
 public:
  explicit Unpacker(std::string_view bytes) : rest_(bytes) {}

  template <class T>
  void operator()(std::vector<T>& values) {
    values.resize(count());
    if constexpr (std::is_trivially_copyable_v<T>)
      take(values.data(), values.size() * sizeof(T));
    else
      for (T& value : values) visit(*this, value);
  }
  void operator()(std::string& text) {
    text.resize(count());
    take(text.data(), text.size());
  }
  template <class T>
  void number(T& value) {
    take(&value, sizeof(T));
  }

 private:
  size_t count() {
    size_t value = 0;
    take(&value, sizeof(value));
    return value;
  }
  void take(void* data, size_t size) {
    if (size > 0) std::memcpy(data, rest_.data(), size);
    rest_.remove_prefix(size);
  }

  std::string_view rest_;
};

template <class Archive>
void visit(Archive& archive, std::string& text) {
  archive(text);
}

template <class Archive>
void visit(Archive& archive, BodyRange& body) {
  archive(body.name);
  for (int* n : {&body.first_vertex, &body.vertex_count, &body.first_tet, &body.tet_count}) archive.number(*n);
}

template <class Archive>
void visit(Archive& archive, BodyFacts& body) {
  archive.number(body.box);
  archive.number(body.heights.first);
  archive.number(body.heights.second);
}

template <class Archive>
void visit(Archive& archive, RankScene& scene) {
  MeshShare& share = scene.share;
  archive.number(share.rank);
  for (auto* list : {&share.cut, &share.vertex, &share.user_vertex, &share.user_tet, &scene.mesh.region})
    archive(*list);
  archive(share.bodies);
  archive(share.of_bodies);
  archive(scene.mesh.rest);
  archive(scene.mesh.tets);
  archive(scene.bodies);
  for (auto* list : {&scene.q, &scene.qdot, &scene.density}) archive(*list);
  archive(scene.parameters);
  archive(scene.materials);
}

// The tets that each rank needs, ascending.
std::vector<std::vector<int>> tets_of_ranks(const TetMesh& mesh, const std::vector<int>& cut) {
  std::vector<std::vector<int>> tets(cut.size() - 1);
  for (int t = 0; t < mesh.tet_count(); ++t) {
    std::array<int, 4> owner;
    for (int c = 0; c < 4; ++c)
      owner[c] = static_cast<int>(std::upper_bound(cut.begin(), cut.end(), mesh.tets[t][c]) - cut.begin()) - 1;
    std::sort(owner.begin(), owner.end());
    for (int c = 0; c < 4; ++c)
      if (c == 0 || owner[c] != owner[c - 1]) tets[owner[c]].push_back(t);
  }
  return tets;
}

std::vector<BodyFacts> facts_of(const SceneModel& whole) {
  const Vec3d gravity = whole.document.find("gravity")->vector();
  const Vec3d up = norm(gravity) > 0 ? (-1 / norm(gravity)) * gravity : Vec3d{{0, 1, 0}};
  std::vector<BodyFacts> facts;
  for (const BodyRange& body : whole.model.bodies) {
    BodyFacts& fact = facts.emplace_back();
    fact.heights = {INFINITY, -INFINITY};
    for (int v = body.first_vertex; v < body.first_vertex + body.vertex_count; ++v) {
      const Vec3d& X = whole.model.mesh.rest[v];
      fact.box.add(X);
      const double height = dot(up, X);
      fact.heights = {std::min(fact.heights.first, height), std::max(fact.heights.second, height)};
    }
  }
  return facts;
}

class Scatterer {
 public:
  explicit Scatterer(const SceneModel& whole)
      : whole_(whole),
        cut_(equal_cuts(whole.model.mesh.vertex_count(), rank_count())),
        tets_(tets_of_ranks(whole.model.mesh, cut_)),
        facts_(facts_of(whole)) {}

  RankScene part(int rank) {
    const Model& model = whole_.model;
    RankScene scene;
    scene.bodies = facts_;
    for (const Value& body : whole_.document.find("body")->array())
      scene.materials.push_back(body["material"]["model"].text());
    MeshShare& share = scene.share;
    share.rank = rank;
    share.cut = cut_;
    share.of_bodies = model.bodies;
    add_tets(std::exchange(tets_[rank], {}), scene);
    for (const int v : share.vertex) {
      share.user_vertex.push_back(model.numbering.vertex.to_user(v));
      scene.mesh.rest.push_back(model.mesh.rest[v]);
      for (int r = 0; r < 3; ++r) {
        scene.q.push_back(whole_.start.q[3 * static_cast<size_t>(v) + r]);
        scene.qdot.push_back(whole_.start.qdot[3 * static_cast<size_t>(v) + r]);
      }
    }
    return scene;
  }

 private:
  // `tets`: ascending.
  void add_tets(const std::vector<int>& tets, RankScene& scene) const {
    const Model& model = whole_.model;
    std::vector<std::vector<Tet>> corners(model.bodies.size());
    std::vector<std::vector<int>> numbers(model.bodies.size());
    size_t body = 0;
    for (const int t : tets) {
      while (t >= model.bodies[body].first_tet + model.bodies[body].tet_count) ++body;
      corners[body].push_back(model.mesh.tets[t]);
      numbers[body].push_back(t);
    }
    scene.mesh.tets = arrange(corners, numbers, scene.share);
    std::vector<std::vector<MaterialParameters>> parameters;
    for (const auto& V : model.elasticity) parameters.push_back(V->parameters());
    body = 0;
    for (int& t : scene.share.user_tet) {
      while (t >= model.bodies[body].first_tet + model.bodies[body].tet_count) ++body;
      if (!model.mesh.region.empty()) scene.mesh.region.push_back(model.mesh.region[t]);
      scene.density.push_back(model.density[t]);
      scene.parameters.push_back(parameters[body][t - model.bodies[body].first_tet]);
      t = model.numbering.tet.to_user(t);
    }
  }

  const SceneModel& whole_;
  std::vector<int> cut_;
  std::vector<std::vector<int>> tets_;
  std::vector<BodyFacts> facts_;
};

}  // namespace

RankScene scatter(const SceneModel* whole) {
  RankScene own;
  if (rank_of_this_process() > 0) {
    const std::string bytes = receive_bytes(0);
    Unpacker unpacker(bytes);
    visit(unpacker, own);
    return own;
  }
  ASPIC_CHECK(whole && whole->model.mesh.mids.empty());
  Scatterer scatterer(*whole);
  for (int rank = 1; rank < rank_count(); ++rank) {
    RankScene part = scatterer.part(rank);
    Packer packer;
    visit(packer, part);
    send_bytes(rank, packer.bytes);
  }
  return scatterer.part(0);
}

}  // namespace aspic::distributed
