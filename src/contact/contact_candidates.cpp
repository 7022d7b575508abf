#include "contact/contact_candidates.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "math/polar3.h"
#include "mesh/distance.h"

namespace aspic {
namespace {

// Larger margins reduce the searches but add pairs: few within a part, where most features are an edge apart.
constexpr double kMargin = 0.05;        // relative to the mean edge at a point
constexpr double kMarginWithin = 0.15;  // the same for pairs of one part
constexpr double kLonger = 0.1;         // relative to the displacement of a point
constexpr double kKept = 0.25;          // squared part of the margin within which points are not searched again
constexpr double kMostMargins = 4;      // the most that kLonger adds within a part, relative to the margin
constexpr double kRounding = 1e-6;
constexpr double kMinShrink = 0.995;  // minimum shrink for which candidates are complete

// Returns margins of at least half the reach, which the distances at rest need.
std::vector<double> margins(PairScope scope, const ContactMesh& mesh, double least) {
  const double share = scope == PairScope::within_parts ? kMarginWithin : kMargin;
  std::vector<double> length(mesh.rest.size(), 0.0);
  std::vector<int> count(mesh.rest.size(), 0);
  for (const Edge& edge : mesh.edges)
    for (const int p : edge) length[p] += norm(mesh.rest[edge[1]] - mesh.rest[edge[0]]), ++count[p];
  for (size_t p = 0; p < length.size(); ++p)
    length[p] = mesh.row[p] < 0 ? least : std::max(least, share * length[p] / std::max(1, count[p]));
  return length;
}

struct Frame {
  Vec3d center{};
  Mat3d rotation = identity3<double>();  // from the rest pose
};

Vec3d mean(std::span<const Vec3d> points) {
  Vec3d sum{};
  for (const Vec3d& x : points) sum = sum + x;
  return (1.0 / static_cast<double>(points.size())) * sum;
}

Frame frame_of(std::span<const Vec3d> X, std::span<const Vec3d> x) {
  const Vec3d center = mean(x), rest_center = mean(X);
  Mat3d A{};
  for (size_t i = 0; i < x.size(); ++i)
    for (int c = 0; c < 3; ++c)
      for (int r = 0; r < 3; ++r) A(r, c) += (x[i][r] - center[r]) * (X[i][c] - rest_center[c]);
  return {center, closest_rotation(A)};
}

}  // namespace

// At most half the distance at rest within a body, because its own edges must not repel each other at rest.
double edge_reach(const ContactMesh& mesh, const ContactLaws& laws, const EdgePair& pair) {
  const auto& [a, b] = mesh.edges[pair.first];
  const auto& [e, f] = mesh.edges[pair.second];
  const ContactLaw& law = laws(mesh.part[a], mesh.part[e]);
  if (mesh.part[a] != mesh.part[e]) return law.edge_reach;
  const auto& X = mesh.rest;
  return std::min(law.edge_reach, (pair_distance(PairKind::edge_edge, {X[a], X[b], X[e], X[f]}).d - law.offset) / 2);
}

// Accepts pairs that can come closer than their reach.
class CandidateSearch::Near : public PairFilter {
 public:
  Near(const CandidateSearch& search, int a, int b)
      : search_(search),
        first_point_(search.mesh_.parts[a].first_point),
        edges_a_(std::span(search.mesh_.edges).subspan(search.surfaces_[a].first_edge)),
        edges_b_(std::span(search.mesh_.edges).subspan(search.surfaces_[b].first_edge)),
        triangles_b_(std::span(search.mesh_.triangles).subspan(search.surfaces_[b].first_triangle)),
        reach_((1 + kRounding) * (search.laws_(a, b).offset + search.laws_(a, b).reach)),
        edge_reach_((1 + kRounding) * (search.laws_(a, b).offset + search.laws_(a, b).edge_reach)),
        shrink_(search.least_shrink()) {}

  bool accepts_vertex_triangle(int v, int t) const override {
    const int p = first_point_ + v;
    const auto& [a, b, c] = triangles_b_[t];
    const auto& x = search_.start_;
    return shrink_ * point_triangle_distance({x[p], x[a], x[b], x[c]}).d <=
           reach_ + std::max({closing(p, a), closing(p, b), closing(p, c)});
  }
  bool accepts_edge_edge(int first, int second) const override {
    const auto& [a, b] = edges_a_[first];
    const auto& [e, f] = edges_b_[second];
    const auto& x = search_.start_;
    return shrink_ * edge_edge_distance({x[a], x[b], x[e], x[f]}).d <=
           edge_reach_ + std::max({closing(a, e), closing(a, f), closing(b, e), closing(b, f)});
  }

 private:
  // Bounds the change of the difference of two points.
  double closing(int i, int j) const {
    return norm(search_.move_[i] - search_.move_[j]) + search_.by_[i] + search_.by_[j];
  }

  const CandidateSearch& search_;
  int first_point_;
  std::span<const Edge> edges_a_, edges_b_;
  std::span<const Triangle> triangles_b_;
  double reach_, edge_reach_, shrink_;
};

CandidateSearch::CandidateSearch(PairScope scope, const ContactMesh& mesh, const ContactLaws& laws)
    : scope_(scope), mesh_(mesh), laws_(laws), margin_(margins(scope, mesh, laws.largest_reach())) {
  int edge = 0, triangle = 0;
  for (int part = 0; part < static_cast<int>(mesh.parts.size()); ++part) {
    SurfacePrimitives primitives{.vertices = std::vector<int>(mesh.parts[part].point_count)};
    std::iota(primitives.vertices.begin(), primitives.vertices.end(), mesh.parts[part].first_point);
    const int first_edge = edge, first_triangle = triangle;
    for (; edge < mesh.edge_count() && mesh.part[mesh.edges[edge][0]] == part; ++edge)
      primitives.edges.push_back(mesh.edges[edge]);
    for (; triangle < mesh.triangle_count() && mesh.part[mesh.triangles[triangle][0]] == part; ++triangle)
      primitives.triangles.push_back(mesh.triangles[triangle]);
    surfaces_.push_back({first_edge, first_triangle, PairFinder(std::move(primitives))});
  }
}

CandidateSearch::Path CandidateSearch::path(std::span<const Vec3d> x, std::span<const Vec3d> d) const {
  Path path{{x.begin(), x.end()}, {x.begin(), x.end()}, std::vector<double>(x.size(), 1.0)};
  for (size_t i = 0; i < d.size(); ++i) path.to[i] = x[i] + d[i];
  if (scope_ == PairScope::between_parts) return path;
  for (const ContactPart& part : mesh_.parts) {
    const auto of_part = [&](auto& points) { return std::span(points).subspan(part.first_point, part.point_count); };
    if (part.is_obstacle) {  // has no pairs
      std::fill_n(of_part(path.from).begin(), part.point_count, Vec3d{});
      std::fill_n(of_part(path.to).begin(), part.point_count, Vec3d{});
      continue;
    }
    if (part.point_count == 0) continue;
    const Frame from = frame_of(of_part(mesh_.rest), of_part(x));
    Frame to = d.empty() ? from : frame_of(of_part(mesh_.rest), of_part(path.to));
    const double cosine = (trace(transpose(from.rotation) * to.rotation) - 1) / 2;
    double shrink = std::sqrt(std::max(0.0, (1 + cosine) / 2)) - kRounding;
    if (!(shrink >= kMinShrink)) to.rotation = from.rotation, shrink = 1;
    for (Vec3d& p : of_part(path.from)) p = transpose(from.rotation) * (p - from.center);
    for (Vec3d& p : of_part(path.to)) p = transpose(to.rotation) * (p - to.center);
    std::fill_n(path.shrink.begin() + part.first_point, part.point_count, shrink);
  }
  return path;
}

double CandidateSearch::least_shrink() const { return scope_ == PairScope::within_parts ? kMinShrink : 1; }

// A difference of two points that is y0 in a frame at the start and y1 in one at the end, which is turned by R, is
// z = (1 - t) y0 + t R y1 on the way. With y = (1 - t) y0 + t y1 and M = (1 - t) I + t R, which shrinks y at most by
// the factor above, |z - M y| = t (1 - t) |(I - R) (y1 - y0)| <= twist |y1 - y0|.
double CandidateSearch::twist() const { return std::sqrt(1 - least_shrink() * least_shrink()) / 2; }

// Returns whether the candidates are complete at x. Marks the points that come close to the end of their margin around
// start_ + t move_, because they would soon cause another search. t is that of the least squared distance.
bool CandidateSearch::mark_new(std::span<const Vec3d> x) {
  double along = 0, square = 0;
  for (size_t p = 0; p < x.size(); ++p) along += dot(move_[p], x[p] - start_[p]), square += squared_norm(move_[p]);
  const double t = square > 0 ? std::clamp(along / square, 0.0, 1.0) : 0.0;
  bool is_complete = true;
  for (size_t p = 0; p < x.size(); ++p) {
    const double used = squared_norm(x[p] - start_[p] - t * move_[p]) / (by_[p] * by_[p]);
    if (!(used <= kKept)) is_new_[p] = true;
    is_complete &= used <= 1;
  }
  return is_complete;
}

// Returns whether the candidates are complete on the path. If not, marks the points whose pairs are to be searched for.
// Points with a line are among them, because its t is common to all.
bool CandidateSearch::covers(const Path& path) {
  const size_t n = path.from.size();
  is_new_.assign(n, !candidates_);
  if (!candidates_) {
    start_.resize(n), move_.resize(n), by_.resize(n);
    return false;
  }
  const bool at_start = mark_new(path.from), at_end = mark_new(path.to);
  if (at_start && at_end) return true;
  for (size_t p = 0; p < n; ++p) is_new_[p] |= squared_norm(move_[p]) > 0;
  return false;
}

// Selects the positions of new points that the next candidates cover: a ball around a short path, or balls on a line.
void CandidateSearch::surround(const Path& path) {
  for (size_t p = 0; p < path.from.size(); ++p) {
    if (!is_new_[p]) continue;
    const Vec3d move = path.to[p] - path.from[p];
    const double length = norm(move);
    const bool is_short = length <= margin_[p];
    start_[p] = is_short ? path.from[p] + 0.5 * move : path.from[p];
    move_[p] = is_short ? Vec3d{} : move;
    const double most = scope_ == PairScope::within_parts ? kMostMargins * margin_[p] : Box::kInfinity;
    by_[p] = margin_[p] + (is_short ? length / 2 : std::min(kLonger * length, most));
  }
}

std::optional<PathCandidates> CandidateSearch::along(std::span<const Vec3d> x, std::span<const Vec3d> d) {
  Path wanted = path(x, d);
  if (!covers(wanted)) {
    surround(wanted);
    candidates_ = find();
  }
  if (!candidates_) return {};
  PathCandidates found{candidates_, std::move(wanted.from), std::move(wanted.to), std::move(wanted.shrink)};
  for (size_t p = 0; p < x.size(); ++p) {
    found.from[p] = found.from[p] - start_[p];
    found.to[p] = found.to[p] - start_[p];
  }
  return found;
}

// Returns a box around the positions of a part that the next candidates cover, inflated by its radius and `radius`.
SweptBox CandidateSearch::bounds_of(int part, double radius) const {
  SweptBox box{.is_new = false};
  const int first = mesh_.parts[part].first_point;
  for (int p = first; p < first + mesh_.parts[part].point_count; ++p) {
    const double by = (1 + kRounding) * (by_[p] + radius + mesh_.parts[part].offset);
    box.start.add(start_[p] - Vec3d{{by, by, by}});
    box.start.add(start_[p] + Vec3d{{by, by, by}});
    box.move.add(move_[p]);
    box.is_new |= is_new_[p];
  }
  return box;
}

// Appends the pairs, in indices of the mesh. Returns false if there are too many.
bool CandidateSearch::find_pairs(ClosePairs& all) {
  const size_t limit = PairQuery{}.limit;
  const auto append = [&](const ClosePairs& found, int a, int b) {
    for (const auto& [v, t] : found.vertex_triangle)
      all.vertex_triangle.push_back({mesh_.parts[a].first_point + v, surfaces_[b].first_triangle + t});
    for (const auto& [e, f] : found.edge_edge)
      all.edge_edge.push_back({surfaces_[a].first_edge + e, surfaces_[b].first_edge + f});
    return found.is_complete && all.vertex_triangle.size() <= limit && all.edge_edge.size() <= limit;
  };
  const int parts = static_cast<int>(surfaces_.size());
  const double radius = (1 + kRounding) * laws_.largest_reach() / (2 * least_shrink());
  std::vector<double> by(by_);
  for (size_t p = 0; p < by.size(); ++p)
    by[p] = (1 + kRounding) * (by_[p] + twist() * (norm(move_[p]) + 2 * by_[p]) / least_shrink());
  std::vector<double> radii(std::max({mesh_.rest.size(), mesh_.edges.size(), mesh_.triangles.size()}));
  const auto query_of = [&](int part, const PairFilter* filter) {
    const SurfacePrimitives& own = surfaces_[part].finder.primitives();
    const size_t count = std::max({own.vertices.size(), own.edges.size(), own.triangles.size()});
    std::fill_n(radii.begin(), count, radius + mesh_.parts[part].offset);
    return PairQuery{.x = start_,
                     .dx = move_,
                     .by = by,
                     .vertex_radius = std::span(radii).first(own.vertices.size()),
                     .edge_radius = std::span(radii).first(own.edges.size()),
                     .triangle_radius = std::span(radii).first(own.triangles.size()),
                     .is_new = is_new_,
                     .filter = filter};
  };
  if (scope_ == PairScope::within_parts) {
    for (int a = 0; a < parts; ++a) {
      if (mesh_.parts[a].is_obstacle || !bounds_of(a, radius).is_new) continue;
      const Near near(*this, a, a);
      if (!append(surfaces_[a].finder.find(query_of(a, &near)), a, a)) return false;
    }
    return true;
  }
  std::vector<SweptBox> bounds(parts);
  for (int a = 0; a < parts; ++a) bounds[a] = bounds_of(a, radius);
  std::vector<bool> is_placed(parts, false);
  for (int a = 0; a < parts; ++a)
    for (int b = a + 1; b < parts; ++b) {
      if (!bounds[a].overlaps(bounds[b]) || (mesh_.parts[a].is_obstacle && mesh_.parts[b].is_obstacle)) continue;
      for (const int part : {a, b}) {
        if (!is_placed[part]) surfaces_[part].finder.place(query_of(part, nullptr));
        is_placed[part] = true;
      }
      const PairFinder &first = surfaces_[a].finder, &second = surfaces_[b].finder;
      const Near near(*this, a, b), back(*this, b, a);
      if (!append(first.find_between(second, true, &near, limit), a, b)) return false;
      if (!append(second.find_between(first, false, &back, limit), b, a)) return false;
    }
  return true;
}

bool CandidateSearch::is_kept(const NearTriangle& pair) const {
  const auto& [a, b, c] = mesh_.triangles[pair.triangle];
  return !(is_new_[pair.point] || is_new_[a] || is_new_[b] || is_new_[c]);
}

bool CandidateSearch::is_kept(const EdgePair& pair) const {
  const Edge &a = mesh_.edges[pair.first], &b = mesh_.edges[pair.second];
  return !(is_new_[a[0]] || is_new_[a[1]] || is_new_[b[0]] || is_new_[b[1]]);
}

// Keeps the pairs without new points, and finds the others.
std::shared_ptr<const ContactCandidates> CandidateSearch::find() {
  ClosePairs pairs;
  if (!find_pairs(pairs)) return nullptr;
  ContactCandidates found;
  auto& [start, triangles, edges] = found;
  const auto& x = start_;
  for (const auto& [p, t] : pairs.vertex_triangle) {
    const auto& [a, b, c] = mesh_.triangles[t];
    triangles.push_back({p, t, (1 - kRounding) * point_triangle_distance({x[p], x[a], x[b], x[c]}).d});
  }
  for (const auto& [first, second] : pairs.edge_edge) {
    const Edge &a = mesh_.edges[first], &b = mesh_.edges[second];
    const double gap = (1 - kRounding) * edge_edge_distance({x[a[0]], x[a[1]], x[b[0]], x[b[1]]}).d;
    edges.push_back({first, second, gap});
  }
  if (candidates_) {
    for (const NearTriangle& pair : candidates_->triangles)
      if (is_kept(pair)) triangles.push_back(pair);
    for (const EdgePair& pair : candidates_->edge_pairs)
      if (is_kept(pair)) edges.push_back(pair);
  }
  if (std::max(triangles.size(), edges.size()) > PairQuery{}.limit) return nullptr;
  std::sort(triangles.begin(), triangles.end());
  std::sort(edges.begin(), edges.end());
  start.assign(mesh_.rest.size() + 1, 0);
  for (const NearTriangle& pair : triangles) ++start[pair.point + 1];
  std::partial_sum(start.begin(), start.end(), start.begin());
  return std::make_shared<const ContactCandidates>(std::move(found));
}

}  // namespace aspic
