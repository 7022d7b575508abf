#include "viewer/page.h"

#include <gmock/gmock.h>

namespace aspic::viewer {
namespace {

using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

TEST(Page, IsOneFileWithItsStylesAndScripts) {
  EXPECT_THAT(page(), StartsWith("<!doctype html>"));
  EXPECT_THAT(page(), HasSubstr("<style>"));
  EXPECT_THAT(page(), HasSubstr("<script>"));
  EXPECT_THAT(page(), Not(HasSubstr("<!-- s")));  // every place is filled
}

TEST(Page, EmbedsARecordingOnce) {
  const std::string filled = page_with("<i>recorded $& \\1</i>");
  EXPECT_EQ(filled.size(), page().size() + 21 - std::string_view("<!-- recording -->").size());
  EXPECT_LT(filled.find("<i>recorded $& \\1</i>"), filled.find("<script>"));
}

}  // namespace
}  // namespace aspic::viewer
