#include "io/csv.h"

#include <gmock/gmock.h>

#include <limits>

#include "base/error.h"
#include "io/atomic_file.h"
#include "io/folder_test.h"

namespace aspic {
namespace {

using testing::HasSubstr;
using CsvTable = FolderTest;

const std::vector<std::string> kColumns = {"step", "energy"};

TEST_F(CsvTable, WritesShortestExactNumbers) {
  EXPECT_EQ(CsvRow().add(1).add(0.1).add(1e-9).add(-0.0).add(2.0).text(), "1,0.1,1e-09,-0,2");
  EXPECT_EQ(CsvRow().add(std::numeric_limits<double>::infinity()).add(-std::numeric_limits<double>::quiet_NaN()).text(),
            "inf,nan");
}

TEST_F(CsvTable, QuotesWordsThatNeedIt) {
  EXPECT_EQ(CsvRow().add("plain").add("a,b").add("say \"x\"").add("two\nlines").text(),
            "plain,\"a,b\",\"say \"\"x\"\"\",\"two\nlines\"");
  EXPECT_EQ(CsvRow().add("").add(1).text(), "\"\",1");
}

TEST_F(CsvTable, WritesEachRowImmediately) {
  CsvFile table = CsvFile::create(path("t.csv"), kColumns);
  EXPECT_EQ(read_file(path("t.csv")), "step,energy\n");
  table.append(CsvRow().add(1).add(0.5));
  EXPECT_EQ(read_file(path("t.csv")), "step,energy\n1,0.5\n");
}

TEST_F(CsvTable, ResumingDropsLaterAndIncompleteRows) {
  for (const char* rest : {"", "3,0.75\n4,1\n", "3,0.7", "3"}) {
    put(path("t.csv"), std::string("step,energy\n1,0.5\n2,0.6\n") + rest);
    CsvFile::resume(path("t.csv"), kColumns, 2, CsvFile::Rows::every_step).append(CsvRow().add(3).add(9.0));
    EXPECT_EQ(read_file(path("t.csv")), "step,energy\n1,0.5\n2,0.6\n3,9\n");
  }
}

TEST_F(CsvTable, ResumingAtStepZeroKeepsOnlyHeader) {
  put(path("t.csv"), "step,energy\n1,0.5\n");
  CsvFile::resume(path("t.csv"), kColumns, 0, CsvFile::Rows::every_step);
  EXPECT_EQ(read_file(path("t.csv")), "step,energy\n");
}

TEST_F(CsvTable, ResumingRejectsMismatchingTables) {
  const auto message = [&](const std::string& text, CsvFile::Rows rows) {
    put(path("t.csv"), text);
    return message_of<InvalidInput>([&] { CsvFile::resume(path("t.csv"), kColumns, 2, rows); });
  };
  constexpr auto kEvery = CsvFile::Rows::every_step, kOptional = CsvFile::Rows::optional;
  EXPECT_THAT(message("step,power\n1,1\n2,1\n", kEvery), HasSubstr("t.csv:1: other columns"));
  EXPECT_THAT(message("step,energy\n1,1\n", kEvery), HasSubstr("ends at step 1, before the checkpoint at step 2"));
  EXPECT_THAT(message("step,energy\n1,1\n2,", kEvery), HasSubstr("ends at step 1"));
  EXPECT_THAT(message("step,energy\n1,1\nx,1\n", kEvery), HasSubstr("t.csv:3: the row does not begin"));
  EXPECT_THAT(message("step,energy\n2,1\n1,1\n", kEvery), HasSubstr("t.csv:3: the row does not begin"));
  EXPECT_EQ(message("step,energy\n1,1\n1,2\n", kOptional), "");
}

}  // namespace
}  // namespace aspic
