#include "dynamics/incremental_potential.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/parallel.h"

namespace aspic {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

BlockPattern pattern_of(const Model& model) {
  Couplings couplings;
  model.mass->add_couplings(couplings);
  for (const auto& V : model.elasticity) V->add_couplings(couplings);
  for (const auto& V : model.loads) V->add_couplings(couplings);
  for (const auto& D : model.damping) D->add_couplings(couplings);
  BlockPattern pattern = make_pattern(model.rows(), std::move(couplings));
  pattern.rest_position = model.mesh.rest;
  for (const AngleRow& row : model.angle_rows) pattern.rest_position.push_back(row.center);
  pattern.angle_rows = static_cast<int>(model.angle_rows.size());
  return pattern;
}

}  // namespace

IncrementalPotential::IncrementalPotential(const Model& model, const Pins& pins)
    : model_(model),
      pins_(pins),
      own_(model.own_rows()),
      pattern_(pattern_of(model)),
      terms_(model, pattern_),
      rows_(terms_, pins),
      sizes_(*this, model, pins),
      H_(pattern_) {
  model.mass->bind(pattern_);
  for (auto* v : {&predicted_, &offset_, &term_}) v->resize(3 * pattern_.rows());
  for (Sums* sums : {&last_, &of_iterate_}) {
    sums->values.resize(terms_.potential().size());
    sums->gradient.resize(term_.size());
    if (!terms_.damping().empty()) sums->damping.resize(term_.size());
  }
  iterate_.reserve(term_.size());
  sizes_.measure(terms_.potential(), pattern_, H_);
}

void IncrementalPotential::at(const StepProblem& problem) {
  if (problem.context) terms_.begin(*problem.context);
  if (!problem.internal.empty()) terms_.set_internal(problem.internal, problem.duration);
  predicted_.assign(problem.predicted.begin(), problem.predicted.end());
  inertia_ = problem.inertia;
  factor_ = problem.factor;
  sizes_.begin(problem);
  iterate_.clear();
  step_limit_ = std::numeric_limits<double>::infinity();
}

ObjectiveTraits IncrementalPotential::traits() {
  return {.metric = this, .parts = &sizes_, .stops = this, .stiff_rows = &rows_, .dense_rows = &rows_, .lag = &terms_};
}

double IncrementalPotential::squared_distance_to_prediction(std::span<const double> q) const {
  if (model_.share.is_whole()) return model_.mass->squared_distance(q, predicted_);
  return model_.share.sum(model_.mass->squared_distance(q, predicted_, own_));
}

Evaluation IncrementalPotential::evaluate(std::span<const double> q) {
  double E = 0, magnitude = factor_ * sizes_.growth_stiffness();
  const auto add = [&](double term) { E += term, magnitude += std::abs(term); };
  if (inertia_ != 0) add(0.5 * inertia_ * squared_distance_to_prediction(q));
  const std::vector<ActiveTerm>& potential = terms_.potential();
  for (size_t k = 0; k < potential.size(); ++k) add(factor_ * (last_.values[k] = potential[k].value(q)));
  for (const ActiveTerm& D : terms_.damping()) add(factor_ * D.value(q));
  return {E, kEpsilon * magnitude};
}

void IncrementalPotential::gradient(std::span<const double> q, std::span<double> g) {
  sizes_.begin_gradient();
  if (inertia_ != 0) {
    parallel_chunks(static_cast<int>(q.size()), [&](int first, int last) {
      for (int i = first; i < last; ++i) offset_[i] = inertia_ * (q[i] - predicted_[i]);
    });
    model_.mass->multiply(offset_, g);
    sizes_.add_inertia(g);
  } else {
    std::fill(g.begin(), g.end(), 0.0);
  }
  std::fill(last_.gradient.begin(), last_.gradient.end(), 0.0);
  std::fill(last_.damping.begin(), last_.damping.end(), 0.0);
  for (const ActiveTerm& V : terms_.potential()) add_term_gradient(V, q, g, last_.gradient);
  for (const ActiveTerm& D : terms_.damping()) add_term_gradient(D, q, g, last_.damping);
  pins_.set_zero(g);
}

void IncrementalPotential::note_iterate(std::span<const double> q) {
  iterate_.assign(q.begin(), q.end());
  iterate_lag_ = terms_.lag_updates();
  std::swap(last_, of_iterate_);
}

bool IncrementalPotential::is_iterate(std::span<const double> q) const {
  const bool is_there = std::equal(q.begin(), q.end(), iterate_.begin(), iterate_.end());
  return model_.share.all(is_there && iterate_lag_ == terms_.lag_updates());
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

const BlockSparse& IncrementalPotential::evaluate_hessian(std::span<const double> q, const Projection& projection) {
  projected_elements_ = 0;
  if (inertia_ != 0) {
    model_.mass->assign_to(inertia_, H_);
  } else {
    H_.set_zero();
  }
  for (const ActiveTerm& V : terms_.potential()) projected_elements_ += V.add_hessian(q, factor_, projection, H_);
  for (const ActiveTerm& D : terms_.damping()) projected_elements_ += D.add_hessian(q, factor_, projection, H_);
  pins_.set_identity(H_);
  rows_.evaluate(q, factor_);
  sizes_.note_hessian(q, H_);
  return H_;
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
  for (const ActiveTerm& V : terms_.potential()) alpha = std::min(alpha, V.max_step(q, d));
  return step_limit_ = alpha;
}

const BlockSparse* IncrementalPotential::add_stops(std::span<const double> q, std::span<const double> d,
                                                   double max_step, std::span<double> g) {
  int added = 0;
  if (max_step < kUsefulStep)
    for (const ActiveTerm& V : terms_.potential()) added += V.add_stops(q, d, {factor_, g, H_});
  for (const ActiveTerm& D : terms_.damping()) added += D.add_stops(q, d, {factor_, g, H_});
  if (added == 0) return nullptr;
  pins_.set_zero(g);
  pins_.set_identity(H_);
  return &H_;
}

void IncrementalPotential::add_term_gradient(const ActiveTerm& term, std::span<const double> q, std::span<double> g,
                                             std::span<double> sum) {
  term.add_gradient(q, factor_, term_);
  const bool is_exact = term.energy().has_constant_gradient();
  sizes_.add_part_norms(term_, is_exact);
  const double squared = parallel_sum(own_, [&](int first, int last) {
    double square = 0;
    for (int i = first; i < last; ++i) {
      const Vec3d counted = sizes_.counted_part(i, point(term_, i));
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
  sizes_.add_norm(std::sqrt(model_.share.sum(squared)), is_exact);
}

}  // namespace aspic
