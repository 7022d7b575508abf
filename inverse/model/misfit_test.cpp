#include "model/misfit.h"

#include <cmath>

#include "base/error.h"
#include "base/parallel.h"
#include "mesh/generators.h"
#include "mesh/surface.h"
#include "model/common_errors.h"
#include "model/refined_experiment.h"
#include "model/taylor_test.h"

namespace aspic {
namespace {

using taylor::Numbers;

const EquilibriumOptions kMisfitExact{.tolerance = 1e-14, .adjoint_tolerance = 1e-13};

// A block of gel of 8 cm on a table, indented from above at two sites and two depths, pressed from the side, and hung.
struct Gel {
  Experiment experiment;
  std::vector<Triangle> surface;

  Gel() {
    TetMesh& mesh = experiment.mesh = make_box({{0, 0, 0}}, {{0.08, 0.08, 0.05}}, {4, 4, 3});
    surface = boundary_triangles(mesh, 0, mesh.tet_count());
    experiment.density.assign(mesh.tet_count(), 1000.0);
    for (int v = 0; v < mesh.vertex_count(); ++v)
      if (mesh.rest[v][2] < 1e-9) experiment.fixed.push_back(v);
    for (const Triangle& t : surface)
      if (mesh.rest[t[0]][2] > 0.01) experiment.markers.push_back({t, {0.2, 0.3, 0.5}});
    for (const double x : {0.03, 0.05})
      for (const double depth : {0.004, 0.008}) experiment.cases.push_back(indentation(x, depth));
    experiment.cases.push_back(hung());
    experiment.cases.push_back(pressed());
    experiment.cases.push_back(pressed());
    experiment.cases.back().is_dead_pressure = true;
    experiment.cases.push_back(gripped());
  }

  static std::string text(double x) { return std::to_string(std::lround(1000 * x)) + " mm"; }

  LoadCase indentation(double x, double depth) const {
    LoadCase load{.name = "poke at " + text(x) + ", depth " + text(depth), .group = "poke at " + text(x)};
    load.indenter = Indenter{IndenterShape::sphere, IndenterContact::bonded, 0.012, 5e8};
    load.touch.center = {{x, 0.04, 0.062}};
    load.pose = load.touch;
    load.pose.center = {{x + 0.3 * depth, 0.04, 0.062 - depth}};
    load.pose.rotation = {{0, 0.1, 0}};
    load.force = load.torque = Vec3d{};
    load.force_sigma = {{0.01, 0.01, 0.02}};
    load.torque_sigma = {{1e-4, 1e-4, 1e-4}};
    add_markers(load);
    return load;
  }
  // The top is lifted, moved sideways and twisted, under gravity.
  LoadCase gripped() const {
    LoadCase load{.name = "gripped", .group = "gripped"};
    Grip grip{.center = {{0.04, 0.04, 0.05}}, .displacement = {{0.004, -0.002, 0.003}}, .rotation = {{0.05, 0, 0.2}}};
    for (int v = 0; v < experiment.mesh.vertex_count(); ++v)
      if (experiment.mesh.rest[v][2] > 0.05 - 1e-9) grip.vertices.push_back(v);
    load.grip = grip;
    load.gravity = {{0, 0, -9.81}};
    load.force = load.torque = Vec3d{};
    load.force_sigma = {{0.01, 0.01, 0.02}};
    load.torque_sigma = {{1e-4, 1e-4, 1e-4}};
    add_markers(load);
    return load;
  }
  LoadCase hung() const {
    LoadCase load{.name = "hung", .group = "hung"};
    load.gravity = {{0, 2, 9.81}};
    add_markers(load);
    return load;
  }
  LoadCase pressed() const {
    LoadCase load{.name = "pressed", .group = "pressed"};
    load.pressure = 300;
    for (const Triangle& t : surface) {
      const auto& X = experiment.mesh.rest;
      if (X[t[0]][0] + X[t[1]][0] + X[t[2]][0] < 1e-9) load.pressed.push_back(t);
    }
    add_markers(load);
    return load;
  }
  void add_markers(LoadCase& load) const {
    for (size_t m = 0; m < experiment.markers.size(); m += 7)
      load.positions.push_back({static_cast<int>(m), {}, {{1e-4, 2e-4, 1e-4}}});
  }

  // Readings of a body of this material, with noise of `noise` standard deviations.
  void measure(const ParameterMap& map, const std::vector<double>& p, double noise) {
    Misfit truth(experiment, map, kMisfitExact);
    std::vector<double> r(truth.residual_count());
    ASSERT_TRUE(truth.evaluate(p, r)) << truth.failure();
    Numbers numbers;
    const auto read = [&](const Vec3d& exact, const Vec3d& sigma) {
      const std::vector<double> e = numbers(3);
      return exact + Vec3d{{noise * e[0] * sigma[0], noise * e[1] * sigma[1], noise * e[2] * sigma[2]}};
    };
    for (size_t c = 0; c < experiment.cases.size(); ++c) {
      LoadCase& load = experiment.cases[c];
      const CasePrediction& exact = truth.prediction(static_cast<int>(c));
      for (size_t k = 0; k < load.positions.size(); ++k)
        load.positions[k].position = read(exact.markers[k], load.positions[k].sigma);
      if (load.force) load.force = read(exact.wrench.force, load.force_sigma);
      if (load.torque) load.torque = read(exact.wrench.torque, load.torque_sigma);
    }
  }

  ParameterMap map(const std::string& material = "fung", int handles = 6) const {
    const MaterialInfo& info = material_info(material);
    MaterialParameters known{lame_from_young_poisson(2e4, 0.4), {}};
    for (size_t k = 0; k < info.extra.size(); ++k) known.extra[k] = info.extra[k].fallback;
    std::vector<FitParameter> parameters = {{"young", Parameterization::handles, handles, 2e4},
                                            {"poisson", Parameterization::uniform, 0, 0.42}};
    for (const ExtraParameter& extra : info.extra)
      parameters.push_back({extra.name, Parameterization::uniform, 0, extra.fallback});
    return {experiment.mesh, material, std::vector<MaterialParameters>(experiment.mesh.tet_count(), known), parameters};
  }
};

std::vector<double> stepped(std::span<const double> p, const std::vector<double>& dp, double eps) {
  std::vector<double> result(p.begin(), p.end());
  for (size_t i = 0; i < result.size(); ++i) result[i] += eps * dp[i];
  return result;
}

TEST(Misfit, IsZeroOnlyForTheMeasuredMaterial) {
  Gel gel;
  const ParameterMap map = gel.map();
  const std::vector<double> truth = stepped(map.guess(), Numbers(3)(map.size()), 0.5);
  gel.measure(map, truth, 0);
  Misfit misfit(gel.experiment, map, kMisfitExact);
  std::vector<double> r(misfit.residual_count());
  ASSERT_TRUE(misfit.evaluate(map.guess(), r)) << misfit.failure();
  EXPECT_GT(norm(r), 10);
  ASSERT_TRUE(misfit.evaluate(truth, r)) << misfit.failure();
  EXPECT_LT(norm(r), 1e-7);
}

TEST(Misfit, JacobianHasTaylorSlope2) {
  for (const std::string material : {"fung", "mooney_rivlin", "stable_neo_hookean"}) {
    Gel gel;
    const ParameterMap map = gel.map(material);
    gel.measure(map, std::vector<double>(map.guess().begin(), map.guess().end()), 1);
    Misfit misfit(gel.experiment, map, kMisfitExact);
    const std::vector<double> p = stepped(map.guess(), Numbers(4)(map.size()), 0.3);
    std::vector<double> r(misfit.residual_count()), dr(r.size());
    ASSERT_TRUE(misfit.evaluate(p, r)) << misfit.failure();
    ASSERT_TRUE(misfit.linearize()) << misfit.failure();
    const std::vector<double> dp = Numbers(6)(map.size());
    misfit.multiply(dp, dr);
    taylor::expect_slope_2(
        [&](double eps) {
          std::vector<double> at(r.size());
          EXPECT_TRUE(misfit.evaluate(stepped(p, dp, eps), at)) << misfit.failure();
          return at;
        },
        dr, 0.1, material);
  }
}

// The top is held where nothing else loads the block, so only reactions balance the elastic forces.
TEST(Misfit, GripsConvergeRelativeToReactions) {
  Gel gel;
  std::erase_if(gel.experiment.cases, [](const LoadCase& c) { return !c.grip; });
  gel.experiment.cases[0].gravity = {};
  const ParameterMap map = gel.map("neo_hookean");
  Misfit misfit(gel.experiment, map);
  std::vector<double> r(misfit.residual_count());
  ASSERT_TRUE(misfit.evaluate(map.guess(), r)) << misfit.failure();
  const MinimizeReport& solve = misfit.prediction(0).solve;
  EXPECT_EQ(solve.status, Status::converged);
  EXPECT_GT(solve.threshold, 1e-10 * norm(misfit.prediction(0).wrench.force));
  const long before = misfit.counts().newton_iterations;
  ASSERT_TRUE(misfit.evaluate(map.guess(), r));
  EXPECT_EQ(misfit.counts().newton_iterations, before) << "an equilibrium is solved again";
}

TEST(Misfit, LinearizesOncePerPoint) {
  Gel gel;
  const ParameterMap map = gel.map();
  Misfit misfit(gel.experiment, map);
  std::vector<double> r(misfit.residual_count());
  const auto factorizations_at = [&](std::span<const double> p) {
    EXPECT_TRUE(misfit.evaluate(p, r)) << misfit.failure();
    const long before = misfit.counts().factorizations;
    EXPECT_TRUE(misfit.linearize());
    return misfit.counts().factorizations - before;
  };
  const std::vector<double> other = stepped(map.guess(), Numbers(3)(map.size()), 0.1);
  EXPECT_GT(factorizations_at(map.guess()), 0);
  EXPECT_EQ(factorizations_at(map.guess()), 0);
  EXPECT_GT(factorizations_at(other), 0);
  EXPECT_GT(factorizations_at(map.guess()), 0);
}

TEST(Misfit, UnusedCasesHaveNoResiduals) {
  Gel gel;
  const ParameterMap map = gel.map();
  Misfit all(gel.experiment, map, kMisfitExact), some(gel.experiment, map, kMisfitExact);
  some.use_cases([](const LoadCase& c) { return c.group == "hung" || c.group == "gripped"; });
  std::vector<double> r(all.residual_count()), of_some(r.size()), w = Numbers(7)(r.size()), masked(r.size());
  ASSERT_TRUE(all.evaluate(map.guess(), r) && some.evaluate(map.guess(), of_some));
  ASSERT_TRUE(all.linearize() && some.linearize());
  const std::vector<double> dp = Numbers(6)(map.size());
  std::vector<double> dr(r.size()), dr_of_some(r.size()), pbar(map.size()), pbar_of_some(map.size());
  all.multiply(dp, dr), some.multiply(dp, dr_of_some);
  for (size_t c = 0; c < gel.experiment.cases.size(); ++c) {
    const auto [first, count] = all.residuals_of(static_cast<int>(c));
    const std::string& group = gel.experiment.cases[c].group;
    const bool is_used = group == "hung" || group == "gripped";
    for (int i = first; i < first + count; ++i) {
      masked[i] = is_used ? w[i] : 0;
      EXPECT_NEAR(of_some[i], is_used ? r[i] : 0, 1e-6 * norm(r));
      EXPECT_NEAR(dr_of_some[i], is_used ? dr[i] : 0, 1e-6 * norm(dr));
    }
  }
  all.multiply_transposed(masked, pbar), some.multiply_transposed(w, pbar_of_some);
  for (int k = 0; k < map.size(); ++k) EXPECT_NEAR(pbar_of_some[k], pbar[k], 1e-6 * norm(pbar));
}

// The direction of the fibres and its two tilts.
ParameterMap map_of_fibres(const TetMesh& mesh) {
  const MaterialParameters known{lame_from_young_poisson(2e4, 0.4), {4, 2, 0.5, 0.3, 0.8}};
  return {mesh,
          "neo_hookean_fibres",
          std::vector<MaterialParameters>(mesh.tet_count(), known),
          {{"young", Parameterization::uniform, 0, 2e4},
           {"fibre_tilt_1", Parameterization::uniform, 0, 0},
           {"fibre_ratio", Parameterization::uniform, 0, 4},
           {"fibre_tilt_2", Parameterization::uniform, 0, 0}}};
}

TEST(Misfit, DerivativesByFibreDirectionMatchDifferences) {
  Gel gel;
  const ParameterMap map = map_of_fibres(gel.experiment.mesh);
  gel.measure(map, std::vector<double>(map.guess().begin(), map.guess().end()), 1);
  Misfit misfit(gel.experiment, map, kMisfitExact);
  const std::vector<double> p = stepped(map.guess(), Numbers(4)(map.size()), 0.3);
  std::vector<double> r(misfit.residual_count()), dr(r.size()), plus(r.size()), minus(r.size()), pbar(map.size());
  ASSERT_TRUE(misfit.evaluate(p, r)) << misfit.failure();
  ASSERT_TRUE(misfit.linearize()) << misfit.failure();
  std::vector<std::vector<double>> jacobian;
  for (int i = 0; i < map.size(); ++i) {
    std::vector<double> unit(map.size());
    unit[i] = 1;
    misfit.multiply(unit, dr);
    jacobian.push_back(dr);
  }
  const std::vector<double> w = Numbers(7)(r.size());
  misfit.multiply_transposed(w, pbar);
  for (int i = 0; i < map.size(); ++i) {
    EXPECT_NEAR(pbar[i], dot(w, jacobian[i]), 1e-7 * norm(jacobian[i]) * norm(w)) << i;
    constexpr double kStep = 1e-4;
    std::vector<double> unit(map.size());
    unit[i] = 1;
    ASSERT_TRUE(misfit.evaluate(stepped(p, unit, kStep), plus) && misfit.evaluate(stepped(p, unit, -kStep), minus));
    double error = 0;
    for (size_t k = 0; k < r.size(); ++k)
      error = std::hypot(error, (plus[k] - minus[k]) / (2 * kStep) - jacobian[i][k]);
    EXPECT_GT(norm(jacobian[i]), 0.1) << i;
    EXPECT_LT(error, 1e-5 * norm(jacobian[i])) << i;
  }
}

TEST(Misfit, TransposedProductIsTransposeAfterOtherTrials) {
  Gel gel;
  const ParameterMap map = gel.map();
  gel.measure(map, std::vector<double>(map.guess().begin(), map.guess().end()), 1);
  Misfit misfit(gel.experiment, map, kMisfitExact);
  std::vector<double> r(misfit.residual_count()), dr(r.size()), again(r.size()), pbar(map.size());
  ASSERT_TRUE(misfit.evaluate(map.guess(), r));
  ASSERT_TRUE(misfit.linearize());
  const std::vector<double> dp = Numbers(6)(map.size()), w = Numbers(7)(r.size());
  misfit.multiply(dp, dr);
  ASSERT_TRUE(misfit.evaluate(stepped(map.guess(), dp, 0.4), again));
  misfit.multiply(dp, again);
  EXPECT_EQ(dr, again);
  misfit.multiply_transposed(w, pbar);
  EXPECT_NEAR(dot(w, dr), dot(pbar, dp), 1e-10 * norm(w) * norm(dr));
}

TEST(Misfit, IsBitReproducibleForAnyThreads) {
  const int before = thread_count();
  std::vector<std::vector<double>> results;
  for (const int threads : {1, 2, 8}) {
    set_thread_count(threads);
    Gel gel;
    const ParameterMap map = gel.map();
    Misfit misfit(gel.experiment, map);
    std::vector<double> r(misfit.residual_count()), pbar(map.size());
    ASSERT_TRUE(misfit.evaluate(map.guess(), r));
    ASSERT_TRUE(misfit.linearize());
    misfit.multiply_transposed(r, pbar);
    ASSERT_TRUE(misfit.evaluate(stepped(map.guess(), Numbers(6)(map.size()), 0.2), r));
    r.insert(r.end(), pbar.begin(), pbar.end());
    results.push_back(r);
  }
  set_thread_count(before);
  EXPECT_EQ(results[0], results[1]);
  EXPECT_EQ(results[0], results[2]);
}

TEST(Misfit, TangentStartNeedsFewIterationsForSmallSteps) {
  Gel gel;
  const ParameterMap map = gel.map();
  Misfit misfit(gel.experiment, map);
  std::vector<double> r(misfit.residual_count());
  ASSERT_TRUE(misfit.evaluate(map.guess(), r));
  ASSERT_TRUE(misfit.linearize());
  const Misfit::Counts before = misfit.counts();
  ASSERT_TRUE(misfit.evaluate(stepped(map.guess(), Numbers(6)(map.size()), 0.01), r));
  const Misfit::Counts after = misfit.counts();
  const long cases = static_cast<long>(gel.experiment.cases.size());
  EXPECT_EQ(after.equilibria - before.equilibria, cases);
  EXPECT_LE(after.newton_iterations - before.newton_iterations,
            3 * cases);  // the tangent leaves 1e-4 of the step, then 1e-8
}

TEST(Misfit, LoadTooLargeForOneSolveIsStepped) {
  Gel gel;
  gel.experiment.cases = {gel.indentation(0.03, 0.02)};  // 40 % of the height
  const ParameterMap map = gel.map();
  std::vector<double> r, in_parts;
  const auto iterations_of = [&](const EquilibriumOptions& options, std::vector<double>& into, long equilibria) {
    Misfit misfit(gel.experiment, map, options);
    into.resize(misfit.residual_count());
    ASSERT_TRUE(misfit.evaluate(map.guess(), into)) << misfit.failure();
    EXPECT_GE(misfit.counts().equilibria, equilibria);
  };
  iterations_of({}, r, 1);
  iterations_of({.max_iterations = 5}, in_parts, 4);
  for (size_t i = 0; i < r.size(); ++i) EXPECT_NEAR(r[i], in_parts[i], 1e-5 * norm(r));
}

TEST(Misfit, FailureNamesTheCaseAndChangesNothing) {
  Gel gel;
  const ParameterMap map = gel.map();
  Misfit misfit(gel.experiment, map);
  std::vector<double> r(misfit.residual_count()), again(r.size());
  ASSERT_TRUE(misfit.evaluate(map.guess(), r));
  std::vector<double> wrong(map.guess().begin(), map.guess().end());
  wrong[0] = std::nan("");
  EXPECT_FALSE(misfit.evaluate(wrong, again));
  EXPECT_NE(misfit.failure().find("poke at 30 mm, depth 4 mm"), std::string::npos) << misfit.failure();
  ASSERT_TRUE(misfit.linearize()) << misfit.failure();  // where it succeeded
  ASSERT_TRUE(misfit.evaluate(map.guess(), again)) << misfit.failure();
  for (size_t i = 0; i < r.size(); ++i) EXPECT_NEAR(r[i], again[i], 1e-6 * norm(r));
}

// Eight tets of the simulation have the material of one tet of the map.
TEST(Misfit, OnRefinedMeshHasDerivativesPerMapTet) {
  Gel gel;
  gel.experiment.cases.resize(1);
  const ParameterMap map = gel.map();
  const Experiment fine = refined(gel.experiment);
  Misfit misfit(fine, map, kMisfitExact);
  const std::vector<double> p(map.guess().begin(), map.guess().end()), dp = Numbers(7)(map.size()),
                                                                       w = Numbers(8)(misfit.residual_count());
  std::vector<double> r(w.size()), above = r, below = r, dr = r, back(p.size());
  ASSERT_TRUE(misfit.evaluate(p, r) && misfit.linearize()) << misfit.failure();
  misfit.multiply(dp, dr);
  misfit.multiply_transposed(w, back);
  EXPECT_NEAR(dot(w, dr), dot(back, dp), 1e-8 * norm(w) * norm(dr));
  const double h = 1e-4;
  ASSERT_TRUE(misfit.evaluate(stepped(p, dp, h), above) && misfit.evaluate(stepped(p, dp, -h), below))
      << misfit.failure();
  for (size_t i = 0; i < r.size(); ++i) EXPECT_NEAR((above[i] - below[i]) / (2 * h), dr[i], 1e-5 * norm(dr));
}

TEST(Misfit, CommonErrorSpansAllCasesAndIsWhitened) {
  Gel gel;
  gel.experiment.cases = {gel.hung(), gel.gripped()};
  const ParameterMap map = gel.map();
  gel.measure(map, std::vector<double>(map.guess().begin(), map.guess().end()), 1);
  for (LoadCase& load : gel.experiment.cases)
    load.common_errors = {
        {.cause = "", .markers = std::vector<Vec3d>(load.positions.size(), {{1e-4, 0, -2e-4}}), .wrench = {}}};
  gel.experiment.cases[1].common_errors[0].wrench.force = {{0, 0, 0.05}};
  Misfit misfit(gel.experiment, map);
  WithUncertainLayers whitened(misfit);
  std::vector<double> r(misfit.residual_count()), Lr = r, n = r;
  ASSERT_TRUE(misfit.evaluate(map.guess(), r) && whitened.evaluate(map.guess(), Lr));
  ASSERT_EQ(misfit.nuisance_count(), 1);
  ASSERT_TRUE(misfit.linearize());
  misfit.nuisance(0, n);
  EXPECT_EQ(n[0], 1);   // 1e-4 of 1e-4
  EXPECT_EQ(n[2], -2);  // 2e-4 of 1e-4
  EXPECT_EQ(n[n.size() - 4], 2.5);
  const double squares = dot(n, n);
  EXPECT_NEAR(dot(n, Lr), dot(n, r) / std::sqrt(1 + squares), 1e-6 * norm(n) * norm(r));
  for (size_t i = 0; i < r.size(); ++i)  // other directions remain
    EXPECT_NEAR(Lr[i] - dot(n, Lr) / squares * n[i], r[i] - dot(n, r) / squares * n[i], 1e-6 * norm(r));
}

TEST(Misfit, GaugeMeasuresOneComponentOfTheForce) {
  Gel gel;
  const ParameterMap map = gel.map();
  LoadCase& load = *std::find_if(gel.experiment.cases.begin(), gel.experiment.cases.end(),
                                 [](const LoadCase& c) { return c.force.has_value(); });
  load.gauge = Vec3d{{0.6, 0, 0.8}};
  load.force_sigma = {{0.02, 0.02, 0.02}};
  const auto residuals = [&](const Vec3d& change) {
    Experiment changed = gel.experiment;
    LoadCase& c = changed.cases[static_cast<size_t>(&load - gel.experiment.cases.data())];
    c.force = *c.force + change;
    Misfit misfit(changed, map, kMisfitExact);
    std::vector<double> r(misfit.residual_count());
    EXPECT_TRUE(misfit.evaluate(map.guess(), r)) << misfit.failure();
    EXPECT_EQ(misfit.reading_count(), misfit.residual_count() - 2);
    return r;
  };
  const std::vector<double> r = residuals({});
  EXPECT_EQ(r, residuals({{0.8, 5, -0.6}}));
  std::vector<double> along = residuals({{0.06, 0, 0.08}});
  for (size_t i = 0; i < r.size(); ++i) along[i] -= r[i];
  EXPECT_NEAR(*std::min_element(along.begin(), along.end()), -5, 1e-9);
  EXPECT_NEAR(norm(along), 5, 1e-9);

  Misfit misfit(gel.experiment, map, kMisfitExact);
  std::vector<double> at(r.size()), dr(r.size()), pbar(map.size());
  ASSERT_TRUE(misfit.evaluate(map.guess(), at) && misfit.linearize());
  const std::vector<double> dp = Numbers(6)(map.size()), w = Numbers(7)(r.size());
  misfit.multiply(dp, dr);
  misfit.multiply_transposed(w, pbar);
  EXPECT_NEAR(dot(w, dr), dot(pbar, dp), 1e-10 * norm(w) * norm(dr));
}

TEST(Misfit, NamesEachResidual) {
  Gel gel;
  const ParameterMap map = gel.map();
  const Misfit misfit(gel.experiment, map);
  const auto [first, count] = misfit.residuals_of(1);
  EXPECT_EQ(misfit.what(first + 1), "poke at 30 mm, depth 8 mm: marker 0, y");
  EXPECT_EQ(misfit.what(first + 5), "poke at 30 mm, depth 8 mm: marker 7, z");
  EXPECT_EQ(misfit.what(first + count - 6), "poke at 30 mm, depth 8 mm: force, x");
  EXPECT_EQ(misfit.what(first + count - 1), "poke at 30 mm, depth 8 mm: torque, z");
}

TEST(Misfit, RefusesCasesThatCannotBeRead) {
  const auto refused = [](const std::function<void(Gel&)>& spoil, const std::string& expected) {
    Gel gel;
    spoil(gel);
    const ParameterMap map = gel.map();
    try {
      const Misfit misfit(gel.experiment, map);
      FAIL() << expected;
    } catch (const InvalidInput& e) {
      EXPECT_NE(std::string(e.what()).find(expected), std::string::npos) << e.what();
    }
  };
  refused([](Gel& gel) { gel.experiment.cases.clear(); }, "no load case");
  refused([](Gel& gel) { gel.experiment.cases[4].positions.clear(); }, "hung: no measurements");
  refused([](Gel& gel) { gel.experiment.cases[4].force = Vec3d{}; }, "hung: a force or torque needs an indenter");
  refused([](Gel& gel) { gel.experiment.cases[0].positions[2].marker = 1000; }, "marker 1000 is unknown");
  refused([](Gel& gel) { gel.experiment.cases[0].positions[2].sigma[1] = 0; }, "deviation along y is 0");
  refused([](Gel& gel) { gel.experiment.cases[1].force_sigma[0] = std::nan(""); }, "force");
}

}  // namespace
}  // namespace aspic
