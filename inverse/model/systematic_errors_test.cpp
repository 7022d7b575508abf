#include "model/systematic_errors.h"

#include <gtest/gtest.h>

#include <cmath>

#include "estimate/cross_validation.h"
#include "math/vectors.h"
#include "model/common_errors.h"
#include "model/gauge.h"
#include "model/indented_block_test.h"

namespace aspic {
namespace {

using test::IndentedBlock;

constexpr ErrorSigmas kSigmas = {2e-4, 0.02, 1e-4, 0, 0.01, 0.03, 0.02};
const EquilibriumOptions kExactErrors{.tolerance = 1e-14, .adjoint_tolerance = 1e-13};

// Indenters and a grip on a block, with readings of force and torque.
struct Disturbed {
  IndentedBlock block;
  ParameterMap map = block.map({{.parameterization = Parameterization::uniform, .guess = IndentedBlock::kYoung}});

  explicit Disturbed(double friction, bool has_grip = true) {
    for (const auto& site : IndentedBlock::sites()) block.add_indentation(site, 0.006, 1e-2);
    std::vector<LoadCase>& cases = block.experiment.cases;
    cases[0].pose.rotation = {{0.1, -0.05, 0.2}};
    cases[0].torque = Vec3d{}, cases[0].torque_sigma = {{1e-4, 2e-4, 1e-4}};
    for (int c = 1; c < 3; ++c) cases[c].indenter->contact = IndenterContact::sliding, cases[c].tip = "sliding";
    for (int c = 1; c < 3; ++c) cases[c].indenter->stiffness /= 20, cases[c].layer_sigma = 0.3;
    for (int c = 1; c < 3; ++c)
      cases[c].indenter->friction = friction, cases[c].friction_sigma = friction > 0 ? 0.5 : 0;
    cases[1].indenter->rim = 0.002, cases[1].rim_sigma = friction > 0 ? 0 : 0.5;
    cases[1].pose.axis = {{0.1, 0.05, -1}};
    cases[2].indenter->shape = IndenterShape::sphere;
    cases[2].touch.center[0] -= 0.012, cases[2].pose.center[0] -= 0.012;
    cases[3].gauge = cases[3].pose.axis;
    cases[3].session = "second";
    if (has_grip) cases.push_back(gripped());
    block.experiment.errors = systematic_errors(cases, kSigmas);
  }

  LoadCase gripped() const {
    LoadCase load{.name = "grip", .group = "grip", .positions = block.experiment.cases[0].positions};
    Grip grip{.center = {{0.03, 0.03, 0.04}}, .displacement = {{0.002, -0.001, 0.003}}, .rotation = {{0.05, 0, 0.1}}};
    for (int v = 0; v < block.experiment.mesh.vertex_count(); ++v)
      if (block.experiment.mesh.rest[v][2] > 0.04 - 1e-9) grip.vertices.push_back(v);
    load.grip = grip;
    load.force = load.torque = Vec3d{};
    load.force_sigma = {{0.01, 0.01, 0.02}}, load.torque_sigma = {{1e-4, 1e-4, 1e-4}};
    return load;
  }

  // Residuals of the cases that an error concerns, from the equilibria of a misfit of all cases.
  std::vector<double> residuals(const std::vector<double>& values, const SystematicError& error,
                                const Misfit& all) const {
    const auto is_concerned = [&](const LoadCase& load) { return concerns(error, load); };
    const Corrected actual = subset(without_errors({block.experiment}, values), is_concerned);
    Misfit misfit(actual, map, kExactErrors);
    misfit.set_state(subset(block.experiment, all.state(), is_concerned));
    std::vector<double> r(static_cast<size_t>(misfit.residual_count()));
    EXPECT_TRUE(misfit.evaluate(map.guess(), r)) << misfit.failure();
    return r;
  }
  // Different multiples of the standard deviations.
  std::vector<double> values(double factor) const {
    std::vector<double> values;
    for (size_t k = 0; k < block.experiment.errors.size(); ++k)
      values.push_back(factor * block.experiment.errors[k].sigma * std::sin(1.0 + static_cast<double>(k)));
    return values;
  }
};

TEST(SystematicErrors, AreListedOncePerGroupSessionAndTip) {
  const Disturbed body(0.4);
  int count[kErrorKinds] = {};
  for (const SystematicError& e : body.block.experiment.errors) ++count[static_cast<int>(e.kind)];
  EXPECT_EQ(count[static_cast<int>(ErrorKind::position)], 3 * 5);
  EXPECT_EQ(count[static_cast<int>(ErrorKind::rotation)], 3 * 5);
  EXPECT_EQ(count[static_cast<int>(ErrorKind::backlash)], 2);
  EXPECT_EQ(count[static_cast<int>(ErrorKind::layer)], 1);
  EXPECT_EQ(count[static_cast<int>(ErrorKind::friction)], 1);
  EXPECT_EQ(count[static_cast<int>(ErrorKind::rim)], 0) << "all are known";
  EXPECT_EQ(count[static_cast<int>(ErrorKind::tare)], 3 + 1) << "a gauge has one axis";
  EXPECT_EQ(count[static_cast<int>(ErrorKind::force_scale)], 2);
  EXPECT_EQ(count[static_cast<int>(ErrorKind::length_scale)], 2);
}

// The forces of points that begin to slip have kinks in their second derivative.
void expect_derivatives(double friction) {
  const double tolerance = friction > 0 ? 1e-4 : 2e-5;
  const Disturbed body(friction);
  const std::vector<double> values = body.values(0.5);
  const Corrected actual = without_errors({body.block.experiment}, values);
  Misfit misfit(actual, body.map, kExactErrors);
  std::vector<double> r(static_cast<size_t>(misfit.residual_count())), dr = r;
  ASSERT_TRUE(misfit.evaluate(body.map.guess(), r) && misfit.linearize()) << misfit.failure();
  for (size_t k = 0; k < values.size(); ++k) {
    const SystematicError& error = actual.errors[k];
    std::vector<double> more = values, less = values;
    const double h = 2e-3 * error.sigma;
    more[k] += h, less[k] -= h;
    const std::vector<double> above = body.residuals(more, error, misfit), below = body.residuals(less, error, misfit);
    misfit.nuisance(static_cast<int>(k), dr);
    double difference = 0, size = 0;
    size_t next = 0;
    for (size_t c = 0; c < actual.cases.size(); ++c) {
      const auto [first, count] = misfit.residuals_of(static_cast<int>(c));
      for (int i = first; i < first + count; ++i) {
        double slope = 0;
        if (concerns(error, actual.cases[c])) slope = (above[next] - below[next]) / (2 * h), ++next;
        difference = std::max(difference, std::abs(slope - dr[i])), size = std::max(size, std::abs(slope));
      }
    }
    ASSERT_EQ(next, above.size());
    // A sphere without friction has no rotation.
    const bool is_void = friction == 0 && error.kind == ErrorKind::rotation && error.scope == "side";
    EXPECT_LT(difference, tolerance * size + 1e-6 / error.sigma) << name_of(error);
    EXPECT_EQ(size > 1e-3 / error.sigma, !is_void) << name_of(error) << " " << size;
  }
}

TEST(SystematicErrors, DerivativesMatchDifferences) { expect_derivatives(0); }
TEST(SystematicErrors, DerivativesWithFrictionMatchDifferences) { expect_derivatives(0.4); }

TEST(SystematicErrors, ReadingsInvertTheirCorrection) {
  const Disturbed body(0.4);
  const Corrected actual = without_errors({body.block.experiment}, body.values(1));
  Misfit misfit(actual, body.map, kExactErrors);
  std::vector<double> r(static_cast<size_t>(misfit.residual_count()));
  ASSERT_TRUE(misfit.evaluate(body.map.guess(), r));
  size_t i = 0;
  for (size_t c = 0; c < actual.cases.size(); ++c) {
    const LoadCase& raw = body.block.experiment.cases[c];
    const CasePrediction shown = as_read(actual, actual.cases[c], misfit.prediction(static_cast<int>(c)));
    for (size_t k = 0; k < raw.positions.size(); ++k)
      for (int a = 0; a < 3; ++a, ++i)
        ASSERT_NEAR(r[i], (shown.markers[k] - raw.positions[k].position)[a] / raw.positions[k].sigma[a], 1e-9);
    const Vec3d error = to_gauge(raw.gauge, shown.wrench.force - *raw.force),
                sigma = gauge_sigma(raw.gauge, raw.force_sigma);
    for (int a = 0; a < 3; ++a, ++i) ASSERT_NEAR(r[i], error[a] / sigma[a], 1e-9);
    for (int a = 0; a < 3 && raw.torque; ++a, ++i)
      ASSERT_NEAR(r[i], (shown.wrench.torque - *raw.torque)[a] / raw.torque_sigma[a], 1e-9);
  }
}

}  // namespace
}  // namespace aspic
