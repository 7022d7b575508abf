#include "dynamics/incremental_potential.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/check.h"
#include "base/parallel.h"
#include "contact/barrier.h"
#include "dynamics/stiffness_parts.h"
#include "mesh/tet_nodes.h"
#include "mesh/tet_shape.h"

namespace aspic {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

// Strain that defines the smallest characteristic force, for bodies at rest. Far above round-off and far below the
// default tolerance.
constexpr double kMinStrain = 1e-9;

BlockPattern pattern_of(const Model& model) {
  Couplings couplings;
  model.mass->add_couplings(couplings);
  for (const auto& V : model.elasticity) V->add_couplings(couplings);
  for (const auto& V : model.loads) V->add_couplings(couplings);
  for (const auto& D : model.damping) D->add_couplings(couplings);
  BlockPattern pattern = make_pattern(model.mesh.vertex_count(), std::move(couplings));
  pattern.rest_position = model.mesh.rest;
  return pattern;
}

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

// Returns for each vertex v the sum over its tets of volume |grad N_v|^2: the diagonal of the stiffness matrix for a
// unit modulus [m].
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
  return stiffness;
}

}  // namespace

IncrementalPotential::IncrementalPotential(const Model& model, const Pins& pins)
    : model_(model),
      pins_(pins),
      own_(model.share.own(model.mesh.vertex_count())),
      internal_(model),
      pattern_(pattern_of(model)),
      H_(pattern_) {
  model.mass->bind(pattern_);
  const auto add = [this](Energy& term, std::vector<ActiveTerm>& terms) {
    term.bind(pattern_);
    terms.emplace_back(term);
  };
  for (const auto& V : model.elasticity) add(*V, potential_);
  for (const auto& V : model.loads) add(*V, potential_);
  for (const auto& D : model.damping) add(*D, damping_);
  for (size_t k = 0; k < potential_.size(); ++k)
    if (const auto* stiff = dynamic_cast<const StiffEnergy*>(&potential_[k].energy())) stiff_.emplace_back(stiff, k);
  for (size_t k = 0; k < damping_.size(); ++k)
    if (const auto* rim = dynamic_cast<const PressureRim*>(&damping_[k].energy())) rims_.emplace_back(rim, k);
  for (auto* v : {&predicted_, &offset_, &term_}) v->resize(3 * pattern_.rows());
  for (Terms* parts : {&last_, &of_iterate_}) {
    parts->values.resize(potential_.size());
    parts->gradient.resize(term_.size());
    if (!damping_.empty()) parts->damping.resize(term_.size());
  }
  iterate_.reserve(term_.size());
  largest_.resize(pattern_.rows() / kChunkSize + 1);
  measure(model.mesh);
}

void IncrementalPotential::set_potential_step(const StepContext& step) {
  for (ActiveTerm& V : potential_) V.begin_step(step);
}

void IncrementalPotential::move_obstacles(double time, std::optional<double> end) {
  for (ActiveTerm& V : potential_)
    if (&V.energy() == model_.contact) V.begin_step({.h = V.context().h, .time = time, .obstacle_end = end});
}

void IncrementalPotential::set_damping_step(const StepContext& step) {
  for (ActiveTerm& D : damping_) D.begin_step(step);
}

void IncrementalPotential::begin_step(std::span<const double> predicted, double inertia, double factor) {
  predicted_.assign(predicted.begin(), predicted.end());
  inertia_ = inertia;
  factor_ = factor;
  iterate_.clear();
  step_limit_ = std::numeric_limits<double>::infinity();
  gradient_round_off_ = 0;  // known after the first Hessian
}

bool IncrementalPotential::is_lagged() const {
  return std::any_of(damping_.begin(), damping_.end(), [](const ActiveTerm& D) { return D.is_lagged(); });
}

void IncrementalPotential::update_lagged(std::span<const double> q, bool keeps_directions) {
  for (ActiveTerm& D : damping_) D.update_lagged(q, keeps_directions);
  if (is_lagged()) iterate_.clear();  // the forces known there use the earlier coefficients
}

bool IncrementalPotential::relax_lagged() {
  bool is_relaxed = false;
  for (ActiveTerm& D : damping_) is_relaxed = D.relax_lagged() || is_relaxed;
  if (is_relaxed) iterate_.clear();
  return is_relaxed;
}

double IncrementalPotential::squared_distance_to_prediction(std::span<const double> q) const {
  if (model_.share.is_whole()) return model_.mass->squared_distance(q, predicted_);
  return model_.share.sum(model_.mass->squared_distance(q, predicted_, own_));
}

Evaluation IncrementalPotential::evaluate(std::span<const double> q) {
  double E = 0, magnitude = factor_ * growth_stiffness_;
  const auto add = [&](double term) { E += term, magnitude += std::abs(term); };
  if (inertia_ != 0) add(0.5 * inertia_ * squared_distance_to_prediction(q));
  for (size_t k = 0; k < potential_.size(); ++k) add(factor_ * (last_.values[k] = potential_[k].value(q)));
  for (const ActiveTerm& D : damping_) add(factor_ * D.value(q));
  return {E, kEpsilon * magnitude};
}

void IncrementalPotential::gradient(std::span<const double> q, std::span<double> g) {
  gradient_scale_ = radius_ > 0 ? kMinStrain * factor_ * growth_stiffness_ / radius_ : 0;
  exact_scale_ = 0;
  for (Part& part : parts_) {
    part.exact = 0;
    part.scale = part.radius > 0 ? kMinStrain * factor_ * part.growth_stiffness / part.radius : 0;
  }
  if (inertia_ != 0) {
    parallel_chunks(static_cast<int>(q.size()), [&](int first, int last) {
      for (int i = first; i < last; ++i) offset_[i] = inertia_ * (q[i] - predicted_[i]);
    });
    model_.mass->multiply(offset_, g);
    exact_scale_ = free_norm(g);
    gradient_scale_ += exact_scale_;
    add_part_norms(g, true);
  } else {
    std::fill(g.begin(), g.end(), 0.0);
  }
  std::fill(last_.gradient.begin(), last_.gradient.end(), 0.0);
  std::fill(last_.damping.begin(), last_.damping.end(), 0.0);
  for (const ActiveTerm& V : potential_) add_term_gradient(V, q, g, last_.gradient);
  for (const ActiveTerm& D : damping_) add_term_gradient(D, q, g, last_.damping);
  pins_.set_zero(g);
}

void IncrementalPotential::note_iterate(std::span<const double> q) {
  iterate_.assign(q.begin(), q.end());
  std::swap(last_, of_iterate_);
}

bool IncrementalPotential::is_iterate(std::span<const double> q) const {
  return model_.share.all(std::equal(q.begin(), q.end(), iterate_.begin(), iterate_.end()));
}

std::span<const double> IncrementalPotential::known_values(std::span<const double> q) const {
  if (!is_iterate(q)) return {};
  return of_iterate_.values;
}

bool IncrementalPotential::add_known_forces(std::span<const double> q, double weight, std::span<double> gradient,
                                            std::span<double> damping) const {
  if (!is_iterate(q)) return false;
  const double scale = weight / factor_;
  for (size_t i = 0; i < gradient.size(); ++i) gradient[i] += scale * of_iterate_.gradient[i];
  for (size_t i = 0; i < of_iterate_.damping.size(); ++i) damping[i] += scale * of_iterate_.damping[i];
  return true;
}

void IncrementalPotential::add_rim_gradient(Positions q, double weight, std::span<double> g,
                                            const Energy* pressure) const {
  for (const auto& [rim, k] : rims_)
    if (!pressure || pressure == &rim->pressure()) damping_[k].add_gradient(q, weight, g);
}

const BlockSparse& IncrementalPotential::evaluate_hessian(std::span<const double> q, const Projection& projection) {
  projected_elements_ = 0;
  if (inertia_ != 0) {
    model_.mass->assign_to(inertia_, H_);
  } else {
    H_.set_zero();
  }
  for (const ActiveTerm& V : potential_) projected_elements_ += V.add_hessian(q, factor_, projection, H_);
  for (const ActiveTerm& D : damping_) projected_elements_ += D.add_hessian(q, factor_, projection, H_);
  pins_.set_identity(H_);
  stiff_rows_.clear();
  for (const auto& [stiff, k] : stiff_) stiff->add_stiff_rows(q, factor_, stiff_rows_);
  for (StiffRow& row : stiff_rows_)
    for (size_t n = 0; n < row.vertex.size(); ++n) row.g[n] = pins_.free_part(row.vertex[n], row.g[n]);

  gradient_round_off_ = gradient_round_off_at(q);
  return H_;
}

void IncrementalPotential::note_newton_step(std::span<const double> q, std::span<const double> d) {
  for (const auto& [stiff, k] : stiff_) stiff->note_newton_step(q, d, potential_[k].context());
}

// Positions have rounding errors of eps |q|, so forces have errors of eps |q| times the stiffness at a vertex.
double IncrementalPotential::gradient_round_off_at(std::span<const double> q) {
  const double stiffness = parallel_sum(own_, [&](int first, int last) {
    double sum = 0, size = 0;
    for (int i = first; i < last; ++i) {
      for (int r = 0; r < 3; ++r) size = std::max(size, std::abs(q[3 * i + r]));
      if (!pins_.holds(i)) sum += squared_norm(H_.block[pattern_.diagonal(i)]);
    }
    largest_[first / kChunkSize] = size;
    return sum;
  });
  for (Part& part : parts_) part.sum = part.largest = 0;
  if (!parts_.empty())
    for (int i = 0; i < own_; ++i) {
      Part& part = parts_[part_of_[i]];
      for (int r = 0; r < 3; ++r) part.largest = std::max(part.largest, std::abs(q[3 * i + r]));
      if (!pins_.holds(i)) part.sum += squared_norm(H_.block[pattern_.diagonal(i)]);
    }
  sum_parts();
  for (Part& part : parts_) part.round_off = kEpsilon * model_.share.max(part.largest) * std::sqrt(part.sum);
  const double size = model_.share.max(*std::max_element(largest_.begin(), largest_.end()));
  return kEpsilon * size * std::sqrt(model_.share.sum(stiffness));
}

double IncrementalPotential::largest_position(std::span<const double> q) const {
  double size = 0;
  for (const double qi : q) size = std::max(size, std::abs(qi));
  return model_.share.max(size);
}

double IncrementalPotential::total_gradient_round_off(std::span<const double> q) const {
  const double size = largest_position(q);
  const double at_rest = kEpsilon * size * std::hypot(inertia_ * mass_norm_, factor_ * rest_stiffness_);
  return std::max(gradient_round_off_, at_rest) + kEpsilon * gradient_scale_;
}

void IncrementalPotential::add_part_round_off(std::span<const double> q, double weight,
                                              std::span<double> round_offs) const {
  if (parts_.empty()) {
    round_offs[0] += weight * (total_gradient_round_off(q) / factor_);
    return;
  }
  const double size = largest_position(q);
  for (size_t k = 0; k < parts_.size(); ++k) {
    const Part& part = parts_[k];
    const double at_rest = kEpsilon * size * std::hypot(inertia_ * part.mass_norm, factor_ * part.rest_stiffness);
    round_offs[k] += weight * ((std::max(part.round_off, at_rest) + kEpsilon * part.scale) / factor_);
  }
}

// Sums in the order of the vertices, so that the result is independent of the number of threads.
void IncrementalPotential::add_part_norms(std::span<const double> v, bool is_exact) {
  if (parts_.empty()) return;
  for (Part& part : parts_) part.sum = 0;
  for (int i = 0; i < own_; ++i) parts_[part_of_[i]].sum += squared_norm(counted_part(i, point(v, i)));
  sum_parts();
  for (Part& part : parts_) {
    part.scale += std::sqrt(part.sum);
    if (is_exact) part.exact += std::sqrt(part.sum);
  }
}

void IncrementalPotential::measure_parts(std::span<const double> g, std::span<GradientPart> parts) {
  if (parts_.empty()) return whole_.measure_parts(g, parts);
  for (Part& part : parts_) part.sum = 0;
  for (int i = 0; i < own_; ++i) parts_[part_of_[i]].sum += squared_norm(point(g, i));
  sum_parts();
  for (size_t k = 0; k < parts_.size(); ++k) parts[k] = {std::sqrt(parts_[k].sum), parts_[k].scale};
}

double IncrementalPotential::lost_accuracy(std::span<const double> q, std::span<const GradientPart> parts) {
  constexpr double kPositionRoundOff = 16 * kEpsilon;  // rounding error of inertia, from positions
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

double IncrementalPotential::relative_decrement(std::span<const double> g, std::span<const double> d) {
  if (parts_.empty()) return whole_.relative_decrement(g, d);
  for (Part& part : parts_) part.sum = 0;
  for (int i = 0; i < own_; ++i) parts_[part_of_[i]].sum += aspic::dot(point(g, i), point(d, i));
  sum_parts();
  double largest = 0;  // the decrease of coupled parts may be shared
  for (const Part& part : parts_) {
    const double scale = inertia_ * part.growth_inertia + factor_ * part.growth_stiffness;
    if (scale > 0) largest = std::max(largest, std::abs(part.sum) / 2 / scale);
  }
  return std::sqrt(largest);
}

void IncrementalPotential::sum_parts() {
  if (model_.share.is_whole() || parts_.empty()) return;
  std::vector<double> sums;
  for (const Part& part : parts_) sums.push_back(part.sum);
  model_.share.sum(sums);
  for (size_t k = 0; k < parts_.size(); ++k) parts_[k].sum = sums[k];
}

double IncrementalPotential::dot(std::span<const double> a, std::span<const double> b) {
  const size_t own = 3 * static_cast<size_t>(own_);
  return model_.share.sum(Objective::dot(a.first(own), b.first(own)));
}

const BlockSparse& IncrementalPotential::metric() {
  if (!metric_) {
    metric_.emplace(pattern_);
    model_.mass->add_to(1, *metric_);
    pins_.set_identity(*metric_);
  }
  return *metric_;
}

double IncrementalPotential::max_step(std::span<const double> q, std::span<const double> d) {
  double alpha = std::numeric_limits<double>::infinity();
  for (const ActiveTerm& V : potential_) alpha = std::min(alpha, V.max_step(q, d));
  return step_limit_ = alpha;
}

const BlockSparse* IncrementalPotential::add_stops(std::span<const double> q, std::span<const double> d,
                                                   double max_step, std::span<double> g) {
  int added = 0;
  if (max_step < kUsefulStep)
    for (const ActiveTerm& V : potential_) added += V.add_stops(q, d, {factor_, g, H_});
  for (const ActiveTerm& D : damping_) added += D.add_stops(q, d, {factor_, g, H_});
  if (added == 0) return nullptr;
  pins_.set_zero(g);
  pins_.set_identity(H_);
  return &H_;
}

double IncrementalPotential::free_norm(std::span<const double> v) const {
  return std::sqrt(model_.share.sum(parallel_sum(own_, [&](int first, int last) {
    double sum = 0;
    for (int i = first; i < last; ++i) {
      const Vec3d free = pins_.free_part(i, point(v, i));
      for (int r = 0; r < 3; ++r) sum += free[r] * free[r];
    }
    return sum;
  })));
}

void IncrementalPotential::add_term_gradient(const ActiveTerm& term, std::span<const double> q, std::span<double> g,
                                             std::span<double> sum) {
  term.add_gradient(q, factor_, term_);
  const bool is_exact = term.energy().has_constant_gradient();
  add_part_norms(term_, is_exact);
  double squared = parallel_sum(own_, [&](int first, int last) {
    double square = 0;
    for (int i = first; i < last; ++i) {
      const Vec3d counted = counted_part(i, point(term_, i));
      for (int r = 0; r < 3; ++r) {
        const int k = 3 * i + r;
        square += counted[r] * counted[r];
        g[k] += term_[k];
        sum[k] += term_[k];
        term_[k] = 0;
      }
    }
    return square;
  });
  std::fill(term_.begin() + 3 * static_cast<std::ptrdiff_t>(own_), term_.end(), 0.0);
  squared = model_.share.sum(squared);
  gradient_scale_ += std::sqrt(squared);
  if (is_exact) exact_scale_ += std::sqrt(squared);
}

void IncrementalPotential::measure(const TetMesh& mesh) {
  Vec3d center{};
  const double count = model_.share.sum(own_);
  for (int v = 0; v < own_; ++v) center = center + (1.0 / count) * mesh.rest[v];
  model_.share.sum(center.a);
  std::vector<double> rest(term_.size()), growth(term_.size());
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    const Vec3d offset = mesh.rest[v] - center;
    radius_ = std::max(radius_, std::sqrt(aspic::dot(offset, offset)));
    for (int r = 0; r < 3; ++r) {
      rest[3 * v + r] = mesh.rest[v][r];
      growth[3 * v + r] = offset[r];
    }
  }
  radius_ = model_.share.max(radius_);
  H_.set_zero();
  const std::vector<double> unit = unit_stiffness(mesh);
  std::vector<double> modulus(unit.size());
  for (size_t k = 0; k < potential_.size(); ++k) {
    // The barrier of a small gap at rest would raise the round-off floors of the whole run.
    if (&potential_[k].energy() == model_.contact) continue;
    potential_[k].add_hessian(rest, 1, {Definiteness::absolute}, H_);
    if (k + 1 == model_.elasticity.size())
      for (int v = 0; v < pattern_.rows(); ++v) modulus[v] = trace(H_.block[pattern_.diagonal(v)]) / unit[v];
  }
  H_.multiply(growth, term_);
  pattern_.rest_modulus = unit;
  for (int v = 0; v < pattern_.rows(); ++v)
    pattern_.rest_modulus[v] = trace(H_.block[pattern_.diagonal(v)]) / pattern_.rest_modulus[v];
  growth_stiffness_ = dot(growth, term_);
  for (int v = 0; v < own_; ++v) {
    rest_stiffness_ = std::hypot(rest_stiffness_, std::sqrt(squared_norm(H_.block[pattern_.diagonal(v)])));
    mass_norm_ = std::hypot(mass_norm_, std::sqrt(3.0) * model_.mass->vertex_mass()[v]);
  }
  rest_stiffness_ = model_.share.norm(rest_stiffness_);
  mass_norm_ = model_.share.norm(mass_norm_);
  model_.mass->multiply(growth, term_);
  growth_inertia_ = dot(growth, term_);
  measure_parts(mesh, modulus, growth);
  std::fill(term_.begin(), term_.end(), 0.0);
}

void IncrementalPotential::measure_parts(const TetMesh& mesh, std::span<const double> modulus,
                                         std::span<double> growth) {
  const Share& share = model_.share;
  part_of_ = share.is_whole() ? parts_of(mesh, modulus) : share.ranks().parts(mesh, modulus.first(own_));
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
    part.rest_stiffness = std::hypot(part.rest_stiffness, std::sqrt(squared_norm(H_.block[pattern_.diagonal(v)])));
    part.mass_norm = std::hypot(part.mass_norm, std::sqrt(3.0) * model_.mass->vertex_mass()[v]);
  }
  H_.multiply(growth, term_);
  for (int v = 0; v < own_; ++v) parts_[part_of_[v]].growth_stiffness += aspic::dot(point(growth, v), point(term_, v));
  model_.mass->multiply(growth, term_);
  for (int v = 0; v < own_; ++v) parts_[part_of_[v]].growth_inertia += aspic::dot(point(growth, v), point(term_, v));
  for (Part& part : parts_) {
    part.radius = share.max(part.radius);
    part.rest_stiffness = share.norm(part.rest_stiffness);
    part.mass_norm = share.norm(part.mass_norm);
    part.growth_stiffness = share.sum(part.growth_stiffness);
    part.growth_inertia = share.sum(part.growth_inertia);
  }
}

}  // namespace aspic
