#include "dynamics/pins.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "base/parallel.h"
#include "math/symmetric_eigen.h"
#include "math/vectors.h"

namespace aspic {
namespace {

constexpr double kMinSine = 1e-6;  // minimum sine of the angle between a direction and the span of the others

Mat3d projector(std::span<const Vec3d> directions) {  // requires orthonormal directions
  Mat3d sum{};
  for (const Vec3d& n : directions) sum = sum + outer(n, n);
  return sum;
}
Mat3d projector(const Pin& pin) { return pin.directions.empty() ? identity3<double>() : projector(pin.directions); }

// Returns M^+ for the sum M over unit vectors.
Mat3d pseudo_inverse(const Mat3d& M) {
  if (squared_norm(M * M - M) < 1e-28) return M;  // orthonormal directions; exact along axes
  std::array<double, 9> entries;
  std::copy(M.a, M.a + 9, entries.begin());
  const SymmetricEigen<3> e = symmetric_eigen<3, double>(entries);
  Mat3d sum{};
  for (int k = 0; k < 3; ++k) {
    const Vec3d v = {{e.vectors[3 * k], e.vectors[3 * k + 1], e.vectors[3 * k + 2]}};
    if (e.values[k] > kMinSine * kMinSine) sum = sum + (1 / e.values[k]) * outer(v, v);
  }
  return sum;
}

}  // namespace

double disagreement(std::span<const Pin* const> pins, const Vec3d& start, double time) {
  const auto moved = [&](const Pin& pin) { return pin.motion ? pin.motion(start, time) - start : Vec3d{}; };
  Mat3d M{};
  Vec3d sum{};
  for (const Pin* pin : pins) {
    M = M + projector(*pin);
    sum = sum + projector(*pin) * moved(*pin);
  }
  const Vec3d mean = pseudo_inverse(M) * sum;
  double most = 0;
  for (const Pin* pin : pins) most = std::max(most, norm(projector(*pin) * (mean - moved(*pin))));
  return most;
}

Pins::Pins(const std::vector<Pin>& pins, std::span<const double> start)
    : pins_(&pins), start_(start.begin(), start.end()), kind_(start.size() / 3, kFree), shares_(pins.size()) {
  std::vector<int> holders(kind_.size(), 0);
  for (const Pin& pin : pins)
    for (const int v : pin.vertices) ++holders[v];
  std::map<int, Mat3d> held;  // M of the vertices that one pin does not hold alone in all directions
  std::vector<char> is_shared(pins.size(), 0);
  for (size_t p = 0; p < pins.size(); ++p)
    for (const int v : pins[p].vertices)
      if (pins[p].directions.empty() && holders[v] == 1) {
        kind_[v] = kHeld;
      } else {
        held[v] = held[v] + projector(pins[p]);
        is_shared[p] = 1;
      }
  std::map<int, Mat3d> inverses;
  for (const auto& [v, M] : held) {
    const Mat3d inverse = inverses[v] = pseudo_inverse(M), P = inverse * M;
    kind_[v] = trace(P) > 2.5 ? kHeld : static_cast<int>(projector_.size());
    if (kind_[v] != kHeld) projector_.push_back(P);
  }
  for (size_t p = 0; p < pins.size(); ++p)
    for (size_t i = 0; is_shared[p] && i < pins[p].vertices.size(); ++i) {
      const int v = pins[p].vertices[i];
      const auto inverse = inverses.find(v);
      shares_[p].push_back({v, inverse == inverses.end() ? identity3<double>() : inverse->second * projector(pins[p])});
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
      if (shares_[p].empty())
        set_vec(pin.motion ? pin.motion(start, time) : start, v, x);
      else if (pin.motion)
        set_vec(vec_at(x, v) + shares_[p][i].factor * (pin.motion(start, time) - start), v, x);
    }
  }
}

void Pins::set_zero(std::span<double> v) const {
  for (int i = 0; i < rows(); ++i)
    if (kind_[i] != kFree) set_vec(free_part(i, vec_at(v, i)), i, v);
}

void Pins::copy_held(std::span<const double> from, std::span<double> to) const {
  for (int i = 0; i < rows(); ++i) {
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
