#include "model/unloaded_shape.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "math/vectors.h"
#include "mesh/tet_nodes.h"
#include "mesh/vertices.h"
#include "model/indented_block_test.h"

namespace aspic {
namespace {

const EquilibriumOptions kExactShape{.tolerance = 1e-13, .adjoint_tolerance = 1e-13};

// A soft block that was scanned while it hung from its fixed side, and then turned.
struct Scanned {
  test::IndentedBlock block;
  ParameterMap map;

  explicit Scanned(int order)
      : map((raise(block.experiment, order), block.map({{"young", Parameterization::uniform, 0, 3e3},
                                                        {"poisson", Parameterization::uniform, 0, 0.42}}))) {
    Experiment& e = block.experiment;
    e.scan_gravity = Vec3d{{3, 0, 9}};
    for (const Vec3d& gravity : {Vec3d{{0, 0, -9.81}}, Vec3d{{9.81, 0, 0}}}) {
      LoadCase load{.name = "turned", .group = "turned", .gravity = gravity};
      for (size_t m = 0; m < e.markers.size(); m += 5)
        load.positions.push_back({static_cast<int>(m), at_rest(e, e.markers[m]), {{1e-4, 1e-4, 1e-4}}});
      e.cases.push_back(load);
    }
  }
  static void raise(Experiment& e, int order) {
    if (order == 1) return;
    e.mesh = raise_order(std::move(e.mesh));
    e.fixed.clear();
    for (int v = 0; v < e.mesh.vertex_count(); ++v)
      if (e.mesh.rest[v][2] < 1e-9) e.fixed.push_back(v);
  }
};

class UnloadedShapes : public testing::TestWithParam<int> {};

TEST_P(UnloadedShapes, SagIntoTheScan) {
  const Scanned body(GetParam());
  Experiment scanned = body.block.experiment;
  const std::vector<MaterialParameters> parameters = body.map.parameters(body.map.guess());
  const UnloadedShape shape = unloaded(scanned, body.map.material(), parameters, kExactShape);
  ASSERT_TRUE(shape.experiment) << shape.failure;
  Experiment loaded = *shape.experiment;
  EXPECT_FALSE(loaded.scan_gravity);
  loaded.cases.resize(1);
  loaded.cases[0].gravity = *scanned.scan_gravity;
  Misfit misfit(loaded, body.map, kExactShape);
  std::vector<double> r(static_cast<size_t>(misfit.residual_count()));
  ASSERT_TRUE(misfit.evaluate(body.map.guess(), r)) << misfit.failure();
  double sag = 0, distance = 0;
  for (const Tet& tet : scanned.mesh.tets)
    for (const int v : tet) {
      sag = std::max(sag, norm(loaded.mesh.rest[v] - scanned.mesh.rest[v]));
      distance = std::max(distance, norm(point(misfit.prediction(0).x, v) - scanned.mesh.rest[v]));
    }
  EXPECT_GT(sag, 1e-3);
  EXPECT_LT(distance, 1e-8 * sag);
}

TEST_P(UnloadedShapes, JacobianMatchesDifferencesOfTheWholeMap) {
  const Scanned body(GetParam());
  Misfit misfit(body.block.experiment, body.map, kExactShape);
  std::vector<double> p(body.map.guess().begin(), body.map.guess().end());
  const size_t count = static_cast<size_t>(misfit.residual_count());
  std::vector<double> r(count), ahead(count), back(count), dr(count), pbar(p.size());
  for (size_t k = 0; k < p.size(); ++k) {
    constexpr double kStep = 3e-3;
    const double at = p[k];
    p[k] = at + kStep;
    ASSERT_TRUE(misfit.evaluate(p, ahead)) << misfit.failure();
    p[k] = at - kStep;
    ASSERT_TRUE(misfit.evaluate(p, back));
    p[k] = at;
    ASSERT_TRUE(misfit.evaluate(p, r) && misfit.linearize()) << misfit.failure();
    std::vector<double> unit(p.size(), 0.0);
    unit[k] = 1;
    misfit.multiply(unit, dr);
    double difference = 0;
    for (size_t i = 0; i < count; ++i)
      difference = std::max(difference, std::abs(dr[i] - (ahead[i] - back[i]) / (2 * kStep)));
    EXPECT_LT(difference, 1e-4 * max_abs(dr));
    misfit.multiply_transposed(r, pbar);
    EXPECT_NEAR(pbar[k], dot(dr, r), 1e-9 * std::abs(pbar[k]));
  }
}

INSTANTIATE_TEST_SUITE_P(Orders, UnloadedShapes, testing::Values(1, 2));

TEST(UnloadedShape, RefusesFieldsOfManyValues) {
  Scanned body(1);
  const ParameterMap field = body.block.map();
  EXPECT_THROW(Misfit(body.block.experiment, field), InvalidInput);
}

TEST(UnloadedShape, ReportsBodiesThatAreTooSoft) {
  const Scanned body(1);
  const std::vector<MaterialParameters> soft(body.block.experiment.mesh.tets.size(),
                                             {lame_from_young_poisson(10, 0.45), {}});
  const UnloadedShape shape = unloaded(body.block.experiment, body.map.material(), soft, {});
  EXPECT_FALSE(shape.experiment);
  EXPECT_NE(shape.failure.find("no unloaded shape"), std::string::npos) << shape.failure;
}

}  // namespace
}  // namespace aspic
