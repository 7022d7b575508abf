#include "ranks/mesh_slices.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "base/error.h"
#include "math/vectors.h"
#include "mesh/doctor.h"
#include "mesh/order.h"
#include "ranks/exchange.h"
#include "ranks/guarded.h"
#include "ranks/message_size.h"
#include "ranks/mpi_ranks.h"
#include "scene/placement.h"

namespace aspic::distributed {
namespace {

// A vertex on the Hilbert curve of its body. Bodies follow each other.
struct Key {
  std::uint64_t code = 0;  // along the curve
  std::int32_t body = 0;
  std::int32_t user = 0;  // user's number in the whole mesh
  Vec3d X = {};

  friend bool operator<(const Key& a, const Key& b) {
    if (a.body != b.body) return a.body < b.body;
    return a.code != b.code ? a.code < b.code : a.user < b.user;
  }
};

// A vertex by its number in the whole mesh, or of the user.
struct Named {
  Vec3d X;
  std::int32_t number = 0, unused = 0;
};

struct TetOnCurve {
  std::uint64_t code = 0;  // along the curve of the centroids of its body
  std::int32_t body = 0;
  std::int32_t user = 0;  // user's number in the whole mesh
  Tet tet = {};           // vertices of the whole mesh

  friend bool operator<(const TetOnCurve& a, const TetOnCurve& b) {
    if (a.body != b.body) return a.body < b.body;
    return a.code != b.code ? a.code < b.code : a.user < b.user;
  }
};

struct Body {
  const SlicedBody& mesh;
  AffineMap map;
  BodyRange range;   // in the whole mesh
  Box box = {};      // of the placed vertices
  Box centers = {};  // of the centroids of its tets
  std::pair<double, double> heights = {INFINITY, -INFINITY};

  std::vector<Vec3d> placed(std::vector<Vec3d> points) const {
    place(map, points);
    return points;
  }
};

double cube_size(const Box& box) {
  return std::max({box.upper[0] - box.lower[0], box.upper[1] - box.lower[1], box.upper[2] - box.lower[2]});
}

std::vector<Body> bodies_of(const Table& document, const SlicedBodies& meshes) {
  std::vector<Body> bodies;
  BodyRange range;
  for (const Value& scene : document.find("body")->array()) {
    const SlicedBody& mesh = *meshes[bodies.size()];
    range.first_vertex += range.vertex_count;
    range.first_tet += range.tet_count;
    range.name = scene["name"].text();
    range.vertex_count = static_cast<int>(mesh.vertex_count());
    range.tet_count = static_cast<int>(mesh.tet_count());
    bodies.push_back({mesh, placement_of(scene), range});
  }
  return bodies;
}

// Calls visit(body, first, count) for the part of each body in [first, last) of the vertices, or the tets, of all.
template <class Visit>
void for_each_part(std::vector<Body>& bodies, int BodyRange::*first_of, int BodyRange::*count_of,
                   std::pair<int, int> all, const Visit& visit) {
  for (Body& body : bodies) {
    const int begin = body.range.*first_of, end = begin + body.range.*count_of;
    const int first = std::max(begin, all.first), last = std::min(end, all.second);
    if (first < last) visit(body, first - begin, last - first);
  }
}

// Replaces boxes by the smallest ones that contain those of all ranks.
void merge_over_ranks(const std::vector<Box*>& boxes) {
  std::vector<double> ends;
  for (const Box* box : boxes)
    for (int axis = 0; axis < 3; ++axis) ends.insert(ends.end(), {-box->lower[axis], box->upper[axis]});
  max_over_ranks(ends);
  const double* end = ends.data();
  for (Box* box : boxes)
    for (int axis = 0; axis < 3; ++axis) {
      box->lower[axis] = -*end++;
      box->upper[axis] = *end++;
    }
}

class Slicer {
 public:
  Slicer(const Table& document, const SlicedBodies& meshes)
      : bodies_(bodies_of(document, meshes)), ranks_(rank_count()) {
    const BodyRange& last = bodies_.back().range;
    share_.rank = rank_of_this_process();
    share_.cut = equal_cuts(last.first_vertex + last.vertex_count, ranks_);
    for (const Body& body : bodies_) share_.of_bodies.push_back(body.range);
    const Vec3d gravity = document.find("gravity")->vector();
    up_ = norm(gravity) > 0 ? (-1 / norm(gravity)) * gravity : Vec3d{{0, 1, 0}};
  }

  RankScene make() {
    read_vertices();
    own_ = own_keys();
    slice_.clear();
    number_slice();
    std::vector<std::vector<Tet>> tets(bodies_.size());
    std::vector<std::vector<int>> numbers(bodies_.size());
    for (const TetOnCurve& t : own_tets()) {
      tets[t.body].push_back(t.tet);
      numbers[t.body].push_back(t.user);
    }
    RankScene scene;
    scene.mesh.tets = arrange(tets, numbers, share_);
    name_vertices(scene);
    set_regions(scene.mesh);
    scene.share = std::move(share_);
    add_facts(scene);
    return scene;
  }

  // Every defect concerns a vertex or a face, and the owner of one of its vertices has all tets there.
  void require_sound(const RankScene& scene) const {
    for (size_t b = 0; b < bodies_.size(); ++b) {
      if (!bodies_[b].mesh.is_file()) continue;
      const TetMesh part = part_of(scene, b);
      if (part.rest.empty()) continue;
      std::string names;
      for (const Finding& f : diagnose(part))
        if (f.severity == Severity::error) names += (names.empty() ? "" : ", ") + f.name;
      if (!names.empty())
        throw InvalidInput("body '" + bodies_[b].range.name + "': its mesh has " + names +
                           "; list them with aspic check MESH, and mend them with --repair");
    }
  }

 private:
  std::pair<int, int> slice() const { return {share_.first(), share_.first() + share_.own()}; }

  // Each rank places a slice of the user's order. The curves fill the bounding cubes of all vertices.
  void read_vertices() {
    all_succeed([&] {
      for_each_part(bodies_, &BodyRange::first_vertex, &BodyRange::vertex_count, slice(),
                    [&](Body& body, int first, int count) {
                      for (const Vec3d& X : body.placed(body.mesh.vertices(first, count))) {
                        slice_.push_back(X);
                        body.box.add(X);
                        const double height = dot(up_, X);
                        body.heights = {std::min(body.heights.first, height), std::max(body.heights.second, height)};
                      }
                    });
    });
    std::vector<Box*> boxes;
    std::vector<double> ends;
    for (Body& body : bodies_) {
      boxes.push_back(&body.box);
      ends.insert(ends.end(), {-body.heights.first, body.heights.second});
    }
    merge_over_ranks(boxes);
    max_over_ranks(ends);
    for (size_t b = 0; b < bodies_.size(); ++b) bodies_[b].heights = {-ends[2 * b], ends[2 * b + 1]};
  }

  // Returns the keys of the own vertices, ascending: a sort over all ranks into equal pieces.
  std::vector<Key> own_keys() {
    std::vector<Key> keys;
    for_each_part(bodies_, &BodyRange::first_vertex, &BodyRange::vertex_count, slice(),
                  [&](Body& body, int first, int count) {
                    for (int v = first; v < first + count; ++v) {
                      const Vec3d& X = slice_[keys.size()];
                      keys.push_back({hilbert_index(X, body.box.lower, cube_size(body.box)),
                                      static_cast<int>(&body - bodies_.data()), body.range.first_vertex + v, X});
                    }
                  });
    std::sort(keys.begin(), keys.end());
    std::vector<int> counts;
    auto begin = keys.begin();
    for (const Key& first : first_keys(keys)) {
      const auto end = std::lower_bound(begin, keys.end(), first);
      counts.push_back(message_size(static_cast<size_t>(end - begin)));
      begin = end;
    }
    counts.push_back(message_size(static_cast<size_t>(keys.end() - begin)));
    std::vector<Key> own = exchange<Key>(keys, counts).values;
    std::sort(own.begin(), own.end());
    return own;
  }

  // Returns the first key of each rank but 0, by bisection: the smallest key that has cut[r] keys of all ranks before
  // it. `keys`: of this rank, ascending.
  std::vector<Key> first_keys(const std::vector<Key>& keys) const {
    constexpr int kBits = 64 + 31;
    std::vector<Key> found(ranks_ - 1);
    for (int r = 1; r < ranks_; ++r) {  // of which body
      size_t b = 0;
      while (share_.cut[r] >= bodies_[b].range.first_vertex + bodies_[b].range.vertex_count) ++b;
      found[r - 1].body = static_cast<std::int32_t>(b);
    }
    for (int bit = kBits - 1; bit >= 0; --bit) {
      std::vector<Key> tried = found;
      std::vector<std::int64_t> before;
      for (Key& key : tried) {
        if (bit >= 31)
          key.code |= std::uint64_t{1} << (bit - 31);
        else
          key.user |= 1 << bit;
        before.push_back(std::lower_bound(keys.begin(), keys.end(), key) - keys.begin());
      }
      sum_over_ranks(before);
      for (int r = 1; r < ranks_; ++r)
        if (before[r - 1] <= share_.cut[r]) found[r - 1] = tried[r - 1];
    }
    return found;
  }

  int rank_of(int number) const {
    return static_cast<int>(std::upper_bound(share_.cut.begin(), share_.cut.end(), number) - share_.cut.begin()) - 1;
  }

  // Sends each value to its rank. `number(value)`: in [0, number of vertices).
  template <class T, class Number>
  std::vector<T> send(std::vector<T> values, const Number& number) const {
    std::sort(values.begin(), values.end(), [&](const T& a, const T& b) { return number(a) < number(b); });
    std::vector<int> counts(ranks_, 0);
    for (const T& value : values) ++counts[rank_of(number(value))];
    return exchange<T>(values, counts).values;
  }

  // Returns the vertices of ascending numbers, given by answer(number) of the rank that has them.
  template <class Answer>
  std::vector<Named> ask(const std::vector<int>& wanted, const Answer& answer) const {
    std::vector<int> counts(ranks_, 0);
    for (const int v : wanted) ++counts[rank_of(v)];
    const Received<int> asked = exchange<int>(wanted, counts);
    std::vector<Named> answers;
    answers.reserve(asked.values.size());
    for (const int v : asked.values) answers.push_back(answer(v - share_.first()));
    return exchange<Named>(answers, asked.counts).values;
  }

  // Sends the numbers of vertices in the whole mesh to the ranks that have them in their slices of the user's order.
  void number_slice() {
    struct Pair {
      Vec3d X;
      std::int32_t user, number;
    };
    std::vector<Pair> pairs;
    for (const Key& key : own_) pairs.push_back({key.X, key.user, share_.first() + static_cast<int>(pairs.size())});
    named_slice_.resize(share_.own());
    for (const Pair& p : send(std::move(pairs), [](const Pair& q) { return q.user; }))
      named_slice_[p.user - share_.first()] = {p.X, p.number};
  }

  // Returns the tets that touch own vertices, in the order of the whole mesh. Each rank reads a slice of the user's
  // order, and sends its tets to the owners of their vertices.
  std::vector<TetOnCurve> own_tets() {
    std::vector<TetOnCurve> read = read_tets();
    std::vector<int> counts(ranks_, 0);
    std::vector<std::pair<int, int>> order;  // rank, tet
    for (size_t t = 0; t < read.size(); ++t) {
      std::array<int, 4> owner;
      for (int c = 0; c < 4; ++c) owner[c] = rank_of(read[t].tet[c]);
      std::sort(owner.begin(), owner.end());
      for (int c = 0; c < 4; ++c)
        if (c == 0 || owner[c] != owner[c - 1]) order.emplace_back(owner[c], static_cast<int>(t)), ++counts[owner[c]];
    }
    std::sort(order.begin(), order.end());
    std::vector<TetOnCurve> sent;
    sent.reserve(order.size());
    for (const auto& [_, t] : order) sent.push_back(read[t]);
    read = exchange<TetOnCurve>(sent, counts).values;
    std::sort(read.begin(), read.end());
    return read;
  }

  std::vector<TetOnCurve> read_tets() {
    const BodyRange& last = bodies_.back().range;
    const std::vector<int> cut = equal_cuts(last.first_tet + last.tet_count, ranks_);
    std::vector<TetOnCurve> tets;
    std::vector<int> vertices;
    all_succeed([&] {
      for_each_part(bodies_, &BodyRange::first_tet, &BodyRange::tet_count, {cut[share_.rank], cut[share_.rank + 1]},
                    [&](Body& body, int first, int count) {
                      int user = body.range.first_tet + first;
                      for (Tet tet : body.mesh.tets(first, count)) {
                        for (int& v : tet) vertices.push_back(v += body.range.first_vertex);
                        tets.push_back({0, static_cast<int>(&body - bodies_.data()), user++, tet});
                      }
                    });
    });
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    put_on_curve(vertices, ask(vertices, [&](int v) { return named_slice_[v]; }), tets);
    named_slice_ = {};
    return tets;
  }

  // `vertices`: those of the tets, ascending user's numbers. Collective.
  void put_on_curve(const std::vector<int>& vertices, const std::vector<Named>& named, std::vector<TetOnCurve>& tets) {
    std::vector<Vec3d> centers;
    for (TetOnCurve& t : tets) {
      std::array<Vec3d, 4> X;
      for (int c = 0; c < 4; ++c) {
        const Named& v = named[std::lower_bound(vertices.begin(), vertices.end(), t.tet[c]) - vertices.begin()];
        t.tet[c] = v.number;
        X[c] = v.X;
      }
      centers.push_back(0.25 * ((X[0] + X[1]) + (X[2] + X[3])));
      bodies_[t.body].centers.add(centers.back());
    }
    std::vector<Box*> boxes;
    for (Body& body : bodies_) boxes.push_back(&body.centers);
    merge_over_ranks(boxes);
    for (size_t t = 0; t < tets.size(); ++t) {
      const Box& box = bodies_[tets[t].body].centers;
      tets[t].code = hilbert_index(centers[t], box.lower, cube_size(box));
    }
  }

  // Adds user's numbers and positions. Ranks ask the owners of ghosts.
  void name_vertices(RankScene& scene) {
    const auto named = [&](int own) { return Named{own_[own].X, own_[own].user}; };
    const std::vector<int> ghosts(share_.vertex.begin() + share_.own(), share_.vertex.end());
    std::vector<Named> all;
    for (int v = 0; v < share_.own(); ++v) all.push_back(named(v));
    const std::vector<Named> of_ghosts = ask(ghosts, named);
    all.insert(all.end(), of_ghosts.begin(), of_ghosts.end());
    for (const Named& v : all) {
      share_.user_vertex.push_back(v.number);
      scene.mesh.rest.push_back(v.X);
    }
    own_ = {};
  }

  // Bodies without labels have 0, if another one has labels.
  void set_regions(TetMesh& mesh) const {
    std::vector<int> region;
    bool has_regions = false;
    for (size_t b = 0; b < bodies_.size(); ++b) {
      const MeshShare::Body& tets = share_.bodies[b];
      has_regions = has_regions || bodies_[b].mesh.has_regions();
      for (int t = tets.first_tet; t < tets.first_tet + tets.counted + tets.halo; ++t)
        region.push_back(bodies_[b].mesh.region(share_.user_tet[t] - bodies_[b].range.first_tet));
    }
    if (has_regions) mesh.region = std::move(region);
  }

  void add_facts(RankScene& scene) const {
    for (const Body& body : bodies_) {
      BodyFacts& facts = scene.bodies.emplace_back();
      facts.box = body.box;
      facts.heights = body.heights;
      facts.corners = body.placed(body.mesh.corners());
    }
  }

  // The local tets of a body and their vertices, and its own vertices.
  static TetMesh part_of(const RankScene& scene, size_t b) {
    const MeshShare& share = scene.share;
    const BodyRange& range = share.of_bodies[b];
    std::vector<int> number(share.local_vertices(), -1);
    TetMesh part;
    for (int v = 0; v < share.local_vertices(); ++v) {
      if (share.vertex[v] < range.first_vertex || share.vertex[v] >= range.first_vertex + range.vertex_count) continue;
      number[v] = part.vertex_count();
      part.rest.push_back(scene.mesh.rest[v]);
    }
    const MeshShare::Body& tets = share.bodies[b];
    for (int t = tets.first_tet; t < tets.first_tet + tets.counted + tets.halo; ++t) {
      part.tets.push_back(scene.mesh.tets[t]);
      for (int& v : part.tets.back()) v = number[v];
    }
    return part;
  }

  std::vector<Body> bodies_;
  int ranks_;
  Vec3d up_;
  MeshShare share_;
  std::vector<Vec3d> slice_;        // placed vertices of the user's order
  std::vector<Named> named_slice_;  // with their numbers in the whole mesh
  std::vector<Key> own_;
};

bool is_number_or_formula(const Value& value) { return value.is_number() || value.is_text(); }

// Files, regions and lists belong to whole bodies.
bool is_pointwise(const Value& body) {
  for (const Member& member : body["material"].table().members)
    if (member.key == "file" || !is_number_or_formula(member.value)) return false;
  if (const Value* deform = body.find("deform"); deform && deform->find("file")) return false;
  const Vec3d omega = body["angular_velocity"].vector();
  return omega[0] == 0 && omega[1] == 0 && omega[2] == 0 && !body.find("skin");
}

// Adds what fingerprint_of() adds for the whole mesh.
void add_to_hash(const SlicedBody& body, Fingerprint& hash) {
  constexpr int kHashed = 1 << 18;  // items that are read together
  const int vertices = static_cast<int>(body.vertex_count()), tets = static_cast<int>(body.tet_count());
  for (int first = 0; first < vertices; first += std::min(kHashed, vertices - first)) {
    const std::vector<Vec3d> slice = body.vertices(first, std::min(kHashed, vertices - first));
    hash.add(slice.data(), slice.size() * sizeof(Vec3d));
  }
  for (int first = 0; first < tets; first += std::min(kHashed, tets - first)) {
    const std::vector<Tet> slice = body.tets(first, std::min(kHashed, tets - first));
    hash.add(slice.data(), slice.size() * sizeof(Tet));
  }
  for (int t = 0; body.has_regions() && t < tets; ++t) {
    const int label = body.region(t);
    hash.add(&label, sizeof(label));
  }
}

}  // namespace

std::optional<SlicedBodies> sliced_bodies(const Table& document, const SceneFiles& files) {
  SlicedBodies bodies;
  for (const Value& body : document.find("body")->array()) {
    if (!is_pointwise(body)) return std::nullopt;
    bodies.push_back(sliced_body(body, files));
    if (!bodies.back()) return std::nullopt;
  }
  return bodies;
}

bool resolve_slices(const SlicedBodies& bodies, Table& document, SceneFiles& files) {
  std::vector<Fingerprint> hashes(bodies.size());
  try {
    for (size_t b = 0; b < bodies.size(); ++b) add_to_hash(*bodies[b], hashes[b]);
  } catch (const InvalidInput&) {
    return false;  // reading it as a whole has the message, or a remedy
  }
  Array& scenes = document.find("body")->array();
  for (size_t b = 0; b < bodies.size(); ++b) {
    const std::string name = scenes[b]["name"].text();
    if (const Value* mesh = scenes[b].find("mesh"))
      scenes[b].table().set("mesh", {files.keep(files.find(*mesh), name), {}});
    check_fingerprint(scenes[b].table(), "mesh_hash", hashes[b].text(), "the mesh of body '" + name + "'");
  }
  return true;
}

RankScene make_mesh_slices(const Table& document, const SlicedBodies& bodies) {
  Slicer slicer(document, bodies);
  RankScene scene = slicer.make();
  all_succeed([&] { slicer.require_sound(scene); });
  return scene;
}

}  // namespace aspic::distributed
