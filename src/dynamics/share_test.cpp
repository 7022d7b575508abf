#include "dynamics/share.h"

#include <gmock/gmock.h>

namespace aspic {
namespace {

using testing::ElementsAre;

// Three processes whose values are v, v + 1 and v + 2 for each value v of this one.
class ThreeRanks : public Ranks {
 public:
  std::vector<double> gather(std::span<const double> own) const override {
    std::vector<double> all;
    for (int rank = 0; rank < 3; ++rank)
      for (const double v : own) all.push_back(v + rank);
    return all;
  }
  std::vector<int> parts(std::span<const double>) const override { return {}; }
};

TEST(Share, WholeModelReturnsItsArguments) {
  const Share share;
  EXPECT_TRUE(share.is_whole());
  EXPECT_EQ(share.own(7), 7);
  EXPECT_EQ(share.sum(0.1), 0.1);
  EXPECT_EQ(share.max(-2), -2);
  EXPECT_EQ(share.min(-2), -2);
  EXPECT_EQ(share.norm(-2), -2);
  double value = 3;
  int vertex = 5;
  share.find_largest(value, vertex);
  EXPECT_EQ(value, 3);
  EXPECT_EQ(vertex, 5);
}

TEST(Share, CombinesTheValuesOfAllProcesses) {
  const ThreeRanks ranks;
  const Share share(ranks, 10, 4);
  EXPECT_EQ(share.own(7), 4);
  EXPECT_EQ(share.in_whole(2), 12);
  EXPECT_EQ(share.sum(1), 1 + 2 + 3);
  EXPECT_EQ(share.max(1), 3);
  EXPECT_EQ(share.min(1), 1);
  EXPECT_TRUE(share.all(true));
  EXPECT_FALSE(share.all(false));
  std::vector<double> values = {1, 5};
  share.sum(values);
  EXPECT_THAT(values, ElementsAre(6, 18));
}

TEST(Share, SumsInTheOrderOfTheProcesses) {
  const ThreeRanks ranks;
  const double tiny = 1e-17;  // is lost in every sum with a number near 1
  EXPECT_EQ(Share(ranks, 0, 1).sum(tiny), tiny + (1 + tiny) + (2 + tiny));
}

TEST(Share, LargestValueHasItsVertexInTheWholeModel) {
  const ThreeRanks ranks;
  double value = 1;
  int vertex = 2;
  Share(ranks, 10, 4).find_largest(value, vertex);
  EXPECT_EQ(value, 3);
  EXPECT_EQ(vertex, 14);
}

}  // namespace
}  // namespace aspic
