#include "distributed/box_slices.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "distributed/exchange.h"
#include "distributed/mpi_ranks.h"
#include "mesh/order.h"
#include "mesh/tet_shape.h"
#include "scene/body_mesh.h"
#include "scene/placement.h"

namespace aspic::distributed {
namespace {

// A vertex on the Hilbert curve of its body. Bodies follow each other.
struct Key {
  std::uint64_t code = 0;  // along the curve
  std::int32_t body = 0;
  std::int32_t user = 0;  // user's number in the whole mesh

  friend bool operator<(const Key& a, const Key& b) {
    if (a.body != b.body) return a.body < b.body;
    return a.code != b.code ? a.code < b.code : a.user < b.user;
  }
};

struct BoxBody {
  BoxGrid grid;
  AffineMap place;
  BodyRange range;   // in the whole mesh
  Box box = {};      // of the placed vertices
  Box centers = {};  // of the centroids of its tets

  Vec3d position(int own) const { return place(grid.position(own)); }
};

double cube_size(const Box& box) {
  return std::max({box.upper[0] - box.lower[0], box.upper[1] - box.lower[1], box.upper[2] - box.lower[2]});
}

std::vector<BoxBody> bodies_of(const Table& document) {
  std::vector<BoxBody> bodies;
  BodyRange range;
  for (const Value& scene : document.find("body")->array()) {
    const Value& box = *scene["shape"].find("box");
    const BoxCells cells = cells_of(box);
    BoxGrid grid(box["lower"].vector(), box["upper"].vector(), cells.integers(), cells.cut);
    range.first_vertex += range.vertex_count;
    range.first_tet += range.tet_count;
    range.name = scene["name"].text();
    range.vertex_count = static_cast<int>(grid.vertex_count());
    range.tet_count = static_cast<int>(grid.tet_count());
    bodies.push_back({grid, placement_of(scene), range});
  }
  return bodies;
}

// Replaces boxes by the smallest ones that contain those of all ranks.
void merge_over_ranks(std::vector<Box*> boxes) {
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

std::array<Vec3d, 4> corners_of(const BoxBody& body, const Tet& tet) {
  return {body.position(tet[0]), body.position(tet[1]), body.position(tet[2]), body.position(tet[3])};
}

Vec3d center_of(const BoxBody& body, const Tet& tet) {
  const auto [a, b, c, d] = corners_of(body, tet);
  return 0.25 * ((a + b) + (c + d));
}

class Slicer {
 public:
  explicit Slicer(const Table& document) : bodies_(bodies_of(document)), ranks_(rank_count()) {
    const BodyRange& last = bodies_.back().range;
    share_.rank = rank_of_this_process();
    share_.cut = equal_cuts(last.first_vertex + last.vertex_count, ranks_);
    for (const BoxBody& body : bodies_) share_.of_bodies.push_back(body.range);
  }

  RankScene make() {
    find_boxes();
    own_ = own_keys();
    for (size_t i = 0; i < own_.size(); ++i) by_user_.emplace_back(own_[i].user, share_.first() + static_cast<int>(i));
    std::sort(by_user_.begin(), by_user_.end());
    std::vector<std::vector<Tet>> tets(bodies_.size());
    std::vector<std::vector<int>> numbers(bodies_.size());
    for (size_t b = 0; b < bodies_.size(); ++b) collect_tets(static_cast<int>(b), tets[b], numbers[b]);
    name_ghosts(tets);
    RankScene scene;
    scene.mesh.tets = arrange(tets, numbers, share_);
    for (const Key& key : own_) share_.user_vertex.push_back(key.user);
    std::vector<std::pair<int, int>> ghosts(ghost_user_.size());  // numbers in the whole mesh, and of the user
    for (size_t g = 0; g < ghosts.size(); ++g) ghosts[g] = {ghost_number_[g], ghost_user_[g]};
    std::sort(ghosts.begin(), ghosts.end());
    for (const auto& [_, user] : ghosts) share_.user_vertex.push_back(user);
    for (const int user : share_.user_vertex) {
      const BoxBody& body = body_of_vertex(user);
      scene.mesh.rest.push_back(body.position(user - body.range.first_vertex));
    }
    scene.share = std::move(share_);
    add_facts(scene);
    return scene;
  }

 private:
  const BoxBody& body_of_vertex(int user) const {
    size_t b = 0;
    while (user >= bodies_[b].range.first_vertex + bodies_[b].range.vertex_count) ++b;
    return bodies_[b];
  }
  int index_of(const BoxBody& body) const { return static_cast<int>(&body - bodies_.data()); }

  // The curves fill the bounding cubes of all vertices, and of the centroids of all tets. Each rank looks at a slice of
  // the user's order.
  void find_boxes() {
    std::vector<Tet> tets;
    for (int user = share_.cut[share_.rank]; user < share_.cut[share_.rank + 1]; ++user) {
      BoxBody& body = bodies_[index_of(body_of_vertex(user))];
      const int own = user - body.range.first_vertex;
      body.box.add(body.position(own));
      const auto [i, j, k] = body.grid.corner(own);
      const auto& cells = body.grid.cells();
      const bool is_at_end = i == 0 || j == 0 || k == 0 || i + 1 >= cells[0] || j + 1 >= cells[1] || k + 1 >= cells[2];
      if (!is_at_end || i == cells[0] || j == cells[1] || k == cells[2]) continue;  // extremes are at the boundary
      tets.clear();
      body.grid.append_cell(i, j, k, tets);
      for (const Tet& tet : tets) body.centers.add(center_of(body, tet));
    }
    std::vector<Box*> boxes;
    for (BoxBody& body : bodies_) boxes.insert(boxes.end(), {&body.box, &body.centers});
    merge_over_ranks(boxes);
  }

  // Returns the keys of the own vertices, ascending: a sort over all ranks into equal pieces.
  std::vector<Key> own_keys() {
    std::vector<Key> keys;
    for (int user = share_.first(); user < share_.cut[share_.rank + 1]; ++user) {
      const BoxBody& body = body_of_vertex(user);
      const Vec3d X = body.position(user - body.range.first_vertex);
      keys.push_back({hilbert_index(X, body.box.lower, cube_size(body.box)), index_of(body), user});
    }
    std::sort(keys.begin(), keys.end());
    std::vector<int> counts;
    auto begin = keys.begin();
    for (const Key& first : first_keys(keys)) {
      const auto end = std::lower_bound(begin, keys.end(), first);
      counts.push_back(static_cast<int>(end - begin));
      begin = end;
    }
    counts.push_back(static_cast<int>(keys.end() - begin));
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

  // The tets that touch own vertices of a body, by the user's numbers of vertices, in the order of the whole mesh.
  void collect_tets(int b, std::vector<Tet>& tets, std::vector<int>& numbers) const {
    const BoxBody& body = bodies_[b];
    struct Candidate {
      std::uint64_t code;
      int number;
      Tet tet;
    };
    std::vector<Candidate> all;
    for (const std::array<int, 3>& cell : cells_of_own(b)) {
      std::vector<Tet> of_cell;
      body.grid.append_cell(cell[0], cell[1], cell[2], of_cell);
      int number = body.range.first_tet + body.grid.cell(cell[0], cell[1], cell[2]) * body.grid.tets_per_cell();
      for (Tet& tet : of_cell) {
        const std::uint64_t code = hilbert_index(center_of(body, tet), body.centers.lower, cube_size(body.centers));
        for (int& v : tet) v += body.range.first_vertex;
        if (std::any_of(tet.begin(), tet.end(), [&](int v) { return number_of_own(v) >= 0; }))
          all.push_back({code, number, tet});
        ++number;
      }
    }
    std::sort(all.begin(), all.end(), [](const Candidate& x, const Candidate& y) {
      return x.code != y.code ? x.code < y.code : x.number < y.number;
    });
    for (const Candidate& candidate : all) {
      tets.push_back(candidate.tet);
      numbers.push_back(candidate.number);
    }
  }

  // The cells at the own vertices of a body, ascending.
  std::vector<std::array<int, 3>> cells_of_own(int b) const {
    const BoxGrid& grid = bodies_[b].grid;
    std::vector<std::array<int, 3>> cells;
    for (const Key& key : own_) {
      if (key.body != b) continue;
      const std::array<int, 3> at = grid.corner(key.user - bodies_[b].range.first_vertex);
      for (int corner = 0; corner < 8; ++corner) {
        std::array<int, 3> cell = {at[0] - (corner & 1), at[1] - (corner >> 1 & 1), at[2] - (corner >> 2)};
        bool is_inside = true;
        for (int axis = 0; axis < 3; ++axis)
          is_inside = is_inside && cell[axis] >= 0 && cell[axis] < grid.cells()[axis];
        if (is_inside) cells.push_back(cell);
      }
    }
    std::sort(cells.begin(), cells.end());
    cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
    return cells;
  }

  // Returns the number of an own vertex in the whole mesh; -1: another rank owns it.
  int number_of_own(int user) const {
    const auto found = std::lower_bound(by_user_.begin(), by_user_.end(), std::pair{user, 0});
    return found != by_user_.end() && found->first == user ? found->second : -1;
  }

  // Replaces the user's numbers by those of the whole mesh. Ranks ask for those of ghosts: the rank that has a slice of
  // the user's order has received its numbers from the owners.
  void name_ghosts(std::vector<std::vector<Tet>>& tets) {
    for (const auto& of_body : tets)
      for (const Tet& tet : of_body)
        for (const int v : tet)
          if (number_of_own(v) < 0) ghost_user_.push_back(v);
    std::sort(ghost_user_.begin(), ghost_user_.end());
    ghost_user_.erase(std::unique(ghost_user_.begin(), ghost_user_.end()), ghost_user_.end());
    ghost_number_ = numbers_of(ghost_user_);
    for (auto& of_body : tets)
      for (Tet& tet : of_body)
        for (int& v : tet) {
          const int own = number_of_own(v);
          v = own >= 0
                  ? own
                  : ghost_number_[std::lower_bound(ghost_user_.begin(), ghost_user_.end(), v) - ghost_user_.begin()];
        }
  }

  // `wanted`: user's numbers, ascending.
  std::vector<int> numbers_of(const std::vector<int>& wanted) const {
    struct Named {
      int user, number;
    };
    std::vector<Named> known;
    std::vector<int> known_counts(ranks_, 0), wanted_counts(ranks_, 0);
    for (const auto& [user, number] : by_user_) {
      known.push_back({user, number});
      ++known_counts[slice_of(user)];
    }
    for (const int user : wanted) ++wanted_counts[slice_of(user)];
    std::vector<int> slice(share_.own());
    for (const Named& n : exchange<Named>(known, known_counts).values) slice[n.user - share_.first()] = n.number;
    Received<int> asked = exchange<int>(wanted, wanted_counts);
    for (int& v : asked.values) v = slice[v - share_.first()];
    return exchange<int>(asked.values, asked.counts).values;
  }

  int slice_of(int user) const {
    return static_cast<int>(std::upper_bound(share_.cut.begin(), share_.cut.end(), user) - share_.cut.begin()) - 1;
  }

  void add_facts(RankScene& scene) const {
    for (const BoxBody& body : bodies_) {
      BodyFacts& facts = scene.bodies.emplace_back();
      facts.box = body.box;
      const auto& n = body.grid.cells();
      for (int corner = 0; corner < 8; ++corner)
        facts.corners.push_back(
            body.position(body.grid.vertex(corner & 1 ? n[0] : 0, corner & 2 ? n[1] : 0, corner & 4 ? n[2] : 0)));
    }
  }

  std::vector<BoxBody> bodies_;
  int ranks_;
  MeshShare share_;
  std::vector<Key> own_;
  std::vector<std::pair<int, int>> by_user_;  // user's numbers of the own vertices, and those in the whole mesh
  std::vector<int> ghost_user_, ghost_number_;
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

}  // namespace

bool can_be_sliced(const Table& document) {
  const Array& bodies = document.find("body")->array();
  return std::all_of(bodies.begin(), bodies.end(), [](const Value& body) {
    const Value* shape = body.find("shape");
    return shape && shape->find("box") && is_pointwise(body);
  });
}

MeshSize size_of_boxes(const Table& document) {
  MeshSize size;
  for (const Value& body : document.find("body")->array()) {
    const BoxCells cells = cells_of(*body["shape"].find("box"));
    size.vertices += (cells.count[0] + 1) * (cells.count[1] + 1) * (cells.count[2] + 1);
    size.tets += cells.tets();
  }
  return size;
}

void resolve_boxes(Table& document) {
  for (Value& body : document.find("body")->array()) {
    const Value& box = *body["shape"].find("box");
    const BoxCells cells = cells_of(box);
    const BoxGrid grid(box["lower"].vector(), box["upper"].vector(), cells.integers(), cells.cut);
    Fingerprint hash;
    for (int v = 0; v < static_cast<int>(grid.vertex_count()); ++v) {
      const Vec3d X = grid.position(v);
      hash.add(&X, sizeof(X));
    }
    const auto [nx, ny, nz] = grid.cells();
    std::vector<Tet> tets;
    for (int i = 0; i < nx; ++i)
      for (int j = 0; j < ny; ++j)
        for (int k = 0; k < nz; ++k) {
          tets.clear();
          grid.append_cell(i, j, k, tets);
          hash.add(tets.data(), tets.size() * sizeof(Tet));
        }
    check_fingerprint(body.table(), "mesh_hash", hash.text(), "the mesh of body '" + body["name"].text() + "'");
  }
}

RankScene make_box_slices(const Table& document) { return Slicer(document).make(); }

}  // namespace aspic::distributed
