// The order in time by a motion that linear tets represent exactly: verify/integrators.h.
#include <gtest/gtest.h>

#include <cmath>

#include "dynamics/integrator.h"
#include "verify/integrators.h"

namespace aspic {
namespace {

using verify::affine_motion_error;
using verify::Held;

TEST(TemporalOrder, IsThatOfTheSchemeWhereverPinsCarryTheBodyAlong) {
  for (const std::string& integrator : verify::integrators_in_time()) {
    const auto scheme = make_integrator(integrator);
    for (const Held held : {Held::nowhere, Held::on_one_face, Held::on_the_boundary}) {
      const double h = scheme->order() == 4 ? 0.04 : 0.01;
      const double coarse = affine_motion_error(integrator, h, held);
      const double fine = affine_motion_error(integrator, h / 2, held);
      EXPECT_NEAR(std::log2(coarse / fine), scheme->order(), 0.2)
          << integrator << " " << static_cast<int>(held) << ": " << coarse << " " << fine;
      EXPECT_GT(fine, 1e-10) << integrator << ": no error to measure an order by";
    }
  }
}

TEST(TemporalOrder, HoldsDownToAFloorOf1em10) {
  EXPECT_LT(affine_motion_error("rk4", 0.0025, Held::on_one_face), 1e-10);
  const double error = affine_motion_error("tr_bdf2", 0.0005, Held::on_one_face);
  EXPECT_NEAR(error * 400, affine_motion_error("tr_bdf2", 0.01, Held::on_one_face), 0.1 * error * 400);
}

}  // namespace
}  // namespace aspic
