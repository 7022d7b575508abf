#include "model/misfit.h"

#include <algorithm>
#include <limits>

#include "base/check.h"
#include "base/error.h"
#include "base/parallel.h"
#include "math/vectors.h"
#include "model/common_errors.h"
#include "model/gauge.h"
#include "model/limits.h"
#include "model/load_case.h"
#include "model/refined_experiment.h"
#include "model/unloaded_shape.h"

namespace aspic {

Vec3d at_rest(const Experiment& experiment, const SurfacePoint& point) {
  Vec3d X{};
  for (int i = 0; i < 3; ++i) X = X + point.weights[i] * experiment.mesh.rest[point.vertices[i]];
  return X;
}

namespace {

// Whether the derivatives of the body are those at its accepted positions.
bool has_linearized_accepted(const LoadedBody& body) {
  const std::span<const double> at = body.linearized_x(), x = body.accepted();
  return std::equal(at.begin(), at.end(), x.begin(), x.end());
}

}  // namespace

struct Misfit::Impl {
  struct Case {
    std::unique_ptr<LoadedBody> body;
    int first = 0;                        // index of its first residual
    std::vector<double> start, thetabar;  // scratch
    bool is_used = true, ok = false;
  };

  Impl(const Experiment& e, const ParameterMap& m, const EquilibriumOptions& o) : experiment(e), map(m), options(o) {
    if (experiment.cases.empty()) throw InvalidInput("there is no load case to fit");
    if (is_scanned() && map.size() > kMaxUnloaded)
      throw InvalidInput("a mesh that was scanned under load allows " + std::to_string(kMaxUnloaded) +
                         " values to fit; there are " + std::to_string(map.size()) + " (try --unknown young=uniform)");
    cases = bodies(experiment, parameters_at(map.guess()));
    for (const Case& c : cases) residual_count += c.body->residual_count();
    per_tet = map.parameters_per_tet();
    parts_of.resize(map.tet_count());
    for (int t = 0; t < experiment.mesh.tet_count(); ++t)
      parts_of[experiment.parent.empty() ? t : experiment.parent[t]].push_back(t);
    dtheta.resize(static_cast<size_t>(per_tet) * map.tet_count());
    dtheta_of_parts.resize(static_cast<size_t>(per_tet) * experiment.mesh.tet_count());
    dp.resize(map.size());
  }

  bool is_scanned() const { return experiment.scan_gravity.has_value(); }

  std::vector<Case> bodies(const Experiment& of, const std::vector<MaterialParameters>& guess) const {
    std::vector<Case> result;
    int first = 0;
    for (const LoadCase& load : of.cases) {
      Case& c = result.emplace_back();
      c.body = std::make_unique<LoadedBody>(of, load, map.material(), guess, options);
      c.first = first;
      first += c.body->residual_count();
    }
    return result;
  }

  int case_count() const { return static_cast<int>(cases.size()); }

  // Solves the cases in parallel if there are enough of them, otherwise one after another, each on all threads.
  template <class Body>
  void for_each_case(const Body& body) {
    for_each(case_count(), [&](int c) {
      if (cases[c].is_used) body(cases[c]);
    });
  }
  template <class Body>
  static void for_each(int count, const Body& body) {
    if (count >= thread_count()) {
      parallel_for(count, body);
    } else {
      for (int i = 0; i < count; ++i) body(i);
    }
  }

  std::vector<MaterialParameters> parameters_at(std::span<const double> p) const {
    return of_tets(experiment, map.parameters(p));
  }

  // Changes of the material parameters of each simulated tet.
  const std::vector<double>& theta_tangent(std::span<const double> direction) {
    map.multiply(linear_p, direction, dtheta);
    parallel_chunks(map.tet_count(), [&](int first, int last) {
      for (int t = first; t < last; ++t)
        for (const int part : parts_of[t])
          std::copy_n(dtheta.begin() + static_cast<ptrdiff_t>(per_tet) * t, per_tet,
                      dtheta_of_parts.begin() + static_cast<ptrdiff_t>(per_tet) * part);
    });
    return dtheta_of_parts;
  }

  // dtheta = the sum over all cases and over the parts of each tet
  void sum_theta_adjoints() {
    parallel_chunks(map.tet_count(), [&](int first, int last) {
      std::fill(dtheta.begin() + static_cast<ptrdiff_t>(per_tet) * first,
                dtheta.begin() + static_cast<ptrdiff_t>(per_tet) * last, 0.0);
      for (const Case& c : cases)
        for (int t = first; c.is_used && t < last; ++t)
          for (const int part : parts_of[t])
            for (int k = 0; k < per_tet; ++k)
              dtheta[static_cast<size_t>(per_tet) * t + k] += c.thetabar[static_cast<size_t>(per_tet) * part + k];
    });
  }

  // Equilibria of bodies with the unloaded shape of p, from those of the last evaluation; nothing if there are none.
  struct Shape {
    std::unique_ptr<Experiment> experiment;
    std::vector<Case> cases;
  };
  std::optional<Shape> unloaded_at(std::span<const double> p, const std::vector<MaterialParameters>& parameters) {
    UnloadedShape found = unloaded(experiment, map.material(), parameters_at(p), options);
    failure = found.failure;
    if (!found.experiment) return {};
    Shape shape{std::make_unique<Experiment>(std::move(*found.experiment)), {}};
    shape.cases = bodies(*shape.experiment, parameters);
    for_each(case_count(), [&](int c) {
      Case& own = shape.cases[c];
      if (has_solved) own.body->restore(cases[c].body->accepted());
      own.is_used = cases[c].is_used;
      own.ok = !own.is_used || own.body->solve(parameters, {});
      if (!own.is_used) return;
      own.body->accept();
    });
    if (!all_ok(shape.cases)) return {};
    return shape;
  }

  bool evaluate_unloaded(std::span<const double> p, std::span<double> r) {
    std::optional<Shape> shape = unloaded_at(p, parameters_at(p));
    if (!shape) return false;
    cases = std::move(shape->cases);
    unloaded_experiment = std::move(shape->experiment);
    is_linearized = false;
    has_solved = true;
    put_residuals(cases, r);
    accepted_p.assign(p.begin(), p.end());
    accepted_parameters = parameters_at(p);
    return true;
  }

  static void put_residuals(std::vector<Case>& of, std::span<double> r) {
    std::fill(r.begin(), r.end(), 0.0);
    for (Case& c : of)
      if (c.is_used) c.body->residuals(r.subspan(c.first, c.body->residual_count()));
  }

  // shape_slopes[k] = (dr/dX) (dX/dp_k), X the unloaded shape.
  bool linearize_shape() {
    shape_slopes.clear();
    std::vector<double> p = accepted_p, ahead(static_cast<size_t>(residual_count)), back = ahead;
    for (size_t k = 0; k < p.size(); ++k) {
      for (const double sign : {1.0, -1.0}) {
        p[k] = accepted_p[k] + sign * kCentralStep;
        std::optional<Shape> shape = unloaded_at(p, accepted_parameters);
        p[k] = accepted_p[k];
        if (!shape) return false;
        put_residuals(shape->cases, sign > 0 ? ahead : back);
      }
      std::vector<double>& slope = shape_slopes.emplace_back(ahead);
      for (size_t i = 0; i < slope.size(); ++i) slope[i] = (ahead[i] - back[i]) / (2 * kCentralStep);
    }
    return true;
  }

  bool evaluate(std::span<const double> p, std::span<double> r) {
    if (is_scanned()) return evaluate_unloaded(p, r);
    const std::vector<MaterialParameters> parameters = parameters_at(p);
    if (is_linearized) {
      for (size_t i = 0; i < dp.size(); ++i) dp[i] = p[i] - linear_p[i];
      const bool has_moved = max_abs(dp) > 0;
      const std::vector<double>& tangent = theta_tangent(dp);
      for_each_case([&](Case& c) {
        if (!has_moved) {
          c.ok = c.body->solve(parameters, c.body->linearized_x());
          return;
        }
        c.start.resize(3 * experiment.mesh.rest.size());
        c.ok = c.body->solve(parameters, c.body->predict(tangent, c.start) ? c.start : std::span<const double>());
      });
    } else if (has_solved) {
      for_each_case([&](Case& c) { c.ok = c.body->solve(parameters, {}); });
    } else {
      solve_groups(parameters);
    }
    if (!all_ok()) return false;
    put_residuals(cases, r);
    for_each_case([&](Case& c) { c.body->accept(); });
    has_solved = true;
    accepted_p.assign(p.begin(), p.end());
    accepted_parameters = parameters;
    return true;
  }

  // Orders each group by load, from the smallest.
  void solve_groups(const std::vector<MaterialParameters>& parameters) {
    std::vector<int> begin;
    for (int c = 0; c < case_count(); ++c)
      if (c == 0 || experiment.cases[c].group.empty() || experiment.cases[c].group != experiment.cases[c - 1].group)
        begin.push_back(c);
    begin.push_back(case_count());
    for_each(static_cast<int>(begin.size()) - 1, [&](int g) {
      for (int c = begin[g]; c < begin[g + 1]; ++c) {
        if (!cases[c].is_used) continue;
        const bool follows = c > begin[g] && cases[c - 1].is_used && cases[c - 1].ok;
        cases[c].ok = cases[c].body->solve(parameters, follows ? cases[c - 1].body->x() : std::span<const double>());
      }
    });
  }

  bool all_ok() { return all_ok(cases); }
  bool all_ok(const std::vector<Case>& of) {
    failure.clear();
    for (const Case& c : of)
      if (c.is_used && !c.ok) failure += (failure.empty() ? "" : "; ") + c.body->failure();
    return failure.empty();
  }

  bool linearize() {
    ASPIC_CHECK(has_solved);
    const bool is_same = is_linearized && linear_p == accepted_p;
    if (is_same && std::all_of(cases.begin(), cases.end(),
                               [](const Case& c) { return !c.is_used || has_linearized_accepted(*c.body); }))
      return true;
    is_linearized = false;
    for_each_case([&](Case& c) { c.ok = c.body->linearize(accepted_parameters); });
    if (!all_ok()) return false;
    if (is_scanned() && !linearize_shape()) return false;
    linear_p = accepted_p;
    return is_linearized = true;
  }

  void multiply(std::span<const double> direction, std::span<double> dr) {
    ASPIC_CHECK(is_linearized);
    const std::vector<double>& tangent = theta_tangent(direction);
    std::fill(dr.begin(), dr.end(), 0.0);
    for_each_case([&](Case& c) { c.ok = c.body->multiply(tangent, dr.subspan(c.first, c.body->residual_count())); });
    for (size_t k = 0; k < shape_slopes.size(); ++k) add_scaled(direction[k], shape_slopes[k], dr);
    mark_unless_ok(dr);
  }

  void multiply_transposed(std::span<const double> w, std::span<double> pbar) {
    ASPIC_CHECK(is_linearized);
    for_each_case([&](Case& c) {
      c.thetabar.assign(dtheta_of_parts.size(), 0.0);
      c.ok = c.body->add_transposed(w.subspan(c.first, c.body->residual_count()), c.thetabar);
    });
    sum_theta_adjoints();
    std::fill(pbar.begin(), pbar.end(), 0.0);
    map.add_transposed(linear_p, dtheta, pbar);
    for (size_t k = 0; k < shape_slopes.size(); ++k) pbar[k] += dot(shape_slopes[k], w);
    mark_unless_ok(pbar);
  }

  int error_count() const { return static_cast<int>(experiment.errors.size()); }
  int bounded_count() const { return error_count() + static_cast<int>(experiment.cases.front().common_errors.size()); }
  bool has_unknown_layers() const {
    return std::any_of(cases.begin(), cases.end(), [](const Case& c) { return c.body->has_unknown_layer(); });
  }

  // dr = the derivative by a systematic error, by the factor of a common one, or by the stiffness of the unknown
  // layers.
  void multiply_by_nuisance(int k, std::span<double> dr) {
    ASPIC_CHECK(is_linearized);
    std::fill(dr.begin(), dr.end(), 0.0);
    for_each_case([&](Case& c) {
      const std::span<double> part = dr.subspan(c.first, c.body->residual_count());
      if (k < error_count())
        c.ok = c.body->multiply_by_error(experiment.errors[k], part);
      else if (k < bounded_count())
        c.body->common_error(k - error_count(), part);
      else
        c.ok = !c.body->has_unknown_layer() || c.body->multiply_by_layer(part);
    });
    mark_unless_ok(dr);
  }

  // Products that cannot be computed are NaN.
  void mark_unless_ok(std::span<double> result) {
    if (!all_ok()) std::fill(result.begin(), result.end(), std::numeric_limits<double>::quiet_NaN());
  }

  const Experiment& experiment;
  const ParameterMap& map;
  EquilibriumOptions options;
  std::unique_ptr<Experiment> unloaded_experiment;  // that `cases` refers to, of a scanned mesh
  std::vector<Case> cases;
  std::vector<std::vector<double>> shape_slopes;
  int residual_count = 0;
  int per_tet = 2;                         // parameters of a tet
  std::vector<std::vector<int>> parts_of;  // simulated tets of each tet of the map
  bool has_solved = false, is_linearized = false;
  std::vector<double> accepted_p, linear_p;  // p of the last successful evaluation, and of the Jacobian
  std::vector<MaterialParameters> accepted_parameters;
  std::vector<double> dp, dtheta, dtheta_of_parts;  // scratch
  std::string failure;
};

std::vector<MaterialParameters> of_tets(const Experiment& experiment, std::span<const MaterialParameters> parameters) {
  if (experiment.parent.empty() || parameters.size() == experiment.mesh.tets.size())
    return {parameters.begin(), parameters.end()};
  std::vector<MaterialParameters> result;
  result.reserve(experiment.parent.size());
  for (const int t : experiment.parent) result.push_back(parameters[t]);
  return result;
}

Misfit::Misfit(const Experiment& experiment, const ParameterMap& map, const EquilibriumOptions& options)
    : impl_(std::make_unique<Impl>(experiment, map, options)) {}
Misfit::~Misfit() = default;

void Misfit::use_cases(const std::function<bool(const LoadCase&)>& wanted) {
  for (size_t c = 0; c < impl_->cases.size(); ++c) impl_->cases[c].is_used = wanted(impl_->experiment.cases[c]);
}

int Misfit::parameter_count() const { return impl_->map.size(); }
int Misfit::residual_count() const { return impl_->residual_count; }
int Misfit::reading_count() const {
  int count = 0;
  for (const LoadCase& load : impl_->experiment.cases) count += load.merged + measured_count(load);
  return count;
}
bool Misfit::evaluate(std::span<const double> p, std::span<double> r) { return impl_->evaluate(p, r); }
bool Misfit::linearize() { return impl_->linearize(); }
void Misfit::multiply(std::span<const double> dp, std::span<double> dr) { impl_->multiply(dp, dr); }
void Misfit::multiply_transposed(std::span<const double> w, std::span<double> pbar) {
  impl_->multiply_transposed(w, pbar);
}

int Misfit::nuisance_count() const { return impl_->bounded_count() + (impl_->has_unknown_layers() ? 1 : 0); }
void Misfit::nuisance(int k, std::span<double> dr) { impl_->multiply_by_nuisance(k, dr); }
NuisancePrior Misfit::nuisance_prior(int k) const {
  if (k == impl_->bounded_count()) return {.case_sigma = kWeakPrior};
  if (k >= impl_->error_count()) return {.sigma = 1};
  const SystematicError& error = impl_->experiment.errors[k];
  return {.sigma = error.sigma, .value = error.value};
}

std::vector<double> Misfit::state() const {
  std::vector<double> x;
  for (const Impl::Case& c : impl_->cases) x.insert(x.end(), c.body->accepted().begin(), c.body->accepted().end());
  return x;
}

void Misfit::set_state(std::span<const double> x) {
  const size_t size = 3 * impl_->experiment.mesh.rest.size();
  ASPIC_CHECK(x.size() == size * impl_->cases.size());
  for (size_t c = 0; c < impl_->cases.size(); ++c) {
    LoadedBody& body = *impl_->cases[c].body;
    body.restore(x.subspan(c * size, size));
    impl_->is_linearized = impl_->is_linearized && has_linearized_accepted(body);
  }
  impl_->has_solved = true;
}

const CasePrediction& Misfit::prediction(int c) const { return impl_->cases[c].body->prediction(); }
std::pair<int, int> Misfit::residuals_of(int c) const {
  return {impl_->cases[c].first, impl_->cases[c].body->residual_count()};
}

std::vector<std::pair<int, int>> Misfit::residuals_by_case() const {
  std::vector<std::pair<int, int>> all;
  for (int c = 0; c < impl_->case_count(); ++c) all.push_back(residuals_of(c));
  return all;
}

std::string Misfit::what(int residual) const {
  int c = impl_->case_count() - 1;
  while (impl_->cases[c].first > residual) --c;
  return impl_->cases[c].body->what(residual - impl_->cases[c].first);
}

const std::string& Misfit::failure() const { return impl_->failure; }

Misfit::Counts Misfit::counts() const {
  Counts sum;
  for (const Impl::Case& c : impl_->cases) {
    const Counts& own = c.body->counts();
    sum.equilibria += own.equilibria;
    sum.newton_iterations += own.newton_iterations;
    sum.factorizations += own.factorizations;
    sum.solves += own.solves;
  }
  return sum;
}

}  // namespace aspic
