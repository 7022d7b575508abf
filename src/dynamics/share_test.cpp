#include "dynamics/share.h"

#include <gmock/gmock.h>

namespace aspic {
namespace {

using testing::ElementsAre;

// The values of the processes are multiples of those of the first one.
class MultipleRanks : public Ranks {
 public:
  explicit MultipleRanks(std::vector<double> factors) : factors_(std::move(factors)) {}
  std::vector<double> gather(std::span<const double> own) const override {
    std::vector<double> all;
    for (const double factor : factors_)
      for (const double v : own) all.push_back(factor * v);
    return all;
  }
  std::vector<int> parts(const TetMesh&, std::span<const double>) const override { return {}; }

 private:
  std::vector<double> factors_;
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
  const MultipleRanks ranks({1, 2, 3});
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
  EXPECT_THAT(values, ElementsAre(6, 30));
}

TEST(Share, SumsInTheOrderOfTheProcesses) {
  EXPECT_EQ(Share(MultipleRanks({1, 1e17, -1e17}), 0, 1).sum(1), 0);
  EXPECT_EQ(Share(MultipleRanks({1e17, -1e17, 1}), 0, 1).sum(1), 1);
}

TEST(Share, LargestValueHasItsVertexInTheWholeModel) {
  const MultipleRanks ranks({1, 3, 2});
  double value = 1;
  int vertex = 2;
  Share(ranks, 10, 4).find_largest(value, vertex);
  EXPECT_EQ(value, 3);
  EXPECT_EQ(vertex, 36);  // three times 10 + 2
}

}  // namespace
}  // namespace aspic
