#include "contact/step_bound.h"

#include <algorithm>
#include <optional>

#include "base/parallel.h"
#include "mesh/ccd.h"

namespace aspic {
namespace {

constexpr double kLanding = 0.5;          // gap at which a step ends, relative to the reach
constexpr double kFar = 0.1;              // of the size of a part
constexpr double kShortest = 1.0 / 1024;  // step that is worth a search for pairs

// As in StepRule.
double landing_gap(double gap, double reach) { return gap > reach ? kLanding * reach : 0.2 * gap; }

// The smallest of step_of(i, upper bound) for all i.
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

void scale(double factor, std::span<Vec3d> u) {
  if (factor == 1) return;
  for (Vec3d& ui : u) ui = factor * ui;
}

}  // namespace

// Returns a step of at most 1 on which no point moves further than kFar relative to its part. Longer ones have too many
// candidates.
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
    const double gap = dot(plane.normal, p[i] - plane.origin), rate = dot(plane.normal, u[i]);
    const double reach = laws_(mesh_.part[i], plane.part).reach;
    if (rate < 0) step = std::min(step, std::max(0.0, (gap - landing_gap(gap, reach)) / -rate));
  }
  return step;
}

double StepBound::to_triangles(const Line& line, int i, double step) const {
  const auto& [p, u, candidates] = line;
  for (const NearTriangle& near : candidates.pairs->near(i)) {
    const auto& [a, b, c] = mesh_.triangles[near.triangle];
    const double reach = laws_(mesh_.part[i], mesh_.part[a]).reach;
    if (candidates.least_gap(i, near, {a, b, c}) > reach) continue;
    const MovingPair moving{PairKind::point_triangle, {p[i], p[a], p[b], p[c]}, {u[i], u[a], u[b], u[c]}};
    step = largest_step(moving, {.landing = kLanding * reach, .horizon = step}).alpha;
  }
  return step;
}

double StepBound::of_edges(const Line& line, int number, double step) const {
  const auto& [p, u, candidates] = line;
  const EdgePair& pair = candidates.pairs->edge_pairs[number];
  const auto& [a, b] = mesh_.edges[pair.first];
  const auto& [e, f] = mesh_.edges[pair.second];
  if (candidates.least_gap(pair, {a, b}, {e, f}) > kEdgeReach * laws_(mesh_.part[a], mesh_.part[e]).reach) return step;
  const MovingPair moving{PairKind::edge_edge, {p[a], p[b], p[e], p[f]}, {u[a], u[b], u[e], u[f]}};
  return largest_step(moving, {.landing = kLanding * edge_reach(mesh_, laws_, pair), .horizon = step}).alpha;
}

// Scales u to a line that has few enough candidates and no contact in the scope. Returns the factor.
double StepBound::among(PairScope scope, std::span<const Vec3d> p, std::vector<Vec3d>& u) const {
  double factor = 1;
  std::optional<PathCandidates> candidates;
  while (!(candidates = search_.along(scope, p, u))) {
    factor /= 2;
    scale(0.5, u);
    if (factor < kShortest) return 0;
  }
  const Line line{p, u, *std::move(candidates)};
  const auto& edge_pairs = line.candidates.pairs->edge_pairs;
  const double step = std::min(
      smallest(mesh_.point_count(), [&](int i, double most) { return to_triangles(line, i, most); }),
      smallest(static_cast<int>(edge_pairs.size()), [&](int k, double most) { return of_edges(line, k, most); }));
  scale(step, u);
  return factor * step;
}

// Shorter lines have fewer candidates, so what costs little comes first.
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

}  // namespace aspic
