#include "contact/step_bound.h"

#include <algorithm>
#include <optional>

#include "base/parallel.h"
#include "mesh/ccd.h"

namespace aspic {
namespace {

constexpr double kLanding = 0.5;          // gap at which a step ends, relative to the reach
constexpr double kFar = 0.1;              // maximum displacement relative to the size of a part
constexpr double kSpring = 6.4;           // stiffness of springs at the landing; like the barrier at half its reach
constexpr double kShortest = 1.0 / 1024;  // minimum step that is worth a search for pairs

// See StepRule.
double landing_gap(double gap, double reach) { return gap > reach ? kLanding * reach : 0.2 * gap; }

// Returns the smallest step_of(i, upper bound) over all i.
template <class StepOf>
double smallest(int count, const StepOf& step_of) {
  std::vector<double> steps(count / kChunkSize + 1, 1.0);
  parallel_chunks(count, [&](int first, int last) {
    double step = 1;
    for (int i = first; i < last; ++i) step = std::min(step, step_of(i, step));
    steps[first / kChunkSize] = step;
  });
  return *std::min_element(steps.begin(), steps.end());
}

// Spheres and capsules have points and edges without area.
double smaller_area(double a, double b) { return a > 0 && b > 0 ? std::min(a, b) : std::max(a, b); }

void scale(double factor, std::span<Vec3d> u) {
  if (factor == 1) return;
  for (Vec3d& ui : u) ui = factor * ui;
}

}  // namespace

// Returns a step of at most 1 on which no point moves further than kFar relative to its part, because longer steps have
// too many candidates.
double StepBound::longest(std::span<const Vec3d> u) const {
  double step = 1;
  for (size_t k = 0; k < mesh_.parts.size(); ++k) {
    const auto own = u.subspan(mesh_.parts[k].first_point, mesh_.parts[k].point_count);
    Vec3d mean{};
    for (const Vec3d& ui : own) mean = mean + (1.0 / static_cast<double>(own.size())) * ui;
    for (const Vec3d& ui : own)
      if (const double far = norm(ui - mean), most = kFar * sizes_[k]; far * step > most) step = most / far;
  }
  return step;
}

double StepBound::to_planes(std::span<const Vec3d> p, std::span<const Vec3d> u, int i, double step) const {
  if (mesh_.row[i] < 0) return step;
  for (const ContactPlane& plane : mesh_.planes) {
    const ContactLaw& law = laws_(mesh_.part[i], plane.part);
    const double gap = dot(plane.normal, p[i] - p[plane.point]) - law.offset;
    const double rate = dot(plane.normal, u[i] - u[plane.point]);
    if (rate < 0) step = std::min(step, std::max(0.0, (gap - landing_gap(gap, law.reach)) / -rate));
  }
  return step;
}

MovingPair StepBound::pair(const Line& line, PairKind kind, const std::array<int, 4>& point) {
  MovingPair moving{kind, {}, {}};
  for (int k = 0; k < 4; ++k) moving.x[k] = line.p[point[k]], moving.dx[k] = line.u[point[k]];
  return moving;
}

double StepBound::step_of(const MovingPair& pair, const StepRule& rule) const {
  const SafeStep step = largest_step(pair, rule);
  search_.meter().add_distances(step.evaluations);
  return step.alpha;
}

double StepBound::to_triangle(const Line& line, int i, const NearTriangle& near, double step) const {
  const Triangle& t = mesh_.triangles[near.triangle];
  const ContactLaw& law = laws_(mesh_.part[i], mesh_.part[t[0]]);
  if (line.candidates.least_gap(near, t) > law.offset + law.reach) return step;
  return step_of(pair(line, PairKind::point_triangle, {i, t[0], t[1], t[2]}),
                 {.landing = kLanding * law.reach, .offset = law.offset, .horizon = step});
}

double StepBound::of_edges(const Line& line, const EdgePair& edges, double step) const {
  const Edge &a = mesh_.edges[edges.first], &b = mesh_.edges[edges.second];
  const ContactLaw& law = laws_(mesh_.part[a[0]], mesh_.part[b[0]]);
  if (line.candidates.least_gap(edges, a, b) > law.offset + law.edge_reach) return step;
  return step_of(pair(line, PairKind::edge_edge, {a[0], a[1], b[0], b[1]}),
                 {.landing = kLanding * edge_reach(mesh_, laws_, edges), .offset = law.offset, .horizon = step});
}

// Scales u, and `factor` with it, to a line with few enough candidates. Returns nothing if the line would be too short.
std::optional<StepBound::Line> StepBound::line(PairScope scope, std::span<const Vec3d> p, std::vector<Vec3d>& u,
                                               double& factor) const {
  std::optional<PathCandidates> candidates;
  for (factor = 1; !(candidates = search_.along(scope, p, u)); factor /= 2) {
    if (factor < kShortest) return {};
    scale(0.5, u);
  }
  return Line{p, u, *std::move(candidates)};
}

// Scales u to a line without contact in the scope. Returns the factor.
double StepBound::among(PairScope scope, std::span<const Vec3d> p, std::vector<Vec3d>& u) const {
  double factor = 1;
  const std::optional<Line> found = line(scope, p, u, factor);
  if (!found) return 0;
  const ContactCandidates& pairs = *found->candidates.pairs;
  const double to_triangles = smallest(mesh_.point_count(), [&](int i, double most) {
    for (const NearTriangle& near : pairs.near(i)) most = to_triangle(*found, i, near, most);
    return most;
  });
  const double between_edges = smallest(static_cast<int>(pairs.edge_pairs.size()), [&](int k, double most) {
    return of_edges(*found, pairs.edge_pairs[k], most);
  });
  const double step = std::min(to_triangles, between_edges);
  scale(step, u);
  return factor * step;
}

// Shorter lines have fewer candidates, so cheap bounds are computed first.
double StepBound::largest(std::span<const Vec3d> p, std::vector<Vec3d> u) const {
  double step = longest(u);
  scale(step, u);
  const double free = smallest(mesh_.point_count(), [&](int i, double most) { return to_planes(p, u, i, most); });
  scale(free, u);
  step *= free;
  for (const PairScope scope : {PairScope::between_parts, PairScope::within_parts})
    if (step > 0) step *= among(scope, p, u);
  return step;
}

std::vector<Impact> StepBound::with_planes(std::span<const Vec3d> p, std::span<const Vec3d> u) const {
  std::vector<Impact> found;
  for (const ContactPlane& plane : mesh_.planes)
    for (int i = 0; i < mesh_.point_count(); ++i) {
      if (mesh_.row[i] < 0) continue;
      const ContactLaw& law = laws_(mesh_.part[i], plane.part);
      const double gap = dot(plane.normal, p[i] - p[plane.point]) - law.offset, landing = landing_gap(gap, law.reach);
      if (!(gap + dot(plane.normal, u[i] - u[plane.point]) < landing)) continue;
      found.push_back({.point = {i, -1, -1, -1},
                       .distance = {.r = plane.normal, .d = 1},
                       .offset = dot(plane.normal, p[plane.point] + u[plane.point]) + law.offset,
                       .landing = landing,
                       .stiffness = kSpring * law.stiffness * mesh_.area[i] / law.reach});
    }
  return found;
}

Impact StepBound::impact(const MovingPair& pair, const std::array<int, 4>& point, double alpha) const {
  std::array<Vec3d, 4> there;
  for (int k = 0; k < 4; ++k) there[k] = pair.x[k] + alpha * pair.dx[k];
  const Distance distance = pair_distance(pair.kind, there);
  return {.point = point, .distance = distance, .landing = distance.d};
}

void StepBound::add_point_impacts(const Line& line, std::vector<Impact>& found) const {
  const ContactCandidates& pairs = *line.candidates.pairs;
  std::vector<double> alpha(mesh_.point_count(), 1.0);
  std::vector<int> first(mesh_.point_count(), -1);  // first triangle in the path of each point
  parallel_chunks(mesh_.point_count(), [&](int begin, int end) {
    for (int i = begin; i < end; ++i)
      for (const NearTriangle& near : pairs.near(i))
        if (const double step = to_triangle(line, i, near, alpha[i]); step < alpha[i])
          alpha[i] = step, first[i] = near.triangle;
  });
  for (int i = 0; i < mesh_.point_count(); ++i) {
    if (first[i] < 0) continue;
    const Triangle& t = mesh_.triangles[first[i]];
    const ContactLaw& law = laws_(mesh_.part[i], mesh_.part[t[0]]);
    const std::array<int, 4> point = {i, t[0], t[1], t[2]};
    Impact& added = found.emplace_back(impact(pair(line, PairKind::point_triangle, point), point, alpha[i]));
    const double other = std::min({mesh_.area[t[0]], mesh_.area[t[1]], mesh_.area[t[2]]});
    const double area = smaller_area(mesh_.area[i], other);
    added.stiffness = kSpring * law.stiffness * area / law.reach;
  }
}

void StepBound::add_edge_impacts(const Line& line, std::vector<Impact>& found) const {
  const auto& pairs = line.candidates.pairs->edge_pairs;
  std::vector<double> alpha(pairs.size(), 1.0), first(mesh_.edge_count(), 1.0);
  parallel_chunks(static_cast<int>(pairs.size()), [&](int begin, int end) {
    for (int k = begin; k < end; ++k) alpha[k] = of_edges(line, pairs[k], 1);
  });
  for (size_t k = 0; k < pairs.size(); ++k)
    for (const int e : {pairs[k].first, pairs[k].second}) first[e] = std::min(first[e], alpha[k]);
  for (size_t k = 0; k < pairs.size(); ++k) {
    if (!(alpha[k] < 1) || first[pairs[k].first] < alpha[k] || first[pairs[k].second] < alpha[k]) continue;
    const Edge &a = mesh_.edges[pairs[k].first], &b = mesh_.edges[pairs[k].second];
    const ContactLaw& law = laws_(mesh_.part[a[0]], mesh_.part[b[0]]);
    const std::array<int, 4> point = {a[0], a[1], b[0], b[1]};
    Impact& added = found.emplace_back(impact(pair(line, PairKind::edge_edge, point), point, alpha[k]));
    const double area = smaller_area(mesh_.edge_area[pairs[k].first], mesh_.edge_area[pairs[k].second]);
    added.stiffness = kSpring * law.stiffness * area / law.reach;
  }
}

std::vector<Impact> StepBound::impacts(std::span<const Vec3d> p, std::vector<Vec3d> u) const {
  scale(longest(u), u);
  std::vector<Impact> found = with_planes(p, u);
  for (const PairScope scope : {PairScope::between_parts, PairScope::within_parts}) {
    double factor = 1;
    const std::optional<Line> on_line = line(scope, p, u, factor);
    if (!on_line) continue;
    add_point_impacts(*on_line, found);
    add_edge_impacts(*on_line, found);
    if (!found.empty()) break;
  }
  return found;
}

}  // namespace aspic
