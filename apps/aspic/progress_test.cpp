#include "aspic/progress.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "io/atomic_file.h"
#include "io/folder_test.h"

namespace aspic::cli {
namespace {

using ProgressLine = FolderTest;

// Steps take 1 s until a body touches the floor in step 50, then 10 s.
TEST_F(ProgressLine, TimeLeftFollowsRecentSteps) {
  const std::filesystem::path path = folder / "progress";
  std::FILE* file = std::fopen(path.c_str(), "w");
  ASSERT_NE(file, nullptr);
  double now = 100;
  Progress progress(file, 0, 100, [&now] { return now; });
  StepReport report;
  for (report.step = 1; report.step <= 80; ++report.step) {
    now += report.step < 50 ? 1 : 10;
    progress.show(report);
  }
  std::fclose(file);
  const std::string text = read_file(path);
  EXPECT_THAT(text, testing::ContainsRegex("step 36/100 [^\n]* 1 min 04 s left"));
  EXPECT_THAT(text, testing::ContainsRegex("step 80/100 [^\n]* 3 min 20 s left"));
}

}  // namespace
}  // namespace aspic::cli
