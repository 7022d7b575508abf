#include "mesh/cage.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "mesh/embed.h"
#include "mesh/generators.h"
#include "mesh/surface.h"
#include "mesh/surface_orientation.h"
#include "mesh/tet_shape.h"

namespace aspic {
namespace {

TEST(Cage, ContainsTheSurfaceAndLittleMore) {
  const TriMesh surface = boundary_surface(make_torus(1, 0.4, 0.1)).surface;
  for (const double size : {0.2, 0.1}) {
    const TetMesh cage = make_cage(surface, size);
    for (int t = 0; t < cage.tet_count(); ++t) ASSERT_GT(volume(cage, t), 0);
    const double enclosed = enclosed_volume(surface);
    EXPECT_GT(total_volume(cage), enclosed);
    EXPECT_LT(total_volume(cage), enclosed * (1 + 10 * size));
    EXPECT_EQ(embed(cage, surface).outside, 0);
  }
}

// A thin sheet inside one layer of cubes has no center inside.
TEST(Cage, KeepsThinParts) {
  const TriMesh surface = boundary_surface(make_box({}, {{1, 1, 0.01}}, {4, 4, 1})).surface;
  const TetMesh cage = make_cage(surface, 0.25);
  EXPECT_EQ(cage.tet_count(), 4 * 4 * 6);
  EXPECT_EQ(embed(cage, surface).outside, 0);
}

TEST(Cage, RefusesTooManyCubes) {
  const TriMesh surface = boundary_surface(make_torus(1, 0.4, 0.1)).surface;
  for (const double size : {1e-3, 1e-300}) EXPECT_THROW(make_cage(surface, size), InvalidInput);
}

TEST(Cage, IsEmptyForFlatSurfaces) {
  const TriMesh flat{{{{0, 0, 0}}, {{1, 0, 0}}, {{0, 1, 0}}}, {{0, 1, 2}}};
  EXPECT_EQ(make_cage(flat, 0.1).tet_count(), 0);
}

}  // namespace
}  // namespace aspic
