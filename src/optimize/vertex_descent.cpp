#include "optimize/vertex_descent.h"

#include <algorithm>
#include <cmath>

#include "base/stopwatch.h"
#include "linalg/conjugate_gradient.h"
#include "linalg/row_coloring.h"

namespace aspic {
namespace {

// Fit to the benchmark beam and the bunny. Sweeps forth and back, which cost twice as much, gain nothing from
// over-relaxation and need ten times as long.
constexpr int kSweeps = 4;
constexpr double kRelaxation = 1.7;

}  // namespace

std::string VertexDescent::description() const {
  return "vertex_descent, " + std::to_string(colors_.size()) + " colours" +
         (whole_ ? ", from whole gradients, since a term offers no systems of single vertices" : "");
}

void VertexDescent::begin() {
  length_.begin();
  cautious_next_ = cautious_ = false;
}

bool VertexDescent::retreat() { return cautious_next_ = !cautious_; }

bool VertexDescent::compute(Objective& E, std::span<const double> x, std::span<const double> g,
                            const InnerAccuracy& accuracy, std::span<double> d, DirectionReport& report) {
  color(E, x, report);
  cautious_ = cautious_next_;
  cautious_next_ = false;
  Stopwatch stopwatch;
  if (!cautious_) {
    y_.assign(x.begin(), x.end());
    for (int i = 0; i < kSweeps && !report.stopped; ++i) {
      for (const auto& vertices : colors_) move(E, vertices, report);
      if (!whole_) ++report.vertex_sweeps;
      report.stopped = accuracy.deadline.has_passed();
    }
    for (size_t i = 0; i < d.size(); ++i) d[i] = y_[i] - x[i];
    const double slope = E.dot(g, d);
    cautious_ = !(slope < 0) || !std::isfinite(slope);
  }
  if (cautious_) block_jacobi(E, x, g, d, report);
  report.solve_seconds += stopwatch.lap();
  return true;
}

void VertexDescent::color(Objective& E, std::span<const double> x, DirectionReport& report) {
  const BlockPattern* pattern = E.coupling();
  if (!pattern) {
    pattern = E.hessian(x, {}).pattern;
    ++report.hessians;
  }
  if (pattern->version == colored_version_) return;
  colors_ = color_rows(*pattern);
  colored_version_ = pattern->version;
  size_t largest = 0;
  for (const auto& vertices : colors_) largest = std::max(largest, vertices.size());
  g_.resize(largest);
  H_.resize(largest);
}

void VertexDescent::systems(Objective& E, std::span<const double> x, const std::vector<int>& vertices,
                            DirectionReport& report) {
  const size_t count = vertices.size();
  whole_ = !E.vertex_systems(x, vertices, std::span(g_).first(count), std::span(H_).first(count));
  if (!whole_) return;
  whole_gradient_.resize(x.size());
  E.gradient(x, whole_gradient_);
  const BlockSparse& H = E.hessian(x, {});
  ++report.gradients;
  ++report.hessians;
  for (size_t k = 0; k < count; ++k) {
    std::copy_n(&whole_gradient_[3 * static_cast<size_t>(vertices[k])], 3, g_[k].a);
    H_[k] = H.block[H.pattern->diagonal(vertices[k])];
  }
}

// Vertices whose system is not finite, such as those of a tet that just turned over, stay where they are.
void VertexDescent::move(Objective& E, const std::vector<int>& vertices, DirectionReport& report) {
  systems(E, y_, vertices, report);
  for (size_t k = 0; k < vertices.size(); ++k) {
    Mat3d inverse;
    if (!invert_made_definite(H_[k], inverse)) continue;
    const Vec3d step = inverse * g_[k];
    if (!std::isfinite(dot(step, step))) continue;
    for (int r = 0; r < 3; ++r) y_[3 * static_cast<size_t>(vertices[k]) + r] -= kRelaxation * step[r];
  }
}

void VertexDescent::block_jacobi(Objective& E, std::span<const double> x, std::span<const double> g,
                                 std::span<double> d, DirectionReport& report) {
  for (const auto& vertices : colors_) {
    systems(E, x, vertices, report);
    for (size_t k = 0; k < vertices.size(); ++k) {
      Mat3d inverse;
      if (!invert_made_definite(H_[k], inverse)) inverse = identity3<double>();
      const size_t first = 3 * static_cast<size_t>(vertices[k]);
      const Vec3d step = inverse * Vec3d{{g[first], g[first + 1], g[first + 2]}};
      for (int r = 0; r < 3; ++r) d[first + r] = -step[r];
    }
  }
  if (!whole_) ++report.vertex_sweeps;
  const double length = length_.along(E, x, g, d, report);
  for (double& di : d) di *= length;
}

}  // namespace aspic
