#include "ranks/mesh_share.h"

#include <gmock/gmock.h>

namespace aspic::distributed {
namespace {

using testing::ElementsAre;

TEST(EqualCuts, DifferByAtMostOne) {
  EXPECT_THAT(equal_cuts(10, 3), ElementsAre(0, 3, 6, 10));
  EXPECT_THAT(equal_cuts(2'000'000'000, 2), ElementsAre(0, 1'000'000'000, 2'000'000'000));  // the product overflows int
}

// Two tets over the vertices 0 to 4, of which rank 1 owns 2 to 4.
TEST(Arrange, CountsTheTetsWhoseSmallestVertexIsOwn) {
  MeshShare share;
  share.rank = 1;
  share.cut = {0, 2, 5};
  const std::vector<Tet> local = arrange({{Tet{0, 1, 2, 3}, Tet{2, 3, 4, 1}, Tet{2, 3, 4, 5}}}, {{7, 8, 9}}, share);
  EXPECT_THAT(share.vertex, ElementsAre(2, 3, 4, 0, 1, 5));  // ghosts after the own ones
  ASSERT_EQ(share.bodies.size(), 1U);
  EXPECT_EQ(share.bodies[0].counted, 1);
  EXPECT_EQ(share.bodies[0].halo, 2);
  EXPECT_THAT(share.user_tet, ElementsAre(9, 7, 8));
  ASSERT_EQ(local.size(), 3U);
  EXPECT_THAT(local[1], ElementsAre(3, 4, 0, 1));  // 0, 1, 2, 3
  EXPECT_EQ(share.local(5), 5);
  EXPECT_EQ(share.local(6), -1);
}

}  // namespace
}  // namespace aspic::distributed
