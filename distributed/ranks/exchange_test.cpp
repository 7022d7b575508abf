#include "ranks/exchange.h"

#include <gmock/gmock.h>

#include "base/error.h"
#include "ranks/message_size.h"
#include "ranks/mpi_ranks.h"
#include "ranks/user_order.h"

namespace aspic::distributed {
namespace {

TEST(MessageSize, RefusesWhatMpiCannotCount) {
  EXPECT_EQ(message_size(2147483647), 2147483647);
  EXPECT_THROW(message_size(2147483648), InvalidInput);
}

// Rank r sends r + s + 1 values 100 r + s to rank s.
TEST(Exchange, GroupsTheValuesByTheirRank) {
  const int own = rank_of_this_process(), ranks = rank_count();
  std::vector<double> sent;
  std::vector<int> counts;
  for (int s = 0; s < ranks; ++s) {
    counts.push_back(own + s + 1);
    sent.insert(sent.end(), counts.back(), 100 * own + s);
  }
  const Received<double> received = exchange<double>(sent, counts);
  std::vector<double> expected;
  for (int r = 0; r < ranks; ++r) expected.insert(expected.end(), own + r + 1, 100 * r + own);
  EXPECT_EQ(received.values, expected);
}

TEST(Exchange, SumsAndTextsOfAllRanks) {
  const int own = rank_of_this_process(), ranks = rank_count();
  EXPECT_EQ(sum_before(own + 1), own * (own + 1) / 2);
  std::vector<std::int64_t> sums = {1, own};
  sum_over_ranks(sums);
  EXPECT_THAT(sums, testing::ElementsAre(ranks, ranks * (ranks - 1) / 2));
  const std::vector<std::string> texts = gather_texts(std::string(own, 'x'));
  ASSERT_EQ(static_cast<int>(texts.size()), ranks);
  for (int r = 0; r < ranks; ++r) EXPECT_EQ(texts[r], std::string(r, 'x'));
  EXPECT_EQ(broadcast_text(own == 0 ? "of rank 0" : ""), "of rank 0");
}

// The user numbers 12 vertices backwards.
TEST(UserOrder, SortsValuesThereAndBack) {
  MeshShare share;
  share.rank = rank_of_this_process();
  share.cut = equal_cuts(12, rank_count());
  std::vector<double> own;
  for (int v = share.first(); v < share.first() + share.own(); ++v) {
    share.vertex.push_back(v);
    share.user_vertex.push_back(11 - v);
    for (int axis = 0; axis < 3; ++axis) own.push_back(10 * v + axis);
  }
  const UserOrder order(share);
  const std::vector<double> slice = order.to_user(own);
  ASSERT_EQ(static_cast<int>(slice.size()), 3 * order.count());
  for (int i = 0; i < order.count(); ++i) EXPECT_EQ(slice[3 * i + 1], 10 * (11 - (order.first() + i)) + 1);
  EXPECT_EQ(order.from_user(slice), own);
}

}  // namespace
}  // namespace aspic::distributed
