#include "energy/attachment.h"

#include <algorithm>
#include <cmath>

namespace aspic {
namespace {

// Row i of a spring: the vertex, then the targets. d = sum c_i x_i.
int row_of(const AttachedVertex& a, int i) { return i == 0 ? a.vertex : a.target[i - 1]; }
double coefficient(const AttachedVertex& a, int i) { return i == 0 ? 1 : -a.weight[i - 1]; }

bool covers(const AttachedVertex& a, const Projection& projection) {
  for (int i = 0; i <= a.count; ++i)
    if (projection.covers(row_of(a, i))) return true;
  return false;
}

}  // namespace

Vec3d AttachedVertex::separation(Positions x) const {
  Vec3d d{};  // the sum of differences does not depend on the origin
  for (int i = 0; i < count; ++i) d = d + weight[i] * (point(x, vertex) - point(x, target[i]));
  return d;
}

Attachment::Attachment(std::vector<AttachedVertex> attached)
    : attached_(std::move(attached)), slot_(attached_.size()) {}

double Attachment::largest_gap(Positions x) const {
  double largest = 0;
  for (const AttachedVertex& a : attached_)
    largest = std::max(largest, std::abs(norm(a.separation(x)) - a.rest_length));
  return largest;
}

void Attachment::add_couplings(Couplings& couplings) const {
  for (const AttachedVertex& a : attached_)
    for (int i = 1; i <= a.count; ++i)
      for (int j = 0; j < i; ++j) couplings.emplace_back(row_of(a, i), row_of(a, j));
}

void Attachment::bind(const BlockPattern& pattern) {
  for (size_t s = 0; s < attached_.size(); ++s)
    for (int i = 0, k = 0; i <= attached_[s].count; ++i)
      for (int j = 0; j <= i; ++j, ++k) {
        const auto [low, high] = std::minmax({row_of(attached_[s], i), row_of(attached_[s], j)});
        slot_[s][k] = pattern.slot(high, low);
      }
}

double Attachment::value(Positions x, const Context&) const {
  double V = 0;
  for (const AttachedVertex& a : attached_) {
    const double stretch = norm(a.separation(x)) - a.rest_length;
    V += 0.5 * a.stiffness * stretch * stretch;
  }
  return V;
}

// f = k (1 - l0/|d|) d; zero for a collapsed spring, whose direction is undefined.
void Attachment::add_gradient(Positions x, const Context&, double scale, std::span<double> g) const {
  for (const AttachedVertex& a : attached_) {
    const Vec3d d = a.separation(x);
    const double l = norm(d);
    if (l == 0) continue;
    const Vec3d f = scale * a.stiffness * (1 - a.rest_length / l) * d;
    for (int i = 0; i <= a.count; ++i)
      for (int r = 0; r < 3; ++r) g[3 * row_of(a, i) + r] += coefficient(a, i) * f[r];
  }
}

// Blocks c_i c_j K with K = k (n n' + across (I - n n')), across = 1 - l0/|d|, negative for a compressed spring.
int Attachment::add_hessian(Positions x, const Context&, double scale, const Projection& projection,
                            BlockSparse& H) const {
  int projected = 0;
  for (size_t s = 0; s < attached_.size(); ++s) {
    const AttachedVertex& a = attached_[s];
    const Vec3d d = a.separation(x);
    const double l = norm(d);
    double across = a.rest_length == 0 ? 1 : l > 0 ? 1 - a.rest_length / l : 0;
    if (across < 0 && projection.kind != Definiteness::exact && covers(a, projection)) {
      across = projection.kind == Definiteness::clamped ? 0 : -across;
      ++projected;
    }
    const Vec3d n = l > 0 ? (1 / l) * d : Vec3d{{1, 0, 0}};
    Mat3d K;
    for (int c = 0; c < 3; ++c)
      for (int r = 0; r < 3; ++r) K(r, c) = scale * a.stiffness * ((1 - across) * n[r] * n[c] + (r == c ? across : 0));
    for (int i = 0, k = 0; i <= a.count; ++i)
      for (int j = 0; j <= i; ++j, ++k)
        for (int m = 0; m < 9; ++m) H.block[slot_[s][k]].a[m] += coefficient(a, i) * coefficient(a, j) * K.a[m];
  }
  return projected;
}

}  // namespace aspic
