#include "optimize/newton_system.h"

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "base/stopwatch.h"

namespace aspic {

void KeptHessian::keep(const Objective& E, const BlockSparse& H, std::span<const double> x) {
  H_ = &H;
  x_.assign(x.begin(), x.end());
  number_ = E.hessians_made();
}

void KeptHessian::note_solve(double gradient_norm, double relative_residual) {
  norm_before_ = gradient_norm;
  predicted_norm_ = relative_residual * gradient_norm;
}

bool KeptHessian::serves(double gradient_norm, const InnerAccuracy& accuracy) const {
  if (!H_ || accuracy.enough <= 0) return false;
  return std::abs(gradient_norm - predicted_norm_) <= accuracy.enough * norm_before_;
}

void KeptHessian::restore(Objective& E) {
  if (E.hessians_made() == number_) return;
  const BlockSparse& again = E.hessian(x_, {Definiteness::exact});
  ASPIC_CHECK(&again == H_);
  number_ = E.hessians_made();
}

void NewtonSystem::begin() {
  kept_.drop();
  sprung_.d.clear();
  solver_->begin();
}

void NewtonSystem::begin_direction(Objective& E, const StopToken& stop, bool is_first, double gradient_norm) {
  if (is_first) {
    stops_ = E.traits().stops;
    dense_ = E.traits().dense_rows;
    stiff_ = truncates_ ? nullptr : E.traits().stiff_rows;
  }
  stop_ = stop;
  is_first_ = is_first;
  gradient_norm_ = gradient_norm;
  exact_ = nullptr;
  solver_->set_stop(stop);
  semidefinite_solver_->set_stop(stop);
}

bool NewtonSystem::solve(NewtonTask& task, const Projection& projection) {
  DirectionReport& report = task.report;
  Stopwatch stopwatch;
  const BlockSparse& H = task.E.hessian(task.x, projection);
  ++report.hessians;
  report.kept = false;
  report.projected_elements += task.E.projected_elements();
  report.hessian_seconds += stopwatch.lap();
  if (is_late(report)) return false;
  if (analyzed_version_ != H.pattern->version) {
    solver_->analyze(*H.pattern);
    analyzed_version_ = H.pattern->version;
  }
  ++report.factorizations;
  const bool is_stiff = stiff_ && !stiff_->stiff_rows().empty();
  solver_->set_stiff_rows(is_stiff ? &stiff_->stiff_rows() : nullptr);
  const bool is_definite = factorize(H);
  report.factorize_seconds += stopwatch.lap();
  has_stencils_ = !H.stencils.empty();
  const bool is_exact = projection.kind == Definiteness::exact && !projection.clamps_stencils;
  exact_ = is_exact ? &H : nullptr;
  if (is_definite && solve_factorized(task)) {
    if (avoid_stops(task)) {
      exact_ = nullptr;  // it contains springs now
    } else if (is_exact && !is_stiff && !report.truncated && !report.stopped) {
      kept_.keep(task.E, H, task.x);
    }
    return true;
  }
  const bool is_modified = projection.kind != Definiteness::exact && projection.vertices.empty();
  return is_modified && !truncates_ && !is_late(report) && solve_semidefinite(H, task);
}

bool NewtonSystem::solve_truncated(NewtonTask& task) { return exact_ && solve_semidefinite(*exact_, task); }

// Solves with conjugate gradients, which can handle singular H, for example rotations about a single pinned vertex.
bool NewtonSystem::solve_semidefinite(const BlockSparse& H, NewtonTask& task) {
  DirectionReport& report = task.report;
  Stopwatch stopwatch;
  if (semidefinite_version_ != H.pattern->version) {
    semidefinite_solver_->analyze(*H.pattern);
    semidefinite_version_ = H.pattern->version;
  }
  if (!semidefinite_solver_->factorize(H)) return false;
  const SolveReport solved = semidefinite_solver_->solve(task.g, task.d, task.forcing);
  report.stopped = report.stopped || solved.stopped;
  report.add(solved);
  report.solve_seconds += stopwatch.lap();
  report.truncated = report.truncated || solved.indefinite;
  for (double& di : task.d) di = -di;
  return solved.ok || solved.indefinite || solved.stopped;
}

bool NewtonSystem::solve_with_kept(NewtonTask& task, const InnerAccuracy& accuracy) {
  if (kept_.serves(gradient_norm_, accuracy)) {
    kept_.restore(task.E);
    task.report.kept = solve_factorized(task);
    if (task.report.kept) return true;
  }
  kept_.drop();
  return false;
}

// Springs may turn a direction until E hardly falls along it. Returns whether the last step shows that, once.
bool NewtonSystem::has_misled(NewtonTask& task) {
  constexpr double kPoor = 0.125;  // step length relative to the feasible one
  if (sprung_.d.empty()) return false;
  d_.resize(task.x.size());
  for (size_t i = 0; i < d_.size(); ++i) d_[i] = task.x[i] - sprung_.x[i];
  const double step = task.E.dot(d_, sprung_.d) / task.E.dot(sprung_.d, sprung_.d);
  sprung_.d.clear();
  return step > 0 && step < kPoor * std::min(1.0, sprung_.reach);
}

bool NewtonSystem::avoid_stops(NewtonTask& task) {
  constexpr int kRounds = 2;
  constexpr double kFinest = 1e-9;  // relative residual
  if (!stops_ || task.report.truncated || has_misled(task)) return false;
  bool has_springs = false;
  g_.assign(task.g.begin(), task.g.end());
  double reach = task.E.max_step(task.x, task.d);
  for (int round = 0; round < kRounds && !is_late(task.report); ++round) {
    const BlockSparse* H = stops_->add_stops(task.x, task.d, reach, g_);
    if (!H) break;
    has_springs = true;
    d_.assign(task.d.begin(), task.d.end());
    ++task.report.factorizations;
    const double forcing =
        task.forcing * gradient_norm_ / std::sqrt(task.E.dot(g_, g_));  // springs increase the gradient
    const bool is_solved = factorize(*H) && solve_factorized(task, g_, std::max(forcing, kFinest));
    const double next = is_solved && task.E.dot(task.g, task.d) < 0 ? task.E.max_step(task.x, task.d) : 0;
    if (next == 0 || next < std::min(reach, kUsefulStep)) {
      std::copy(d_.begin(), d_.end(), task.d.begin());
      break;
    }
    reach = next;
  }
  if (has_springs) {
    sprung_.x.assign(task.x.begin(), task.x.end());
    sprung_.d.assign(task.d.begin(), task.d.end());
    sprung_.reach = reach;
  }
  return has_springs;
}

bool NewtonSystem::factorize(const BlockSparse& H) {
  updates_.drop();
  return solver_->factorize(H);
}

// Replaces the solution for H without its dense rows, in task.d, by that for H.
bool NewtonSystem::add_dense_rows(NewtonTask& task, double forcing) {
  if (!dense_ || dense_->dense_rows().empty()) return true;
  if (!updates_.is_ready()) {
    SolveReport work;
    const bool is_ready = updates_.prepare(*solver_, dense_->dense_rows(), forcing, work);
    task.report.add(work);
    if (!is_ready) return false;
  }
  updates_.apply(task.d);
  return true;
}

bool NewtonSystem::solve_factorized(NewtonTask& task, std::span<const double> g, double forcing) {
  DirectionReport& report = task.report;
  Stopwatch stopwatch;
  const double begin = stop_.now();
  const SolveReport solved = solver_->solve(g, task.d, forcing);
  if (solved.iterations > 0) report.stoppable_seconds += stop_.now() - begin;
  report.stopped = report.stopped || solved.stopped;
  report.add(solved);
  report.solve_seconds += stopwatch.lap();
  if (solved.indefinite ? !truncates_ : !solved.ok && !solved.stopped) return false;
  if (solved.ok && !add_dense_rows(task, forcing)) return false;
  report.truncated = report.truncated || solved.indefinite;
  kept_.note_solve(gradient_norm_, solved.relative_residual);
  for (double& di : task.d) di = -di;
  return true;
}

}  // namespace aspic
