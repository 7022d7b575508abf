#include <algorithm>
#include <cmath>

#include "math/vectors.h"
#include "model/gauge.h"
#include "pipeline/fit_stages.h"
#include "pipeline/fit_troubles.h"
#include "pipeline/fitted_values.h"

namespace aspic {
namespace {

// Prediction for residuals r at the estimated systematic errors and layer stiffness.
void put_layers_in(std::span<const double> r, const LoadCase& fitted, CasePrediction& shown) {
  auto residual = r.begin();
  const auto put = [&](const Vec3d& reading, const Vec3d& sigma, Vec3d& to) {
    for (int i = 0; i < 3; ++i) to[i] = reading[i] + *residual++ * sigma[i];
  };
  for (size_t k = 0; k < fitted.positions.size(); ++k)
    put(fitted.positions[k].position, fitted.positions[k].sigma, shown.markers[k]);
  // Predictions across a gauge stay as they are.
  const auto put_along = [&](const std::optional<Vec3d>& gauge, const Vec3d& reading, const Vec3d& sigma, Vec3d& to) {
    if (!gauge) return put(reading, sigma, to);
    const double along = dot(*gauge, reading) + *residual * gauge_sigma(gauge, sigma)[0];
    to = to + (along - dot(*gauge, to)) * *gauge;
    residual += 3;
  };
  if (fitted.force) put_along(fitted.gauge, *fitted.force, fitted.force_sigma, shown.wrench.force);
  if (fitted.torque) put_along(fitted.torque_gauge, *fitted.torque, fitted.torque_sigma, shown.wrench.torque);
}

}  // namespace

void describe(FitState& state, FitModel& model, std::span<const double> p) {
  FitOutcome& outcome = state.outcome;
  outcome.quantities = fitted_quantities(model.map, state.mesh(), p, outcome.known_posterior());
  if (outcome.parts && outcome.parts->are_kept) show_parts(*outcome.parts, outcome.quantities);
  outcome.material = fitted_material(state.data, model.map, p, outcome.quantities);
  if (fits_fibres(state.plan)) {
    outcome.plan.fibre_directions = fibre_directions(model.map, p);
    outcome.fibres = found_fibres(state, model.map, p);
  }
  outcome.at_bound = values_at_bound(model.map, p);
  outcome.counts = model.misfit.counts();
  outcome.cases.resize(state.data.experiment.cases.size());
  state.p.assign(p.begin(), p.end());
  if (model.journal) model.journal->catch_up();
  Misfit& misfit = model.of_all_readings();
  std::vector<double> r(static_cast<size_t>(misfit.residual_count()));
  WithUncertainLayers about_fit(misfit);
  const bool ok = about_fit.evaluate(p, r);
  if (ok) {
    outcome.report.misfit = dot(r, r) / 2;
    if (const std::string worst = describe_worst_row(state.data, state.plan.left_out, misfit, r); !worst.empty())
      state.warn(worst);
    outcome.common_errors = common_errors(state.simulated, about_fit, r);
    about_fit.errors().apply_transposed(r);
  }
  outcome.outliers = outliers(state.simulated, state.data);
  int fitted = 0;
  for (size_t c = 0; c < outcome.cases.size(); ++c) {
    CaseOutcome& shown = outcome.cases[c];
    shown.left_out = is_left_out(state.plan.left_out, state.data.experiment.cases[c]);
    if (shown.left_out) continue;
    const auto [first, count] = misfit.residuals_of(fitted);
    const LoadCase& load = state.simulated.fitted().cases[fitted];
    CasePrediction prediction = misfit.prediction(fitted++);
    if (!ok) continue;
    put_layers_in(std::span(r).subspan(first, count), load, prediction);
    shown.markers_on_mesh = prediction.markers;
    shown.wrench_on_mesh = prediction.wrench;
    prediction = as_read_on_finer_mesh(state.simulated, c, std::move(prediction));
    shown.ok = true;
    shown.markers = std::move(prediction.markers);
    shown.wrench = prediction.wrench;
    shown.marker_sigma.clear();
    for (const MarkerReading& reading : load.positions) shown.marker_sigma.push_back(reading.sigma);
    shown.force_sigma = wrench_factor(state.simulated, c) * load.force_sigma;
    shown.torque_sigma = wrench_factor(state.simulated, c) * load.torque_sigma;
    if (load.force)
      shown.relative_mesh_error =
          relative_force_error(state.simulated, c, norm(state.data.experiment.cases[c].force_sigma));
  }
}

}  // namespace aspic
