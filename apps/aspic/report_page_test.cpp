#include "aspic/report_page.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/error.h"
#include "io/atomic_file.h"
#include "io/folder_test.h"

namespace aspic::cli {
namespace {

using testing::HasSubstr;
using testing::Not;

using Report = FolderTest;

TEST_F(Report, TextIsEscapedEverywhere) {
  const std::string evil = "<script>alert(\"1\")</script> & more";
  ReportPage page(evil, evil);
  page.heading(evil);
  page.paragraph(evil);
  page.code(evil);
  page.verdict(Verdict::fail, evil, evil);
  page.table({evil}, {{{evil}}, {{evil, Verdict::pass}}});
  EXPECT_THAT(page.html(), Not(HasSubstr("<script")));
  EXPECT_THAT(page.html(), HasSubstr("&lt;script&gt;alert(&quot;1&quot;)&lt;/script&gt; &amp; more"));
}

TEST_F(Report, VerdictsAreBadges) {
  ReportPage page("t");
  page.table({"what", "error"}, {{{"passed", Verdict::pass}, {"1.5e-3"}}, {{"failed", Verdict::fail}, {"2"}}});
  EXPECT_THAT(page.html(), HasSubstr("<span class=\"badge pass\">passed</span>"));
  EXPECT_THAT(page.html(), HasSubstr("<span class=\"badge fail\">failed</span>"));
  EXPECT_THAT(page.html(), HasSubstr("<td class=\"number\" data-label=\"error\">1.5e-3</td>"));
}

TEST_F(Report, PicturesAreInsideWithNamesOfTheirOwn) {
  write_file(folder / "a.svg",
             "<?xml version=\"1.0\"?><svg><g id=\"dot\"/><g id='box'/><use xlink:href='#dot'/></svg>");
  write_file(folder / "b.png", "abc");
  ReportPage page("t");
  page.figures({{folder / "a.svg", "first"}, {folder / "a.svg", "second"}, {folder / "b.png", "third"}});
  const std::string html = page.html();
  EXPECT_THAT(html, Not(HasSubstr("<?xml")));
  EXPECT_THAT(html, HasSubstr("<g id=\"p1_dot\"/><g id='p1_box'/><use xlink:href='#p1_dot'/>"));
  EXPECT_THAT(html, HasSubstr("<g id=\"p2_dot\"/><g id='p2_box'/><use xlink:href='#p2_dot'/>"));
  EXPECT_THAT(html, HasSubstr("data:image/png;base64,YWJj"));
  EXPECT_THAT(html, Not(HasSubstr("http")));
  page.write(folder / "page.html");
  EXPECT_EQ(read_file(folder / "page.html"), html);
}

TEST_F(Report, MissingAndForeignPicturesAreRefused) {
  write_file(folder / "c.txt", "no picture");
  ReportPage page("t");
  EXPECT_THROW(page.figures({{folder / "none.svg", ""}}), InvalidInput);
  EXPECT_THROW(page.figures({{folder / "c.txt", ""}}), InvalidInput);
}

TEST_F(Report, LongPagesHaveContents) {
  ReportPage page("t");
  for (const char* name : {"one", "two", "three"}) page.heading(name);
  EXPECT_THAT(page.html(), HasSubstr("<a href=\"#s2\">two</a>"));
  EXPECT_THAT(page.html(), HasSubstr("<h2 id=\"s2\">two</h2>"));
}

}  // namespace
}  // namespace aspic::cli
