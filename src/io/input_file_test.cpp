#include "io/input_file.h"

#include <gmock/gmock.h>
#include <sys/stat.h>

#include "io/csv_reader.h"
#include "io/folder_test.h"
#include "io/pc2.h"

namespace aspic {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

using InputFile = FolderTest;

TEST_F(InputFile, OpensOnlyRegularFiles) {
  ASSERT_EQ(::mkfifo(path("pipe").c_str(), 0600), 0);  // opening it would wait for a writer
  fs::create_directory(path("folder"));
  for (const fs::path& file : {path("pipe"), path("folder"), path("missing"), fs::path("/dev/zero")}) {
    EXPECT_FALSE(try_open_input(file)) << file;
    for (const std::string& why : {message_of([&] { open_input(file); }), message_of([&] { CsvReader table(file); }),
                                   message_of([&] { Pc2Reader cache(file); })})
      EXPECT_THAT(why, HasSubstr(file.string() + ": cannot be read, or is not a regular file")) << file;
  }
}

TEST_F(InputFile, IsReadFromBeginning) {
  put(path("file"), "text");
  std::string word;
  open_input(path("file")) >> word;
  EXPECT_EQ(word, "text");
}

TEST_F(InputFile, RejectsRelevantLinksInFolder) {
  put(path("victim"), "");
  fs::create_directories(path("run") / "frames");
  const auto is_result = [](const fs::path& file) { return file.filename() != "mine"; };
  const auto refusal = [&] { return message_of([&] { refuse_links(path("run"), is_result); }); };
  fs::create_symlink("../victim", path("run") / "mine");
  EXPECT_EQ(refusal(), "");
  fs::create_symlink("../../victim", path("run") / "frames" / "body.vtu");
  EXPECT_THAT(refusal(), HasSubstr("frames/body.vtu: is a link"));
  fs::remove(path("run") / "frames" / "body.vtu");
  fs::create_symlink("../victim", path("run") / "steps.csv");
  EXPECT_THAT(refusal(), HasSubstr("steps.csv: is a link"));
}

}  // namespace
}  // namespace aspic
