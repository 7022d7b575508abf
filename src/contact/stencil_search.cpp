#include "contact/stencil_search.h"

#include <algorithm>
#include <array>
#include <limits>
#include <stdexcept>
#include <utility>

#include "base/parallel.h"

namespace aspic {
namespace {

constexpr const char* kTooMany = "contact: too many pairs of surface features are close to each other";
constexpr double kParallel = 1e-3;  // squared sine of the angle below which edges count as parallel

bool equal(std::span<const Vec3d> a, std::span<const Vec3d> b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const Vec3d& x, const Vec3d& y) { return x[0] == y[0] && x[1] == y[1] && x[2] == y[2]; });
}

// Features of one part near a point, with multiplicities.
class NearFeatures {
 public:
  struct Entry {
    std::array<int, 3> feature;  // point indices, ascending; padded with -1 at the front
    int share;
    Distance distance;         // from the point (index 0) to the feature, whose points follow
    std::array<int, 4> point;  // indices in the query
  };

  // `among`: the points of the query that `distance` refers to.
  void add(const Distance& distance, const std::array<int, 4>& among, int share) {
    Entry entry{.feature = {-1, -1, -1}, .share = share, .distance = distance, .point = among};
    for (int k = 1; k < distance.count; ++k) entry.feature[3 - k] = among[distance.point[k]];
    std::sort(entry.feature.begin(), entry.feature.end());
    for (Entry& known : entries_)
      if (known.feature == entry.feature) return void(known.share += share);
    entries_.push_back(entry);
  }
  // Returns whether this is the first visit.
  bool visits(std::vector<int>& visited, int index) {
    if (std::find(visited.begin(), visited.end(), index) != visited.end()) return false;
    visited.push_back(index);
    return true;
  }
  bool visits_edge(int e) { return visits(edges_, e); }
  bool visits_point(int p) { return visits(points_, p); }
  void clear() { entries_.clear(), edges_.clear(), points_.clear(); }
  std::span<const Entry> entries() const { return entries_; }

 private:
  std::vector<Entry> entries_;
  std::vector<int> edges_, points_;
};

// Returns the area of which two edges carry the pressure. A rod that crosses an edge touches it along its own band.
double edge_pair_area(const ContactMesh& mesh, const EdgePair& pair, bool is_round) {
  const double a = mesh.edge_area[pair.first], b = mesh.edge_area[pair.second];
  const bool is_rod_a = mesh.parts[mesh.part[mesh.edges[pair.first][0]]].is_rod,
             is_rod_b = mesh.parts[mesh.part[mesh.edges[pair.second][0]]].is_rod;
  if (is_rod_a != is_rod_b) return (is_rod_a ? a : b) / 2;
  return (a + b) / (is_round ? 2 : 4);
}

Distance point_point_distance(const Vec3d& x, const Vec3d& y) {
  Distance distance;
  distance.r = x - y;
  distance.d = norm(distance.r);
  return distance;
}

}  // namespace

StencilSearch::StencilSearch(const ContactMesh& mesh, const ContactLaws& laws)
    : mesh_(mesh),
      laws_(laws),
      cap_(mesh.point_count(), std::numeric_limits<double>::infinity()),
      within_(PairScope::within_parts, mesh, laws),
      between_(PairScope::between_parts, mesh, laws) {
  const auto near = within_.along(mesh.rest, {});
  if (!near) throw std::length_error(kTooMany);
  for (const auto& [p, t, gap] : near->pairs->triangles) {
    const auto& [a, b, c] = mesh.triangles[t];
    const auto& X = mesh.rest;
    const double offset = laws(mesh.part[p], mesh.part[p]).offset;
    cap_[p] = std::min(cap_[p], (point_triangle_distance({X[p], X[a], X[b], X[c]}).d - offset) / 2);
  }
}

int StencilSearch::self_touching_point() const {
  const auto found = std::find(cap_.begin(), cap_.end(), 0.0);
  return found == cap_.end() ? -1 : static_cast<int>(found - cap_.begin());
}

std::optional<PathCandidates> StencilSearch::along(PairScope scope, std::span<const Vec3d> points,
                                                   std::span<const Vec3d> d) const {
  const std::scoped_lock lock(mutex_);
  return (scope == PairScope::within_parts ? within_ : between_).along(points, d);
}

std::shared_ptr<const ContactStencils> StencilSearch::at(std::span<const Vec3d> points) const {
  const std::scoped_lock lock(mutex_);
  if (stencils_ && equal(points, points_)) return stencils_;
  const ContactMeter::Span span(meter_, ContactMeter::search);
  auto between = between_.along(points, {}), within = within_.along(points, {});
  if (!between || !within) throw std::length_error(kTooMany);
  points_.assign(points.begin(), points.end());
  stencils_ = std::make_shared<const ContactStencils>(stencils({*std::move(between), *std::move(within)}, points));
  return stencils_;
}

ContactStencils StencilSearch::stencils(const Candidates& candidates, std::span<const Vec3d> points) const {
  const auto collect = [](int count, const auto& find) {
    std::vector<ContactStencils> found(count / kChunkSize + 1);
    parallel_chunks(count, [&](int first, int last) {
      for (int i = first; i < last; ++i) find(i, found[first / kChunkSize]);
    });
    return found;
  };
  ContactStencils all;
  const auto append = [&all](const std::vector<ContactStencils>& chunks) {
    for (const ContactStencils& chunk : chunks) all.insert(all.end(), chunk.begin(), chunk.end());
  };
  append(collect(mesh_.point_count(), [&](int p, ContactStencils& found) {
    for (const PathCandidates& of_scope : candidates) add_point(of_scope, points, p, found);
    add_planes(points, p, found);
  }));
  for (const PathCandidates& of_scope : candidates) {
    const auto& pairs = of_scope.pairs->edge_pairs;
    append(collect(static_cast<int>(pairs.size()), [&](int k, ContactStencils& found) {
      const Edge &a = mesh_.edges[pairs[k].first], &b = mesh_.edges[pairs[k].second];
      const ContactLaw& law = laws_(mesh_.part[a[0]], mesh_.part[b[0]]);
      if (of_scope.least_gap(pairs[k], a, b) < law.offset + law.edge_reach) add_edges(pairs[k], points, found);
    }));
  }
  return all;
}

void StencilSearch::add_point(const PathCandidates& candidates, std::span<const Vec3d> x, int p,
                              ContactStencils& found) const {
  const int own = mesh_.part[p];
  NearFeatures near;
  int other = -1;
  int distances = 0;
  double reach = 0, offset = 0;
  const auto finish = [&] {
    for (const NearFeatures::Entry& entry : near.entries()) {
      const ContactLaw& law = laws_(own, other);
      if (entry.share == 0 || law.share == 0) continue;
      const double area = entry.share * law.share * mesh_.area[p];
      found.push_back({.distance = entry.distance,
                       .point = entry.point,
                       .weight = law.stiffness * area,
                       .reach = reach,
                       .offset = offset,
                       .is_round = law.is_round,
                       .area = area,
                       .parts = {own, other}});
      // Points of a much coarser surface have almost no share, so a tip would pierce the other surface without a guard.
      const double guard = std::min(law.guard, mesh_.area[p]) - law.share * mesh_.area[p];
      if (guard > 0 && !law.is_round && entry.distance.d < offset + kGuardReach * reach)
        found.push_back({.distance = entry.distance,
                         .point = entry.point,
                         .weight = law.stiffness * guard * entry.share,
                         .reach = kGuardReach * reach,
                         .offset = offset,
                         .parts = {own, other}});
    }
    near.clear();
  };
  for (const NearTriangle& candidate : candidates.pairs->near(p)) {  // ascending, so the parts are, too
    const int t = candidate.triangle;
    const Triangle& corner = mesh_.triangles[t];
    if (mesh_.part[corner[0]] != other) {
      finish();
      other = mesh_.part[corner[0]];
      reach = laws_(own, other).reach, offset = laws_(own, other).offset;
      if (own == other) reach = std::min(reach, cap_[p]);
    }
    if (laws_(own, other).stiffness == 0 || candidates.least_gap(candidate, corner) >= offset + reach) continue;
    ++distances;
    const Distance to_triangle = point_triangle_distance({x[p], x[corner[0]], x[corner[1]], x[corner[2]]});
    if (!(to_triangle.d < offset + reach)) continue;
    if (mesh_.parts[own].is_round) {
      const double area = laws_(own, other).share * mesh_.area_at_rest(corner);
      found.push_back({.distance = to_triangle,
                       .point = {p, corner[0], corner[1], corner[2]},
                       .weight = laws_(own, other).stiffness * area,
                       .reach = reach,
                       .offset = offset,
                       .is_round = true,
                       .area = area,
                       .parts = {own, other}});
      continue;
    }
    near.add(to_triangle, {p, corner[0], corner[1], corner[2]}, 1);
    for (const int e : mesh_.edges_of[t]) {
      if (e < 0 || mesh_.edge_share[e] == 0) continue;
      const auto& [a, b] = mesh_.edges[e];
      if (a == p || b == p || !near.visits_edge(e)) continue;
      ++distances;
      const Distance to_edge = point_edge_distance({x[p], x[a], x[b]});
      if (to_edge.d < offset + reach) near.add(to_edge, {p, a, b, -1}, mesh_.edge_share[e]);
    }
    for (const int q : corner) {
      if (mesh_.point_share[q] == 0 || !near.visits_point(q)) continue;
      ++distances;
      const Distance to_point = point_point_distance(x[p], x[q]);
      if (to_point.d < offset + reach) near.add(to_point, {p, q, -1, -1}, mesh_.point_share[q]);
    }
  }
  finish();
  if (distances > 0) meter_.add_distances(distances);
}

// A plane is a face with its foot in the interior.
void StencilSearch::add_planes(std::span<const Vec3d> x, int p, ContactStencils& found) const {
  if (mesh_.row[p] < 0) return;
  for (const ContactPlane& plane : mesh_.planes) {
    const ContactLaw& law = laws_(mesh_.part[p], plane.part);
    const double height = dot(plane.normal, x[p] - x[plane.point]);
    if (!(height - law.offset < law.reach)) continue;
    const Distance distance{.r = height * plane.normal, .d = height};
    const double area = law.share * mesh_.area[p];
    found.push_back({.distance = distance,
                     .point = {p, -1, -1, -1},
                     .weight = law.stiffness * area,
                     .reach = law.reach,
                     .offset = law.offset,
                     .area = area,
                     .parts = {mesh_.part[p], plane.part}});
  }
}

void StencilSearch::add_edges(const EdgePair& pair, std::span<const Vec3d> x, ContactStencils& found) const {
  const Edge &a = mesh_.edges[pair.first], &b = mesh_.edges[pair.second];
  meter_.add_distances(1);
  const Distance distance = edge_edge_distance({x[a[0]], x[a[1]], x[b[0]], x[b[1]]});
  const double reach = edge_reach(mesh_, laws_, pair);
  const int i = mesh_.part[a[0]], j = mesh_.part[b[0]];
  const auto& [offset, is_round] = std::pair(laws_(i, j).offset, laws_(i, j).is_round);
  if (!(distance.d < offset + reach)) return;
  const auto& X = mesh_.rest;
  const double area = edge_pair_area(mesh_, pair, is_round);
  found.push_back({.distance = distance,
                   .point = {a[0], a[1], b[0], b[1]},
                   .weight = laws_(i, j).stiffness * area,
                   .reach = reach,
                   .offset = offset,
                   .is_round = is_round,
                   .area = is_round ? area : 0,
                   .parts = {i, j},
                   .parallel = kParallel * squared_norm(X[a[1]] - X[a[0]]) * squared_norm(X[b[1]] - X[b[0]])});
}

}  // namespace aspic
