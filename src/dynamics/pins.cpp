#include "dynamics/pins.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "base/check.h"
#include "base/parallel.h"
#include "math/vectors.h"

namespace aspic {
namespace {

constexpr double kMinSine = 1e-6;  // minimum sine of the angle between a direction and the span of the others

Mat3d projector(std::span<const Vec3d> directions) {  // requires orthonormal directions
  Mat3d sum{};
  for (const Vec3d& n : directions)
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 3; ++c) sum(r, c) += n[r] * n[c];
  return sum;
}

// Returns M^+ for the sum M over independent unit vectors: (M + k k')^-1 - k k', where k is a unit vector of the
// kernel.
Mat3d pseudo_inverse(const Mat3d& M, std::span<const Vec3d> directions) {
  if (squared_norm(M * M - M) < 1e-28) return M;  // orthonormal directions; exact along axes
  if (directions.size() == 3) return inverse(M);
  Vec3d k = cross(directions[0], directions[1]);
  k = (1 / norm(k)) * k;
  const Mat3d K = projector({&k, 1});
  return inverse(M + K) - K;
}

}  // namespace

bool are_independent(std::span<const Vec3d> n) {
  if (n.size() == 2) return dot(cross(n[0], n[1]), cross(n[0], n[1])) > kMinSine * kMinSine;
  return n.size() == 1 || (n.size() == 3 && std::abs(dot(cross(n[0], n[1]), n[2])) > kMinSine);
}

Pins::Pins(const std::vector<Pin>& pins, std::span<const double> start)
    : pins_(&pins), start_(start.begin(), start.end()), kind_(start.size() / 3, kFree), shares_(pins.size()) {
  for (const Pin& pin : pins)
    for (const int v : pin.vertices) {
      if (!pin.directions.empty()) continue;
      ASPIC_CHECK(kind_[v] == kFree);
      kind_[v] = kHeld;
    }
  add_directions();
}

void Pins::add_directions() {
  std::map<int, std::vector<Vec3d>> held;
  for (const Pin& pin : *pins_)
    for (const int v : pin.vertices)
      if (!pin.directions.empty()) held[v].insert(held[v].end(), pin.directions.begin(), pin.directions.end());
  std::map<int, Mat3d> inverses;
  for (const auto& [v, directions] : held) {
    ASPIC_CHECK(kind_[v] == kFree && are_independent(directions));
    const Mat3d M = projector(directions), inverse = pseudo_inverse(M, directions);
    inverses[v] = inverse;
    kind_[v] = directions.size() == 3 ? kHeld : static_cast<int>(projector_.size());
    if (directions.size() < 3) projector_.push_back(inverse * M);
  }
  for (size_t p = 0; p < pins_->size(); ++p) {
    const Pin& pin = (*pins_)[p];
    if (pin.directions.empty()) continue;
    const Mat3d own = projector(pin.directions);
    for (const int v : pin.vertices) shares_[p].push_back({v, inverses[v] * own});
  }
}

bool Pins::holds(int vertex, int axis) const {
  if (kind_[vertex] < 0) return kind_[vertex] == kHeld;
  return projector_[kind_[vertex]](axis, axis) != 0;
}

bool Pins::any_moves() const {
  return std::any_of(pins_->begin(), pins_->end(), [](const Pin& pin) { return pin.motion != nullptr; });
}

Vec3d Pins::held_part(int vertex, const Vec3d& v) const {
  if (kind_[vertex] < 0) return kind_[vertex] == kHeld ? v : Vec3d{};
  return projector_[kind_[vertex]] * v;
}

Vec3d Pins::free_part(int vertex, const Vec3d& v) const {
  if (kind_[vertex] < 0) return kind_[vertex] == kHeld ? Vec3d{} : v;
  return (identity3<double>() - projector_[kind_[vertex]]) * v;
}

Vec3d Pins::reaction_of(int pin, int index, const Vec3d& force) const {
  return shares_[pin].empty() ? force : transpose(shares_[pin][index].factor) * force;
}

void Pins::place(double time, std::span<double> x) const {
  for (size_t p = 0; p < shares_.size(); ++p)  // relative to the initial positions
    for (const Share& share : shares_[p]) {
      const int v = share.vertex;
      set_vec(free_part(v, vec_at(x, v)) + held_part(v, vec_at(start_, v)), v, x);
    }
  for (size_t p = 0; p < pins_->size(); ++p) {
    const Pin& pin = (*pins_)[p];
    for (size_t i = 0; i < pin.vertices.size(); ++i) {
      const int v = pin.vertices[i];
      const Vec3d start = vec_at(start_, v);
      if (pin.directions.empty())
        set_vec(pin.motion ? pin.motion(start, time) : start, v, x);
      else if (pin.motion)
        set_vec(vec_at(x, v) + shares_[p][i].factor * (pin.motion(start, time) - start), v, x);
    }
  }
}

void Pins::set_zero(std::span<double> v) const {
  for (int i = 0; i < vertex_count(); ++i)
    if (kind_[i] != kFree) set_vec(free_part(i, vec_at(v, i)), i, v);
}

void Pins::copy_held(std::span<const double> from, std::span<double> to) const {
  for (int i = 0; i < vertex_count(); ++i) {
    if (kind_[i] == kFree) continue;
    const Vec3d held = held_part(i, vec_at(from, i));
    set_vec(kind_[i] == kHeld ? held : free_part(i, vec_at(to, i)) + held, i, to);
  }
}

// Any s > 0 decouples the pinned directions. The norm of Q H Q preserves the condition number of the block.
Mat3d Pins::with_identity(int vertex, const Mat3d& H) const {
  if (kind_[vertex] == kFree) return H;
  if (kind_[vertex] == kHeld) return identity3<double>();
  const Mat3d& P = projector_[kind_[vertex]];
  const Mat3d Q = identity3<double>() - P, free = Q * H * Q;
  const double size = std::sqrt(squared_norm(free));
  return free + (size > 0 ? size : 1.0) * P;
}

void Pins::set_identity(BlockSparse& H) const {
  const BlockPattern& pattern = *H.pattern;
  parallel_chunks(pattern.rows(), [&](int first, int last) {
    for (int i = first; i < last; ++i)
      for (int64_t k = pattern.row_start[i]; k < pattern.row_start[i + 1]; ++k) {
        const int j = pattern.column[k];
        if (i == j || (is_free(i) && is_free(j))) continue;
        Mat3d& block = H.block[k];
        if (holds(i) || holds(j)) block = {};
        if (kind_[i] >= 0) block = block - projector_[kind_[i]] * block;
        if (kind_[j] >= 0) block = block - block * projector_[kind_[j]];
      }
    for (int i = first; i < last; ++i)
      if (!is_free(i)) H.block[pattern.diagonal(i)] = with_identity(i, H.block[pattern.diagonal(i)]);
  });
  for (Stencil& stencil : H.stencils) set_zero(stencil);
}

// K = Q K Q for the blocks of a stencil; removes its pinned rows.
void Pins::set_zero(Stencil& stencil) const {
  for (int i = 1, k = 0; i < 4; ++i)
    for (int j = 0; j < i; ++j, ++k) {
      if (stencil.row[i] < 0 || stencil.row[j] < 0) continue;
      Mat3d& K = stencil.block[k];
      if (kind_[stencil.row[i]] >= 0) K = K - projector_[kind_[stencil.row[i]]] * K;
      if (kind_[stencil.row[j]] >= 0) K = K - K * projector_[kind_[stencil.row[j]]];
    }
  for (int& row : stencil.row)
    if (row >= 0 && holds(row)) row = -1;
}

}  // namespace aspic
