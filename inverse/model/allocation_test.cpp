#include "allocation_counter.h"

#include "linalg/linear_solver.h"
#include "model/equilibrium.h"
#include "model/sagging_test.h"

namespace aspic {
namespace {

using namespace testing_models;

TEST(Allocations, RepeatedEquilibriaAndTheirDerivativesMakeNone) {
  for (const std::string& linear : linear_solver_names()) {
    Sagging body("neo_hookean");
    Equilibrium equilibrium(std::move(body.model), body.rest, {.linear = linear, .adjoint = linear});
    const std::vector<double> dtheta = change_of(body, 0);
    const std::vector<MaterialParameters> others = changed(body, dtheta, 0.2);
    std::vector<double> dx(body.rest.size()), thetabar(dtheta.size());
    const auto all = [&](const std::vector<MaterialParameters>& parameters) {
      equilibrium.set_parameters(parameters);
      const bool ok = is_success(equilibrium.solve().status) && equilibrium.factorize();
      return ok && equilibrium.tangent(dtheta, dx).ok && equilibrium.add_adjoint(dx, thetabar).ok;
    };
    for (int i = 0; i < 2; ++i) EXPECT_TRUE(all(body.parameters) && all(others)) << linear;
    const test::AllocationCounter counter;
    EXPECT_TRUE(all(body.parameters) && all(others)) << linear;
    EXPECT_EQ(counter.count(), 0) << linear;
  }
}

}  // namespace
}  // namespace aspic
