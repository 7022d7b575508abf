#include "local_size.h"

#include <algorithm>
#include <cmath>

#include "base/formatted.h"
#include "triangle_tree.h"

namespace aspic {
namespace {

constexpr double kGrowth = 0.4;          // growth of the edge length per distance
constexpr double kRegularTet = 0.11785;  // volume / edge^3
constexpr double kSmallestGap = 0.25;    // fraction of the size; narrower slits may close
constexpr double kLostArea = 0.01;       // fraction of the surface that may be thinner than the smallest edge length

double own_size(const SurfaceSample& sample, const SizeRule& rule) {
  const double wanted = std::min(sample.thickness / rule.tets_across, std::max(sample.gap, kSmallestGap * rule.size));
  return std::min(std::max(wanted, rule.smallest), rule.size);
}

// Cosine between a ray and the normal of the side that it meets. Opposite sides are less than 30 degrees from parallel.
double least_cosine(Sides sides) { return sides == Sides::opposite ? 0.87 : 0; }

double reach(const TriMesh& body, const TriangleTree& tree, const Vec3d& x, const Vec3d& ray, double cosine) {
  constexpr double kTouching = 1e-9;
  const TriangleTree::Hit hit = tree.first_hit(x, ray, kTouching);
  if (hit.triangle < 0 || std::abs(dot(unit_normal(body, hit.triangle), ray)) < cosine) return Box::kInfinity;
  return hit.distance;
}

int parts_per_edge(const TriMesh& body, int triangle, double spacing) {
  constexpr double kMax = 64;
  const auto& [a, b, c] = body.triangles[triangle];
  double longest = 0;
  for (const auto& [from, to] : {std::pair(a, b), std::pair(b, c), std::pair(c, a)}) {
    const Vec3d edge = body.vertices[to] - body.vertices[from];
    longest = std::max(longest, dot(edge, edge));
  }
  return static_cast<int>(std::clamp(std::ceil(std::sqrt(longest) / spacing), 1.0, kMax));
}

// Visits the centroids of n^2 equal parts of a triangle.
template <class Visit>
void for_each_part(const std::array<Vec3d, 3>& X, int n, Visit visit) {
  const auto at = [&](double i, double j) { return X[0] + (i / n) * (X[1] - X[0]) + (j / n) * (X[2] - X[0]); };
  for (int i = 0; i < n; ++i)
    for (int j = 0; i + j < n; ++j) {
      visit(at(i + 1 / 3.0, j + 1 / 3.0));
      if (i + j + 1 < n) visit(at(i + 2 / 3.0, j + 2 / 3.0));
    }
}

// Fraction of the surface that is thinner than `bound`.
double thinner_area(const std::vector<SurfaceSample>& samples, double bound) {
  double thin = 0, all = 0;
  for (const SurfaceSample& sample : samples) {
    all += sample.area;
    if (sample.thickness < bound) thin += sample.area;
  }
  return thin / all;
}

// Thickness such that `part` of the surface is thinner.
double thickness_quantile(const std::vector<SurfaceSample>& samples, double part) {
  double low = 1e-12, high = 16;
  for (int i = 0; i < 60; ++i) {
    const double middle = std::sqrt(low * high);
    (thinner_area(samples, middle) > part ? high : low) = middle;
  }
  return low;
}

// Returns the rule with the smallest bound of the edge length, from rule.smallest up to `highest`, that needs at most
// `most` tets. `highest` satisfies this.
SizeRule with_least_bound(const std::vector<SurfaceSample>& samples, double volume, SizeRule rule, double highest,
                          double most) {
  if (predicted_tets(samples, volume, rule) <= most) return rule;
  double low = rule.smallest, high = highest;
  for (int i = 0; i < 20; ++i) {
    rule.smallest = std::sqrt(low * high);
    (predicted_tets(samples, volume, rule) > most ? low : high) = rule.smallest;
  }
  rule.smallest = high;
  return rule;
}

}  // namespace

std::vector<SurfaceSample> surface_samples(const TriMesh& body, double spacing, Sides sides) {
  constexpr double kMax = 5e4;
  double count = 0;
  for (int t = 0; t < body.triangle_count(); ++t) count += std::pow(parts_per_edge(body, t, spacing), 2);
  if (count > kMax) spacing *= std::sqrt(count / kMax);
  const int stride = 1 + body.triangle_count() / static_cast<int>(kMax);
  const TriangleTree tree(body);
  std::vector<SurfaceSample> samples;
  for (int t = 0; t < body.triangle_count(); t += stride) {
    const Vec3d normal = unit_normal(body, t);
    if (dot(normal, normal) == 0) continue;
    const auto& [a, b, c] = body.triangles[t];
    const int n = parts_per_edge(body, t, spacing);
    const double part = stride * area(body, t) / (n * n);
    for_each_part({body.vertices[a], body.vertices[b], body.vertices[c]}, n, [&](const Vec3d& x) {
      samples.push_back({x, part, reach(body, tree, x, -1.0 * normal, least_cosine(sides)),
                         reach(body, tree, x, normal, least_cosine(Sides::opposite))});
    });
  }
  return samples;
}

// Integrates 1 / edge length^3. Beside a thin sample the edge length grows with the depth, up to half the thickness.
double predicted_tets(const std::vector<SurfaceSample>& samples, double volume, const SizeRule& rule) {
  const double coarse = 1 / std::pow(rule.size, 3);
  double sum = volume * coarse;
  for (const SurfaceSample& sample : samples) {
    const double h = own_size(sample, rule);
    if (h >= rule.size) continue;
    const double depth = std::min(sample.thickness / 2, (rule.size - h) / kGrowth);
    const double end = h + kGrowth * depth;
    sum += sample.area * ((1 / (h * h) - 1 / (end * end)) / (2 * kGrowth) - depth * coarse);
  }
  return sum / kRegularTet;
}

ThinParts choose_rule(const std::vector<SurfaceSample>& samples, double volume, double size, double most_tets) {
  const double uniform = 1.5 * volume / (kRegularTet * std::pow(size, 3));  // number of tets for the size alone
  const double most = std::max(most_tets, uniform);
  ThinParts choice{.rule = {}, .tets = 0, .problem = {}, .thickness = thickness_quantile(samples, kLostArea)};
  const double one_across = std::min(choice.thickness, size), two_across = std::min(choice.thickness / 2, size);
  for (const double across : {2.0, 1.5, 1.0}) {
    choice.tets = predicted_tets(samples, volume, {size, across, one_across});
    if (choice.tets > most) continue;
    choice.rule = with_least_bound(samples, volume, {size, across, two_across}, one_across, most);
    choice.tets = predicted_tets(samples, volume, choice.rule);
    return choice;
  }
  choice.problem = formatted("one tet across its thin parts needs about %.2g tets, more than the limit of %.2g",
                             choice.tets, most_tets);
  return choice;
}

LocalSize::LocalSize(const std::vector<SurfaceSample>& samples, const SizeRule& rule)
    : rule_(rule), least_(rule.size), tree_([&] {
        std::vector<Box> boxes;
        for (const SurfaceSample& sample : samples) {
          const double size = own_size(sample, rule);
          if (size >= rule.size) continue;
          points_.push_back(sample.x);
          sizes_.push_back(size);
          least_ = std::min(least_, size);
          boxes.push_back({sample.x, sample.x});
        }
        return BoxTree(boxes);
      }()) {}

double LocalSize::operator()(const Vec3d& x) const {
  double best = rule_.size;
  const auto squared_reach = [&] { return std::pow((best - least_) / kGrowth, 2); };
  double reach = squared_reach();
  tree_.for_each_near(x, reach, [&](int i) {
    const Vec3d away = x - points_[i];
    best = std::min(best, sizes_[i] + kGrowth * norm(away));
    reach = squared_reach();
  });
  return best;
}

}  // namespace aspic
