#include "energy/coloring.h"

#include <gtest/gtest.h>

#include <random>
#include <set>

namespace aspic {
namespace {

TEST(Coloring, ColorsShareNoVertexAndCoverAllGroups) {
  std::mt19937 random(1);
  std::vector<std::vector<int>> groups(200);
  for (auto& group : groups)
    for (int i = 0; i < 5; ++i) group.push_back(static_cast<int>(random() % 300));
  const ColorClasses colors = color_groups(groups, 300);
  std::multiset<int> seen;
  for (const auto& color : colors) {
    std::set<int> touched;
    for (const int group : color) {
      seen.insert(group);
      for (const int v : std::set<int>(groups[group].begin(), groups[group].end()))
        EXPECT_TRUE(touched.insert(v).second) << "vertex " << v << " twice in one color";
    }
  }
  EXPECT_EQ(seen.size(), groups.size());
  EXPECT_EQ(std::set<int>(seen.begin(), seen.end()).size(), groups.size());
}

TEST(Coloring, DisjointGroupsShareOneColor) {
  const std::vector<std::vector<int>> groups = {{0, 1}, {2, 3}, {4}};
  EXPECT_EQ(color_groups(groups, 5).size(), 1u);
}

}  // namespace
}  // namespace aspic
