#include "fit/next_indentation.h"

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "base/error.h"
#include "base/formatted.h"
#include "fit/common_errors.h"
#include "fit/condensed_readings.h"
#include "fit/cross_validation.h"
#include "fit/field_text.h"
#include "fit/gauge.h"
#include "fit/quantity.h"
#include "math/vectors.h"
#include "mesh/surface.h"

namespace aspic {
namespace {

// Readings of an indentation and their standard deviations, averaged over the experiment.
struct Instruments {
  Indenter indenter;
  double depth = 0, position = 0, force = 0, torque = 0;  // standard deviations; 0: not measured
};

Instruments instruments(const Experiment& experiment, const NextIndentationOptions& options) {
  std::vector<double> position, force, torque;
  Instruments result;
  std::optional<Indenter> indenter = options.indenter;
  for (const LoadCase& c : experiment.cases) {
    for (const MarkerReading& r : c.positions) position.push_back(rms_sigma(r.sigma));
    if (c.force) force.push_back(norm(c.force_sigma) / std::sqrt(3.0));
    if (c.torque) torque.push_back(norm(c.torque_sigma) / std::sqrt(3.0));
    if (!c.indenter) continue;
    if (!indenter) indenter = c.indenter;
    result.depth = std::max(result.depth, norm(c.pose.center - c.touch.center));
  }
  if (!indenter) throw InvalidInput("no case has an indenter, so there is no next poke (give an indenter)");
  result.indenter = *indenter;
  if (options.depth > 0) result.depth = options.depth;
  if (!(result.depth > 0)) throw InvalidInput("the depth of the next poke is unknown (give its depth)");
  result.position = median(position), result.force = median(force), result.torque = median(torque);
  return result;
}

LoadCase load_at(const Experiment& experiment, const Instruments& with, const Vec3d& site, const Vec3d& inward) {
  LoadCase load;
  load.name = load.group = "poke at " + describe_point(site);
  load.indenter = with.indenter;
  load.touch.axis = inward;
  load.touch.center = with.indenter.shape == IndenterShape::sphere ? site - with.indenter.radius * inward : site;
  load.pose = load.touch;
  load.pose.center = load.touch.center + with.depth * inward;
  for (size_t m = 0; m < experiment.markers.size() && with.position > 0; ++m)
    if (norm(at_rest(experiment, experiment.markers[m]) - site) >
        with.indenter.radius)  // the indenter hides the others
      load.positions.push_back({static_cast<int>(m), {}, {{with.position, with.position, with.position}}});
  if (with.force > 0) load.force = Vec3d{}, load.force_sigma = {{with.force, with.force, with.force}};
  if (with.torque > 0) load.torque = Vec3d{}, load.torque_sigma = {{with.torque, with.torque, with.torque}};
  return load;
}

// Variances with the candidate's readings: C - W diag(d / (1 + d)) W'.
void set_sigma(const ParameterMap& map, const Posterior& posterior, const Spectrum& s,
               IndentationCandidate& candidate) {
  candidate.sigma = posterior.sigma;
  for (size_t u = 0; u < candidate.sigma.size(); ++u) {
    std::vector<double>& sigma = candidate.sigma[u];
    for (double& x : sigma) x *= x;
    std::vector<double> z(sigma.size());
    for (int k = 0; k < s.W.count(); ++k) {
      map.multiply_fitted(static_cast<int>(u), s.W[k], z);
      for (size_t t = 0; t < z.size(); ++t) sigma[t] -= s.d[k] / (1 + s.d[k]) * z[t] * z[t];
    }
    for (double& x : sigma) x = std::sqrt(std::max(x, 0.0));
  }
}

// "..., known within a factor of 1.9, would be within 1.2", with 95 %.
std::string describe_change(const FitParameter& parameter, double before, double after) {
  const double a = kSigmas95 * before, b = kSigmas95 * after;
  if (is_stiffness(parameter.quantity))
    return formatted(", known within a factor of %.3g, would be within %.3g", std::exp(a), std::exp(b));
  return formatted(", known to +-%.2g on its scale, would be to +-%.2g", a, b);
}

void set_description(const ParameterMap& map, const TetMesh& mesh, const Posterior& posterior,
                     IndentationCandidate& candidate) {
  size_t parameter = 0;
  double largest = -1;
  std::vector<double> best;
  for (size_t u = 0; u < posterior.sigma.size(); ++u) {
    std::vector<double> drop;
    double sum = 0;
    for (size_t t = 0; t < posterior.sigma[u].size(); ++t) {
      drop.push_back(std::pow(posterior.sigma[u][t], 2) - std::pow(candidate.sigma[u][t], 2));
      sum += volume(mesh, static_cast<int>(t)) * drop.back();
    }
    if (sum > largest) largest = sum, parameter = u, best = std::move(drop);
  }
  const size_t t = std::max_element(best.begin(), best.end()) - best.begin();
  const FitParameter& what = map.fitted_parameters()[parameter];
  const std::string where =
      what.parameterization == Parameterization::uniform ? "of the whole body" : describe_place(mesh, best);
  candidate.description = "at " + describe_point(candidate.site) + ": " + what.quantity + " " + where +
                          describe_change(what, posterior.sigma[parameter][t], candidate.sigma[parameter][t]);
}

void judge(const Experiment& experiment, const FittedField& fitted, Posterior& posterior,
           const NextIndentationOptions& options, IndentationCandidate& candidate) {
  const auto& [map, mesh, p] = fitted;
  Experiment one = subset(experiment, [](const LoadCase&) { return false; });
  one.cases = {candidate.load};
  one = condensed(one);
  try {
    Misfit misfit(one, map, options.equilibrium);
    WithUncertainLayers data(misfit);
    std::vector<double> r(misfit.residual_count());
    if (!data.evaluate(p, r) || !data.linearize()) {
      candidate.failure = misfit.failure();
      return;
    }
    const Spectrum s = spectrum(data, *posterior.gaussian, options.spectrum);
    if (!s.ok) {
      candidate.failure = "a derivative could not be computed";
      return;
    }
    for (const double d : s.d) candidate.gain += std::log1p(d) / 2;
    set_sigma(map, posterior, s, candidate);
  } catch (const InvalidInput& error) {  // the indenter does not fit there
    candidate.failure = error.what();
    return;
  }
  set_description(map, mesh, posterior, candidate);
  candidate.ok = true;
}

// Means of the candidates' gains, with weights 1 / distance^2, on the surface.
std::vector<double> spread_gain(const TetMesh& mesh, const std::vector<IndentationCandidate>& candidates) {
  std::vector<double> gain(mesh.rest.size(), 0.0);
  for (const int v : boundary_surface(mesh).tet_vertex) {
    double sum = 0, weights = 0;
    for (const IndentationCandidate& c : candidates) {
      if (!c.ok) continue;
      const Vec3d d = c.site - mesh.rest[v];
      const double weight = 1 / std::max(dot(d, d), 1e-300);
      sum += weight * c.gain, weights += weight;
    }
    if (weights > 0) gain[v] = sum / weights;
  }
  return gain;
}

}  // namespace

NextIndentation next_indentation(const Experiment& experiment, const FittedField& fitted, Posterior& posterior,
                                 const NextIndentationOptions& options) {
  const TetMesh& mesh = fitted.mesh;
  ASPIC_CHECK(posterior.ok);
  const Instruments with = instruments(experiment, options);
  NextIndentation result;
  std::vector<int> fixed = experiment.fixed;
  std::erase_if(fixed, [&](int v) { return v >= mesh.vertex_count(); });  // a refined mesh begins with its vertices
  for (const IndentationSite& site : indentation_sites(mesh, fixed, with.indenter.radius, options.sites)) {
    IndentationCandidate candidate{.vertex = site.vertex, .site = mesh.rest[site.vertex], .inward = site.inward};
    candidate.load = load_at(experiment, with, candidate.site, candidate.inward);
    judge(experiment, fitted, posterior, options, candidate);
    if (!candidate.ok) result.warnings.push_back(candidate.load.name + " could not be judged: " + candidate.failure);
    result.candidates.push_back(std::move(candidate));
  }
  if (result.candidates.empty())
    result.warnings.push_back(
        "there is no site for an indenter: all surface vertices are nearer to a held one than its radius");
  std::stable_sort(result.candidates.begin(), result.candidates.end(),
                   [](const IndentationCandidate& a, const IndentationCandidate& b) {
                     return a.ok != b.ok ? a.ok : a.gain > b.gain;
                   });
  result.gain = spread_gain(mesh, result.candidates);
  return result;
}

}  // namespace aspic
