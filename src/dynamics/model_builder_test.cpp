#include "dynamics/model_builder.h"

#include <gmock/gmock.h>

#include <cmath>

#include "base/error.h"
#include "dynamics/simulation.h"
#include "mesh/generators.h"

namespace aspic {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

ModelBuilder cube() { return ModelBuilder(make_box({{0, 0, 0}}, {{1, 1, 1}}, {2, 2, 2}), "cube"); }
ModelBuilder solid_cube() {
  ModelBuilder builder = cube();
  builder.material("neo_hookean", {.young = 1e4, .poisson = 0.4}).density(1000);
  return builder;
}

template <class Action>
std::string refusal(const Action& action) {
  try {
    action();
  } catch (const InvalidInput& e) {
    return e.what();
  }
  return "accepted";
}

TEST(ModelBuilder, KeepsOrderOfPinsAndLoads) {
  const Model model = solid_cube()
                          .pin("floor", [](const Vec3d& X) { return X[1] == 0; })
                          .springs(
                              "hands", [](const Vec3d& X) { return X[1] == 1; }, 10)
                          .pin("corner", {26}, {}, {{{0, 1, 0}}})
                          .gravity({{0, -9.81, 0}})
                          .rayleigh_damping(1, 1e-3)
                          .strain_rate_damping(5)
                          .build();
  ASSERT_EQ(model.pins.size(), 2u);
  EXPECT_EQ(model.pins[0].vertices.size(), 9u);
  EXPECT_THAT(model.pins[1].vertices, ElementsAre(26));
  EXPECT_EQ(model.pins[1].directions.size(), 1u);
  ASSERT_EQ(model.loads.size(), 2u);
  EXPECT_EQ(model.loads[0]->name(), "gravity");
  EXPECT_EQ(model.loads[1]->name(), "hands");
  EXPECT_EQ(model.damping.size(), 2u);
  EXPECT_EQ(model.bodies.at(0).name, "cube");
  EXPECT_NEAR(model.mass->total(), 1000, 1e-9);
}

TEST(ModelBuilder, BuildsFallingBody) {
  Simulation simulation(solid_cube().gravity({{0, -10, 0}}).build());
  EXPECT_TRUE(is_success(simulation.step().status));
  EXPECT_NEAR(simulation.state().qdot[1], -0.1, 1e-9);
}

TEST(ModelBuilder, SpringsFollowMotion) {
  const auto lifted = [](const Vec3d& X, double t) { return X + Vec3d{{0, t, 0}}; };
  Simulation simulation(solid_cube()
                            .springs(
                                "lift", [](const Vec3d&) { return true; }, 1e9, lifted)
                            .build());
  simulation.step();
  EXPECT_NEAR(simulation.state().q[1], 0.01, 1e-5);  // relative lag m / (h^2 k) = 4e-4
}

TEST(ModelBuilder, RejectsImpossibleValues) {
  EXPECT_THAT(refusal([] { cube().pin("top", [](const Vec3d& X) { return X[1] > 2; }); }),
              AllOf(HasSubstr("pin 'top' selects no vertex"), HasSubstr("from (0, 0, 0) to (1, 1, 1) m")));
  EXPECT_THAT(refusal([] {
                cube().springs(
                    "s", [](const Vec3d&) { return false; }, 1);
              }),
              HasSubstr("springs 's'"));
  EXPECT_THAT(refusal([] { cube().pin("p", {27}); }), HasSubstr("vertex 27; there are 27"));
  EXPECT_THAT(refusal([] { cube().material("jelly", {.young = 1}); }), HasSubstr("known: neo_hookean"));
  EXPECT_THAT(refusal([] { cube().material("neo_hokean", {.young = 1}); }), HasSubstr("did you mean 'neo_hookean'"));
  EXPECT_THAT(refusal([] { cube().material("neo_hookean", {.young = -1}); }), HasSubstr("young = -1"));
  EXPECT_THAT(refusal([] { cube().material("neo_hookean", {.young = 1, .poisson = 0.5}); }), HasSubstr("try 0.45"));
  EXPECT_THAT(refusal([] { cube().material("neo_hookean", {.young = 1, .poisson = 0.3, .extra = {1}}); }),
              HasSubstr("it has none"));
  EXPECT_THAT(refusal([] { cube().material("stvk", std::vector<MaterialParameters>(3)); }), HasSubstr("for 48 tets"));
  EXPECT_THAT(refusal([] { cube().density(-1); }), HasSubstr("density [kg/m^3] = -1"));
  EXPECT_THAT(refusal([] { cube().gravity({{0, NAN, 0}}); }), HasSubstr("gravity"));
  EXPECT_THAT(refusal([] { cube().strain_rate_damping(-1); }), HasSubstr("viscosity"));
}

TEST(ModelBuilder, RejectsUnfinishedModels) {
  EXPECT_THAT(refusal([] { cube().density(1).build(); }), HasSubstr("no material"));
  EXPECT_THAT(refusal([] { cube().material("neo_hookean", {.young = 1}).build(); }), HasSubstr("no density"));
}

TEST(ModelBuilder, RejectsBrokenMeshes) {
  EXPECT_THAT(refusal([] { ModelBuilder builder(TetMesh{}); }), HasSubstr("has no tets"));
  TetMesh mesh = make_box({{0, 0, 0}}, {{1, 1, 1}}, {1, 1, 1});
  std::swap(mesh.tets[2][0], mesh.tets[2][1]);
  EXPECT_THAT(refusal([&] { ModelBuilder builder(mesh); }), HasSubstr("tet 2 has the volume -"));
  mesh.tets[2][0] = 8;
  EXPECT_THAT(refusal([&] { ModelBuilder builder(mesh); }), HasSubstr("the vertex 8; there are 8"));
}

}  // namespace
}  // namespace aspic
