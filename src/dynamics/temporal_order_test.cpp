// Order in time, measured by a motion that linear tets represent exactly: tests/reference/integrators.h.
#include <gtest/gtest.h>

#include <cmath>

#include "dynamics/models_test.h"
#include "reference/integrators.h"

namespace aspic {
namespace {

using verify::affine_motion_error;
using verify::Held;

TEST(TemporalOrder, HoldsWithMovingPins) {
  for (const std::string& integrator : verify::integrators_in_time()) {
    const auto scheme = make_integrator(integrator);
    for (const Held held : {Held::nowhere, Held::on_one_face, Held::on_the_boundary}) {
      const double h = scheme->facts().order == 4 ? 0.04 : 0.01;
      const double coarse = affine_motion_error(integrator, h, held);
      const double fine = affine_motion_error(integrator, h / 2, held);
      EXPECT_NEAR(std::log2(coarse / fine), scheme->facts().order, 0.2)
          << integrator << " " << static_cast<int>(held) << ": " << coarse << " " << fine;
      EXPECT_GT(fine, 1e-10) << integrator << ": the error is too small to measure an order";
    }
  }
}

TEST(TemporalOrder, HoldsDownTo1em10) {
  EXPECT_LT(affine_motion_error("rk4", 0.0025, Held::on_one_face), 1e-10);
  const double error = affine_motion_error("tr_bdf2", 0.0005, Held::on_one_face);
  EXPECT_NEAR(error * 400, affine_motion_error("tr_bdf2", 0.01, Held::on_one_face), 0.1 * error * 400);
}

// A thrown beam, including its pinned vertices, whose fixed pin gives them no velocity.
std::vector<double> thrown_beam(const std::string& integrator, double h) {
  Model model = testing_models::beam(1, {.young = 1e4, .poisson = 0.3, .gravity = {{0, 0, 0}}});
  State start = at_rest(model.mesh);
  for (size_t i = 1; i < start.qdot.size(); i += 3) start.qdot[i] = 1;
  Simulation simulation(std::move(model), std::move(start), {.h = h, .integrator = integrator});
  for (int step = 0; step < std::lround(0.05 / h); ++step) EXPECT_TRUE(is_success(simulation.step().status));
  return simulation.state().q;
}

TEST(TemporalOrder, HoldsWithMovingPinsAtStart) {
  const std::vector<double> exact = thrown_beam("rk4", 0.0025);
  for (const std::string& integrator : verify::integrators_in_time()) {
    const double coarse = verify::largest_difference(thrown_beam(integrator, 0.005), exact);
    const double fine = verify::largest_difference(thrown_beam(integrator, 0.0025), exact);
    EXPECT_LT(fine, 0.7 * coarse + 1e-6) << integrator;
    EXPECT_LT(fine, 0.005) << integrator;
  }
}

}  // namespace
}  // namespace aspic
