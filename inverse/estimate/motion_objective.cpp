#include "estimate/motion_objective.h"

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "base/error.h"
#include "estimate/spectrum.h"
#include "math/vectors.h"
#include "mesh/box.h"
#include "model/limits.h"
#include "model/scaled_inverse.h"

namespace aspic {
namespace {

// Eigenvalue of the scaled J'J: weaker combinations of parameters are held. The columns have errors of kParameterStep,
// whose squares are a tenth of it.
constexpr double kFloor = 1e-7;

Vec3d point_at(const SurfacePoint& marker, const State& state) {
  Vec3d x{};
  for (int i = 0; i < 3; ++i)
    for (int axis = 0; axis < 3; ++axis) x[axis] += marker.weights[i] * state.q[3 * marker.vertices[i] + axis];
  return x;
}

MotionScales scales_of(const MotionModel& model, const MotionData& data, double h) {
  if (data.samples.empty()) throw InvalidInput("no marker position after the start is given");
  MotionScales scales{.time_step = h};
  for (const MotionSample& sample : data.samples) {
    const double time = sample.time - model.start.time;
    if (!(time > 0)) throw InvalidInput("time = " + std::to_string(sample.time) + " s is not after the start");
    const Vec3d path =
        sample.position - data.offset[sample.marker] - point_at(data.markers[sample.marker], model.start);
    scales.duration = std::max(scales.duration, time);
    scales.speed = std::max(scales.speed, norm(path) / time);
  }
  scales.size = size_of(model.model.mesh);
  return scales;
}

MotionParameters make_parameters(MotionModel model, const MotionData& data, const std::vector<std::string>& names,
                                 double h) {
  const MotionScales scales = scales_of(model, data, h);
  return {std::move(model), names, scales};
}

MotionData sorted(MotionData data) {
  std::stable_sort(data.samples.begin(), data.samples.end(), [](const MotionSample& a, const MotionSample& b) {
    return a.time < b.time || (a.time == b.time && a.marker < b.marker);
  });
  return data;
}

}  // namespace

MotionObjective::MotionObjective(MotionModel model, MotionData data, const std::vector<std::string>& names,
                                 TrajectoryOptions options)
    : data_(sorted(std::move(data))),
      parameters_(make_parameters(std::move(model), data_, names, options.h)),
      options_(std::move(options)) {
  const State& start = parameters_.start();
  double square = 0;
  for (const MotionSample& sample : data_.samples) {
    const double steps = (sample.time - start.time) / options_.h;
    if (!(steps > kSame && steps < kMaxTimeSteps))
      throw InvalidInput("time = " + std::to_string(sample.time) + " s is " + std::to_string(steps) +
                         " time steps after the start; it must be between 0 and 1e6 (choose another time.step)");
    const double whole = std::abs(steps - std::round(steps)) < kSame ? std::round(steps) : std::floor(steps);
    places_.push_back({static_cast<int>(whole), std::max(0.0, steps - whole) < kSame ? 0 : steps - whole});
    const Vec3d path = sample.position - data_.offset[sample.marker] - point_at(data_.markers[sample.marker], start);
    square += squared_norm(path);
    resting_ += squared_norm(path) / (2 * sample.sigma * sample.sigma);
  }
  travel_ = std::sqrt(square / static_cast<double>(places_.size()));
  options_.steps = places_.back().step + (places_.back().next > 0 ? 1 : 0);
  for (int step = 0, s = 0; step <= options_.steps + 1; ++step) {
    while (s < static_cast<int>(places_.size()) && places_[s].step < step) ++s;
    first_.push_back(s);
  }
  held_.assign(parameters_.size(), false);
}

// At point k contribute the samples of step k and, with their weight of the next point, those of step k - 1.
double MotionObjective::visit(int point, const State& state, std::span<double> qbar, MotionPoint& result) const {
  for (int s = first_[point]; s < first_[point + 1]; ++s) add(s, 1 - places_[s].next, state, qbar, result);
  if (point == 0) return 0;
  for (int s = first_[point - 1]; s < first_[point]; ++s)
    if (places_[s].next > 0) add(s, places_[s].next, state, qbar, result);
  return 0;
}

void MotionObjective::add(int sample, double weight, const State& state, std::span<double> qbar,
                          MotionPoint& result) const {
  const MotionSample& measured = data_.samples[sample];
  const SurfacePoint& marker = data_.markers[measured.marker];
  if (qbar.empty()) {
    result.simulated[sample] = result.simulated[sample] + weight * (point_at(marker, state));
    return;
  }
  const Vec3d residual = result.simulated[sample] + data_.offset[measured.marker] - measured.position;
  const double scale = weight / (measured.sigma * measured.sigma);
  for (int i = 0; i < 3; ++i)
    for (int axis = 0; axis < 3; ++axis)
      qbar[3 * marker.vertices[i] + axis] += scale * marker.weights[i] * residual[axis];
}

void MotionObjective::finish(MotionPoint& result) const {
  double square = 0;
  for (size_t s = 0; s < result.simulated.size(); ++s) {
    const MotionSample& measured = data_.samples[s];
    result.simulated[s] = result.simulated[s] + data_.offset[measured.marker];
    const Vec3d residual = result.simulated[s] - measured.position;
    square += squared_norm(residual);
    result.value += squared_norm(residual) / (2 * measured.sigma * measured.sigma);
  }
  result.rms = std::sqrt(square / static_cast<double>(result.simulated.size()));
}

MotionPoint MotionObjective::compute(std::span<const double> p, bool with_gradient) {
  MotionPoint result{.p = {p.begin(), p.end()}, .simulated = std::vector<Vec3d>(data_.samples.size())};
  TrajectoryGradient gradient;
  const TrajectoryObjective objective = [&](int point, const State& state, std::span<double> qbar, std::span<double>) {
    return visit(point, state, qbar, result);
  };
  Trajectory trajectory = parameters_.trajectory(p, options_);
  const TrajectoryReport report =
      with_gradient ? trajectory.differentiate(objective, gradient) : trajectory.simulate(objective);
  parameters_.take_back(std::move(trajectory));
  ++simulations_;
  if (with_gradient) ++gradients_;
  result.ok = report.ok;
  result.message = report.message;
  if (!report.ok) return result;
  finish(result);
  if (with_gradient) result.gradient = parameters_.derivatives(p, gradient);
  return result;
}

MotionPoint MotionObjective::simulate(std::span<const double> p) { return compute(p, false); }
MotionPoint MotionObjective::differentiate(std::span<const double> p) { return compute(p, true); }

bool MotionObjective::linearize(const MotionPoint& at) {
  const int n = parameters_.size(), rows = static_cast<int>(3 * data_.samples.size());
  Columns J(rows, n);
  const std::vector<bool> before = held_;
  for (int i = 0; i < n; ++i) {
    std::vector<double> p = at.p;
    double move = kParameterStep;
    p[i] = at.p[i] + move;
    MotionPoint ahead = simulate(p);
    if (!ahead.ok) {
      move = -kParameterStep;
      p[i] = at.p[i] + move;
      ahead = simulate(p);
    }
    double square = 0;
    for (size_t s = 0; ahead.ok && s < data_.samples.size(); ++s) {
      const Vec3d rate = 1 / move * (ahead.simulated[s] - at.simulated[s]);
      square += squared_norm(rate);
      for (int axis = 0; axis < 3; ++axis) J[i][3 * s + axis] = rate[axis] / data_.samples[s].sigma;
    }
    held_[i] = std::sqrt(square / static_cast<double>(data_.samples.size())) <= kSame * travel_;
    if (held_[i]) std::fill(J[i].begin(), J[i].end(), 0.0);
  }
  inverse_ = scaled_inverse(n, product_transposed(J, J), kFloor, Weak::dropped).inverse;
  return held_ != before;
}

bool MotionObjective::is(std::span<const double> x, const MotionPoint& point) const {
  return std::equal(point.p.begin(), point.p.end(), x.begin());
}

Evaluation MotionObjective::at_iterate() const { return {at_.value, 1e-12 * at_.value + 1e-20 * resting_}; }

Evaluation MotionObjective::evaluate(std::span<const double> x) {
  if (is(x, at_)) return at_iterate();
  trial_ = differentiate(x.first(parameters_.size()));
  return {trial_.ok ? trial_.value : INFINITY, at_iterate().round_off};
}

void MotionObjective::gradient(std::span<const double> x, std::span<double> g) {
  const MotionPoint& point = is(x, at_) ? at_ : trial_;
  ASPIC_CHECK(is(x, point));
  std::fill(g.begin(), g.end(), point.ok ? 0.0 : std::nan(""));
  for (int i = 0; point.ok && i < parameters_.size(); ++i) g[i] = held_[i] ? 0 : point.gradient[i];
}

void MotionObjective::note_iterate(std::span<const double> x) {
  if (!is(x, at_)) at_ = trial_;
}

double MotionObjective::max_step(std::span<const double>, std::span<const double> d) {
  return kLinearRange / std::max(max_abs(d), 1e-300);
}

bool MotionObjective::precondition(std::span<const double> r, std::span<double> z) {
  const int n = parameters_.size();
  std::fill(z.begin(), z.end(), 0.0);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) z[i] += inverse_[static_cast<size_t>(n) * i + j] * r[j];
  return true;
}

const BlockSparse& MotionObjective::evaluate_hessian(std::span<const double>, const Projection&) {
  check_failed("the fit of a motion has no Hessian of blocks", __FILE__, __LINE__);
}

}  // namespace aspic
