#include "model/field_roughness.h"

#include <algorithm>
#include <cmath>

#include "mesh/grouped_elements.h"
#include "mesh/tet_shape.h"

namespace aspic {
namespace {

std::vector<GroupedElement<3>> faces_of(const TetMesh& mesh) {
  return grouped_elements<3>(mesh.vertex_count(), [&](const auto& visit) {
    for (int t = 0; t < mesh.tet_count(); ++t) {
      const auto& [a, b, c, d] = mesh.tets[t];
      visit(Triangle{b, c, d}, t), visit(Triangle{a, c, d}, t), visit(Triangle{a, b, d}, t),
          visit(Triangle{a, b, c}, t);
    }
  });
}

}  // namespace

FieldRoughness::FieldRoughness(const TetMesh& mesh, double sharpness) : eps_(1 / sharpness) {
  double total = 0;
  for (int t = 0; t < mesh.tet_count(); ++t) total += share_.emplace_back(volume(mesh, t));
  for (double& share : share_) share /= total;
  const double size = std::cbrt(total);
  for_each_group(faces_of(mesh), [&](const GroupedElement<3>* begin, const GroupedElement<3>* end) {
    if (end != begin + 2) return;
    const int a = begin[0].place, b = begin[1].place;
    pairs_.push_back({a, b, size / norm(centroid(corners(mesh, a)) - centroid(corners(mesh, b)))});
  });
}

std::vector<double> FieldRoughness::squared_gradient(std::span<const double> z) const {
  std::vector<double> s(share_.size(), 0.0);
  for (const Pair& pair : pairs_) {
    const double slope = (z[pair.a] - z[pair.b]) * pair.inverse_distance, part = 0.75 * slope * slope;
    s[pair.a] += part;
    s[pair.b] += part;
  }
  return s;
}

double FieldRoughness::value(std::span<const double> z) const {
  const std::vector<double> s = squared_gradient(z);
  double sum = 0;
  for (size_t t = 0; t < s.size(); ++t)  // sqrt(s + eps^2) - eps without cancellation
    sum += share_[t] * (is_quadratic() ? s[t] / 2 : s[t] / (std::sqrt(s[t] + eps_ * eps_) + eps_));
  return sum;
}

std::vector<double> FieldRoughness::conductivity(std::span<const double> z) const {
  std::vector<double> weight = share_;  // share times derivative by s, doubled
  if (!is_quadratic()) {
    const std::vector<double> s = squared_gradient(z);
    for (size_t t = 0; t < s.size(); ++t) weight[t] /= std::sqrt(s[t] + eps_ * eps_);
  }
  std::vector<double> w;
  w.reserve(pairs_.size());
  for (const Pair& pair : pairs_)
    w.push_back(0.75 * (weight[pair.a] + weight[pair.b]) * pair.inverse_distance * pair.inverse_distance);
  return w;
}

void FieldRoughness::add_gradient(std::span<const double> z, double scale, std::span<double> g) const {
  add_product(z, z, scale, g);
}

void FieldRoughness::add_product(std::span<const double> z, std::span<const double> v, double scale,
                                 std::span<double> y) const {
  const std::vector<double> w = conductivity(z);
  for (size_t k = 0; k < pairs_.size(); ++k) {
    const auto& [a, b, inverse_distance] = pairs_[k];
    const double flux = scale * w[k] * (v[a] - v[b]);
    y[a] += flux;
    y[b] -= flux;
  }
}

void FieldRoughness::add_noise(std::span<const double> z, std::mt19937_64& random, std::span<double> g) const {
  const std::vector<double> w = conductivity(z);
  std::normal_distribution<double> normal;
  for (size_t k = 0; k < pairs_.size(); ++k) {
    const double flux = std::sqrt(w[k]) * normal(random);
    g[pairs_[k].a] += flux;
    g[pairs_[k].b] -= flux;
  }
}

std::vector<MatrixPlace> FieldRoughness::places() const {
  std::vector<MatrixPlace> places;
  places.reserve(3 * pairs_.size());
  for (const auto& [a, b, inverse_distance] : pairs_)
    places.insert(places.end(), {{a, a}, {b, b}, {std::max(a, b), std::min(a, b)}});
  return places;
}

std::vector<double> FieldRoughness::entries(std::span<const double> z) const {
  std::vector<double> entries;
  entries.reserve(3 * pairs_.size());
  for (double w : conductivity(z)) entries.insert(entries.end(), {w, w, -w});
  return entries;
}

}  // namespace aspic
