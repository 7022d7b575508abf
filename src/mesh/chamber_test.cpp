// The generated chamber: volume, surface, refinement.
#include "mesh/chamber.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "mesh/doctor.h"
#include "mesh/surface.h"
#include "mesh/tet_shape.h"

namespace aspic {
namespace {

const Chamber kHeart{0.007, 0.017, 0.010, 0.020, 0.005};

// Volume of the ellipsoid from its tip at -c to z.
double cap(double a, double c, double z) {
  return std::numbers::pi * a * a * (z + c - (z * z * z + c * c * c) / (3 * c * c));
}

TEST(Chamber, VolumeConvergesToThatOfTheEllipsoids) {
  const double exact = cap(0.010, 0.020, 0.005) - cap(0.007, 0.017, 0.005);
  double last = 1;
  for (const int n : {8, 16, 32}) {
    const double error = 1 - total_volume(make_chamber(kHeart, {n, n / 4})) / exact;
    EXPECT_LT(std::abs(error), 0.3 * last);
    last = std::abs(error);
  }
  EXPECT_LT(last, 2e-3);
}

TEST(Chamber, EveryTetHasPositiveVolumeAndTheSurfaceIsClosed) {
  for (int quarters = 1; quarters <= 4; ++quarters) {
    const TetMesh mesh = make_chamber(kHeart, {5, 2, quarters});
    for (int t = 0; t < mesh.tet_count(); ++t) EXPECT_GT(mean_ratio(corners(mesh, t)), 0.05);
    Vec3d sum{};
    for (const Triangle& f : boundary_triangles(mesh, 0, mesh.tet_count()))
      sum = sum + cross(mesh.rest[f[1]] - mesh.rest[f[0]], mesh.rest[f[2]] - mesh.rest[f[0]]);
    EXPECT_LT(norm(sum), 1e-15);
  }
}

TEST(Chamber, DoubledCountsRefineTheSameGrid) {
  const TetMesh coarse = make_chamber(kHeart, {4, 1, 2}), fine = make_chamber(kHeart, {8, 2, 2});
  for (const Vec3d& X : coarse.rest) {
    double nearest = 1;
    for (const Vec3d& Y : fine.rest) nearest = std::min(nearest, norm(X - Y));
    EXPECT_LT(nearest, 1e-15);
  }
}

TEST(Chamber, CellsHaveTheGivenSize) {
  const ChamberCells cells = chamber_cells(kHeart, 0.0015);
  EXPECT_EQ(cells.layers, 2);
  EXPECT_NEAR(cells.rings, 20, 2);
  EXPECT_EQ(tets_in_chamber(kHeart, 0.0015), make_chamber(kHeart, cells).tet_count());
}

}  // namespace
}  // namespace aspic
