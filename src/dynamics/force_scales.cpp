#include "dynamics/force_scales.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/parallel.h"
#include "contact/barrier.h"
#include "dynamics/stiffness_parts.h"
#include "mesh/tet_nodes.h"
#include "mesh/tet_shape.h"

namespace aspic {
namespace {

constexpr double kUnitRoundOff = std::numeric_limits<double>::epsilon();

// Strain that defines the smallest characteristic force, for bodies at rest. Far above round-off and far below the
// default tolerance.
constexpr double kMinStrain = 1e-9;

// Integrals of |grad N|^2 from those of l_i^2, volume / 10, and l_i l_j, volume / 20.
void add_quadratic_stiffness(const TetMesh& mesh, int tet, std::vector<double>& stiffness) {
  const TetCorners X = corners(mesh, tet);
  const double V = std::abs(signed_volume(X));
  const std::array<Vec3d, 4> b = shape_gradients(X);  // grad l_i
  for (int i = 0; i < 4; ++i) stiffness[mesh.tets[tet][i]] += 0.6 * V * squared_norm(b[i]);
  for (int k = 0; k < 6; ++k) {
    const Vec3d &p = b[kTetEdges[k][0]], &q = b[kTetEdges[k][1]];
    stiffness[mesh.mids[tet][k]] += 1.6 * V * (squared_norm(p) + squared_norm(q) + aspic::dot(p, q));
  }
}

// Returns for each vertex v the sum over its elements of volume |grad N_v|^2: the diagonal of the stiffness matrix for
// a unit modulus [m].
std::vector<double> unit_stiffness(const TetMesh& mesh) {
  std::vector<double> stiffness(mesh.vertex_count(), 0.0);
  for (int t = 0; t < mesh.tet_count(); ++t) {
    const Tet& tet = mesh.tets[t];
    if (is_quadratic(mesh, t)) add_quadratic_stiffness(mesh, t, stiffness);
    for (int k = 0; k < 4 && !is_quadratic(mesh, t); ++k) {
      const Vec3d &A = mesh.rest[tet[(k + 1) % 4]], &B = mesh.rest[tet[(k + 2) % 4]], &C = mesh.rest[tet[(k + 3) % 4]];
      const Vec3d normal = cross(B - A, C - A);  // twice the area of the face opposite to v
      const double six_volumes = std::abs(dot(normal, mesh.rest[tet[k]] - A));
      if (six_volumes > 0) stiffness[tet[k]] += dot(normal, normal) / (6 * six_volumes);
    }
  }
  for (size_t t = 0; t < mesh.sheet.size(); ++t)
    for (int k = 0; k < 3; ++k) {
      const Vec3d &A = mesh.rest[mesh.sheet[t][k]], &B = mesh.rest[mesh.sheet[t][(k + 1) % 3]],
                  &C = mesh.rest[mesh.sheet[t][(k + 2) % 3]];
      const double four_areas = 2 * norm(cross(B - A, C - A));
      if (four_areas > 0) stiffness[mesh.sheet[t][k]] += mesh.thickness[t] * squared_norm(C - B) / four_areas;
    }
  for (size_t s = 0; s < mesh.rods.size(); ++s) {
    const auto& [a, b] = mesh.rods[s];
    const double length = norm(mesh.rest[b] - mesh.rest[a]);
    for (const int v : {a, b})
      if (length > 0) stiffness[v] += std::numbers::pi * mesh.radius[s] * mesh.radius[s] / length;
  }
  return stiffness;
}

}  // namespace

std::vector<double> ForceScales::moduli(std::span<const double> unit, const BlockSparse& H) const {
  std::vector<double> modulus;
  for (size_t v = 0; v < unit.size(); ++v)
    modulus.push_back(trace(H.block[H.pattern->diagonal(static_cast<int>(v))]) / unit[v]);
  for (const AngleRow& row : model_.angle_rows) modulus.push_back(modulus[row.vertex]);
  return modulus;
}

void ForceScales::measure(std::span<const ActiveTerm> potential, BlockPattern& pattern, BlockSparse& H) {
  const TetMesh& mesh = model_.mesh;
  const int own_ = model_.own_vertices();
  largest_.resize(pattern.rows() / kChunkSize + 1);
  Vec3d center{};
  const double count = model_.share.sum(own_);
  for (int v = 0; v < own_; ++v) center = center + (1.0 / count) * mesh.rest[v];
  model_.share.sum(center.a);
  const size_t size = 3 * static_cast<size_t>(pattern.rows());
  std::vector<double> rest(size), growth(size), product(size);
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    const Vec3d offset = mesh.rest[v] - center;
    radius_ = std::max(radius_, std::sqrt(aspic::dot(offset, offset)));
    for (int r = 0; r < 3; ++r) {
      rest[3 * v + r] = mesh.rest[v][r];
      growth[3 * v + r] = offset[r];
    }
  }
  radius_ = model_.share.max(radius_);
  H.set_zero();
  const std::vector<double> unit = unit_stiffness(mesh);
  std::vector<double> modulus(pattern.rows());
  for (size_t k = 0; k < potential.size(); ++k) {
    // The barrier of a small gap at rest would raise the round-off floors of the whole run.
    if (&potential[k].energy() == model_.contact) continue;
    potential[k].add_hessian(rest, 1, {Definiteness::absolute}, H);
    if (k + 1 == model_.elasticity.size()) modulus = moduli(unit, H);
  }
  H.multiply(growth, product);
  pattern.rest_modulus = moduli(unit, H);
  growth_stiffness_ = E_.dot(growth, product);
  for (int v = 0; v < own(); ++v) {
    rest_stiffness_ = std::hypot(rest_stiffness_, std::sqrt(squared_norm(H.block[pattern.diagonal(v)])));
    mass_norm_ = std::hypot(mass_norm_, std::sqrt(3.0) * model_.mass->row_mass()[v]);
  }
  rest_stiffness_ = model_.share.norm(rest_stiffness_);
  mass_norm_ = model_.share.norm(mass_norm_);
  model_.mass->multiply(growth, product);
  growth_inertia_ = E_.dot(growth, product);
  measure_parts(modulus, H, growth);
}

void ForceScales::measure_parts(std::span<const double> modulus, const BlockSparse& H, std::span<double> growth) {
  const TetMesh& mesh = model_.mesh;
  const int own_ = model_.own_vertices();
  const Share& share = model_.share;
  part_of_ = share.is_whole() ? parts_of(mesh, modulus) : share.ranks().parts(mesh, modulus.first(own_));
  for (const AngleRow& row : model_.angle_rows) part_of_.push_back(part_of_[row.vertex]);
  const int count = static_cast<int>(share.max(*std::max_element(part_of_.begin(), part_of_.end()))) + 1;
  if (count <= 1) return part_of_.clear();
  parts_.resize(count);
  std::vector<double> sums(4 * static_cast<size_t>(count));  // of the positions, and number of vertices
  for (int v = 0; v < own_; ++v) {
    const std::span<double> sum = std::span(sums).subspan(4 * static_cast<size_t>(part_of_[v]), 4);
    for (int r = 0; r < 3; ++r) sum[r] += mesh.rest[v][r];
    ++sum[3];
  }
  share.sum(sums);
  const auto to_center = [&](int v) {
    const std::span<const double> sum = std::span(sums).subspan(4 * static_cast<size_t>(part_of_[v]), 4);
    return mesh.rest[v] - (1.0 / sum[3]) * Vec3d{{sum[0], sum[1], sum[2]}};
  };
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    const Vec3d offset = to_center(v);
    for (int r = 0; r < 3; ++r) growth[3 * v + r] = offset[r];
  }
  for (int v = 0; v < own_; ++v) {
    Part& part = parts_[part_of_[v]];
    part.radius = std::max(part.radius, norm(to_center(v)));
  }
  for (int v = 0; v < own(); ++v) {
    Part& part = parts_[part_of_[v]];
    part.rest_stiffness = std::hypot(part.rest_stiffness, std::sqrt(squared_norm(H.block[H.pattern->diagonal(v)])));
    part.mass_norm = std::hypot(part.mass_norm, std::sqrt(3.0) * model_.mass->row_mass()[v]);
  }
  std::vector<double> product(growth.size());
  H.multiply(growth, product);
  for (int v = 0; v < own_; ++v)
    parts_[part_of_[v]].growth_stiffness += aspic::dot(point(growth, v), point(product, v));
  model_.mass->multiply(growth, product);
  for (int v = 0; v < own_; ++v) parts_[part_of_[v]].growth_inertia += aspic::dot(point(growth, v), point(product, v));
  for (Part& part : parts_) {
    part.radius = share.max(part.radius);
    part.rest_stiffness = share.norm(part.rest_stiffness);
    part.mass_norm = share.norm(part.mass_norm);
    part.growth_stiffness = share.sum(part.growth_stiffness);
    part.growth_inertia = share.sum(part.growth_inertia);
  }
}

void ForceScales::begin(const StepProblem& problem) {
  counts_pinned_ = problem.counts_pinned_forces;
  inertia_ = problem.inertia;
  factor_ = problem.factor;
  gradient_round_off_ = 0;  // known after the first Hessian
}

void ForceScales::begin_gradient() {
  gradient_scale_ = radius_ > 0 ? kMinStrain * factor_ * growth_stiffness_ / radius_ : 0;
  exact_scale_ = 0;
  for (Part& part : parts_) {
    part.exact = 0;
    part.scale = part.radius > 0 ? kMinStrain * factor_ * part.growth_stiffness / part.radius : 0;
  }
}

void ForceScales::add_inertia(std::span<const double> force) {
  exact_scale_ = free_norm(force);
  gradient_scale_ += exact_scale_;
  add_part_norms(force, true);
}

void ForceScales::add_norm(double norm, bool is_exact) {
  gradient_scale_ += norm;
  if (is_exact) exact_scale_ += norm;
}

void ForceScales::note_hessian(std::span<const double> q, const BlockSparse& H) {
  gradient_round_off_ = round_off_at(q, H);
}

// Positions have rounding errors of eps |q|, so forces have errors of eps |q| times the stiffness at a vertex.
double ForceScales::round_off_at(std::span<const double> q, const BlockSparse& H) {
  const double stiffness = parallel_sum(own(), [&](int first, int last) {
    double sum = 0, size = 0;
    for (int i = first; i < last; ++i) {
      for (int r = 0; r < 3; ++r) size = std::max(size, std::abs(q[3 * i + r]));
      if (!pins_.holds(i)) sum += squared_norm(H.block[H.pattern->diagonal(i)]);
    }
    largest_[first / kChunkSize] = size;
    return sum;
  });
  for (Part& part : parts_) part.sum = part.largest = 0;
  if (!parts_.empty())
    for (int i = 0; i < own(); ++i) {
      Part& part = parts_[part_of_[i]];
      for (int r = 0; r < 3; ++r) part.largest = std::max(part.largest, std::abs(q[3 * i + r]));
      if (!pins_.holds(i)) part.sum += squared_norm(H.block[H.pattern->diagonal(i)]);
    }
  sum_parts();
  for (Part& part : parts_) part.round_off = kUnitRoundOff * model_.share.max(part.largest) * std::sqrt(part.sum);
  const double size = model_.share.max(*std::max_element(largest_.begin(), largest_.end()));
  return kUnitRoundOff * size * std::sqrt(model_.share.sum(stiffness));
}

double ForceScales::largest_position(std::span<const double> q) const {
  double size = 0;
  for (const double qi : q) size = std::max(size, std::abs(qi));
  return model_.share.max(size);
}

void ForceScales::add_part_round_off(std::span<const double> q, double weight, std::span<double> round_offs) const {
  if (parts_.empty()) {
    const double at_rest =
        kUnitRoundOff * largest_position(q) * std::hypot(inertia_ * mass_norm_, factor_ * rest_stiffness_);
    round_offs[0] += weight * ((std::max(gradient_round_off_, at_rest) + kUnitRoundOff * gradient_scale_) / factor_);
    return;
  }
  const double size = largest_position(q);
  for (size_t k = 0; k < parts_.size(); ++k) {
    const Part& part = parts_[k];
    const double at_rest = kUnitRoundOff * size * std::hypot(inertia_ * part.mass_norm, factor_ * part.rest_stiffness);
    round_offs[k] += weight * ((std::max(part.round_off, at_rest) + kUnitRoundOff * part.scale) / factor_);
  }
}

// Sums in the order of the vertices, so that the result is independent of the number of threads.
void ForceScales::add_part_norms(std::span<const double> v, bool is_exact) {
  if (parts_.empty()) return;
  for (Part& part : parts_) part.sum = 0;
  for (int i = 0; i < own(); ++i) parts_[part_of_[i]].sum += squared_norm(counted_part(i, point(v, i)));
  sum_parts();
  for (Part& part : parts_) {
    part.scale += std::sqrt(part.sum);
    if (is_exact) part.exact += std::sqrt(part.sum);
  }
}

void ForceScales::measure_parts(std::span<const double> g, std::span<GradientPart> parts) {
  if (parts_.empty()) return whole_.measure_parts(g, parts);
  for (Part& part : parts_) part.sum = 0;
  for (int i = 0; i < own(); ++i) parts_[part_of_[i]].sum += squared_norm(point(g, i));
  sum_parts();
  for (size_t k = 0; k < parts_.size(); ++k) parts[k] = {std::sqrt(parts_[k].sum), parts_[k].scale};
}

double ForceScales::lost_accuracy(std::span<const double> q, std::span<const GradientPart> parts) {
  constexpr double kPositionRoundOff = 16 * kUnitRoundOff;  // rounding error of inertia, from positions
  double lost = 0;
  const double size = largest_position(q);
  for (size_t k = 0; k < parts.size(); ++k) {
    const double exact = parts_.empty() ? exact_scale_ : parts_[k].exact;
    const double mass = parts_.empty() ? mass_norm_ : parts_[k].mass_norm;
    const bool is_hidden = exact > kPositionRoundOff * size * inertia_ * mass && parts[k].norm > kResolved * exact;
    if (is_hidden) lost = std::max(lost, std::min(1.0, parts[k].norm / exact));
  }
  return lost;
}

double ForceScales::relative_decrement(std::span<const double> g, std::span<const double> d) {
  if (parts_.empty()) return whole_.relative_decrement(g, d);
  for (Part& part : parts_) part.sum = 0;
  for (int i = 0; i < own(); ++i) parts_[part_of_[i]].sum += aspic::dot(point(g, i), point(d, i));
  sum_parts();
  double largest = 0;  // the decrease of coupled parts may be shared
  for (const Part& part : parts_) {
    const double scale = inertia_ * part.growth_inertia + factor_ * part.growth_stiffness;
    if (scale > 0) largest = std::max(largest, std::abs(part.sum) / 2 / scale);
  }
  return std::sqrt(largest);
}

void ForceScales::sum_parts() {
  if (model_.share.is_whole() || parts_.empty()) return;
  std::vector<double> sums;
  for (const Part& part : parts_) sums.push_back(part.sum);
  model_.share.sum(sums);
  for (size_t k = 0; k < parts_.size(); ++k) parts_[k].sum = sums[k];
}

double ForceScales::free_norm(std::span<const double> v) const {
  return std::sqrt(model_.share.sum(parallel_sum(own(), [&](int first, int last) {
    double sum = 0;
    for (int i = first; i < last; ++i) {
      const Vec3d free = pins_.free_part(i, point(v, i));
      for (int r = 0; r < 3; ++r) sum += free[r] * free[r];
    }
    return sum;
  })));
}

}  // namespace aspic
