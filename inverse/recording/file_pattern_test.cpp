#include "recording/file_pattern.h"

#include <gmock/gmock.h>

#include "base/error.h"
#include "io/folder_test.h"

namespace aspic {
namespace {

class FilePattern : public FolderTest {
 protected:
  std::vector<std::string> matching(const std::string& pattern) {
    std::vector<std::string> names;
    for (const auto& file : matching_files(path(pattern))) names.push_back(file.filename().string());
    return names;
  }
};

TEST_F(FilePattern, SortsNumbersNaturally) {
  for (const char* name : {"scan_10.ply", "scan_2.ply", "scan_001.ply", "scan_2.obj", "other.ply"})
    folder.write(name, "");
  EXPECT_THAT(matching("scan_*.ply"), testing::ElementsAre("scan_001.ply", "scan_2.ply", "scan_10.ply"));
  EXPECT_THAT(matching("*2*"), testing::ElementsAre("scan_2.obj", "scan_2.ply"));
  EXPECT_THAT(matching("other.ply"), testing::ElementsAre("other.ply"));
}

TEST_F(FilePattern, RefusesPatternWithoutFiles) { EXPECT_THROW(matching("*.trc"), InvalidInput); }

}  // namespace
}  // namespace aspic
