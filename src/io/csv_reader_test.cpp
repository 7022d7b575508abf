#include "io/csv_reader.h"

#include <gmock/gmock.h>

#include <cmath>

#include "base/error.h"
#include "io/atomic_file.h"
#include "io/csv.h"
#include "io/folder_test.h"

namespace aspic {
namespace {

using testing::HasSubstr;

class CsvReading : public FolderTest {
 protected:
  CsvReader reader(const std::string& text) {
    write_file(path("table.csv"), text);
    return CsvReader(path("table.csv"));
  }
  std::string refusal(const std::string& text) {
    try {
      CsvReader table = reader(text);
      const size_t step = table.column("step"), energy = table.column("energy");
      while (table.next()) {
        table.integer(step);
        table.number(energy);
      }
    } catch (const InvalidInput& error) {
      return error.what();
    }
    return "";
  }
};

TEST_F(CsvReading, ReadsBackWrittenNumbersExactly) {
  CsvFile file = CsvFile::create(path("table.csv"), {"step", "name, with comma", "value"});
  file.append(CsvRow().add(1).add("say \"yes\"").add(0.1));
  file.append(CsvRow().add(2).add("").add(NAN));
  file.append(CsvRow().add(3).add("b").add(-INFINITY));
  file.close();
  CsvReader table(path("table.csv"));
  EXPECT_EQ(table.column("name, with comma"), 1u);
  EXPECT_FALSE(table.has("name"));
  ASSERT_TRUE(table.next());
  EXPECT_EQ(table.integer(0), 1);
  EXPECT_EQ(table.text(1), "say \"yes\"");
  EXPECT_EQ(table.number(2), 0.1);
  ASSERT_TRUE(table.next());
  EXPECT_EQ(table.text(1), "");
  EXPECT_TRUE(std::isnan(table.number(2)));
  ASSERT_TRUE(table.next());
  EXPECT_EQ(table.number(2), -INFINITY);
  EXPECT_FALSE(table.next());
}

TEST_F(CsvReading, EscapesTerminalControlCharacters) {
  CsvReader table = reader(
      "step,e\x1b[31m\n1,b\xfc"
      "chse\n");
  EXPECT_EQ(table.columns(), (std::vector<std::string>{"step", "e\\x1B[31m"}));
  ASSERT_TRUE(table.next());
  EXPECT_EQ(table.text(1), "b\\xFCchse");
}

TEST_F(CsvReading, IgnoresIncompleteLastLine) {
  CsvReader table = reader("step,energy\n1,2\n2,3");
  EXPECT_TRUE(table.next());
  EXPECT_FALSE(table.next());
}

TEST_F(CsvReading, RejectsDamageWithFileAndLine) {
  EXPECT_THAT(refusal(""), HasSubstr("table.csv: is empty"));
  EXPECT_THAT(refusal("step,value\n"), HasSubstr("table.csv:1: missing column 'energy'; found step, value"));
  EXPECT_THAT(refusal("step,energy\n1,2\n2\n"), HasSubstr("table.csv:3: has 1 cells; the header has 2"));
  EXPECT_THAT(refusal("step,energy\n1,two\n"), HasSubstr("table.csv:2: energy = 'two' is not a number"));
  EXPECT_THAT(refusal("step,energy\n1.5,2\n"), HasSubstr("table.csv:2: step = '1.5' is not a whole number"));
  EXPECT_THAT(refusal("step,energy\n" + std::string(3'000'000, 'x') + "\n"), HasSubstr("table.csv:2: is too long"));
  EXPECT_THROW(CsvReader(path("none.csv")), InvalidInput);
  EXPECT_EQ(refusal("step,energy\r\n1,2\r\n"), "");
}

TEST_F(CsvReading, AcceptsSemicolonsAndDecimalCommasOfSpreadsheets) {
  write_file(path("foreign.csv"), "\xEF\xBB\xBF x [mm] ;force\r\n\r\n# taken on Monday\r\n 1,5 ; +2\r\n;-3,25e1;;");
  CsvReader table(path("foreign.csv"), CsvOrigin::foreign);
  EXPECT_THAT(table.columns(), testing::ElementsAre("x [mm]", "force"));
  ASSERT_TRUE(table.next());
  EXPECT_EQ(table.line(), 4);
  EXPECT_EQ(table.number(0), 1.5);
  EXPECT_EQ(table.number(1), 2);
  ASSERT_TRUE(table.next());  // the last line has no break
  EXPECT_TRUE(table.is_blank(0));
  EXPECT_FALSE(table.try_number(0).has_value());
  EXPECT_EQ(table.number(1), -32.5);
  EXPECT_THAT(table.where(), testing::EndsWith("foreign.csv:5"));
  EXPECT_FALSE(table.next());
}

TEST_F(CsvReading, AcceptsTabsAndRejectsFolders) {
  write_file(path("tabs.csv"), "a\tb\n1\t2\n");
  CsvReader table(path("tabs.csv"), CsvOrigin::foreign);
  ASSERT_TRUE(table.next());
  EXPECT_EQ(table.number(1), 2);
  EXPECT_THROW(CsvReader(path("tabs.csv").parent_path(), CsvOrigin::foreign), InvalidInput);
}

}  // namespace
}  // namespace aspic
