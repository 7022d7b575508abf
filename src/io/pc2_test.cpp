#include "io/pc2.h"

#include <gmock/gmock.h>

#include "base/error.h"
#include "io/atomic_file.h"
#include "io/folder_test.h"

namespace aspic {
namespace {

using testing::HasSubstr;
using PointCache = FolderTest;

const std::vector<double> kFirst = {0, 1, 2, 3, 4, 5}, kSecond = {0.5, 1.5, 2.5, 3.5, 4.5, 5.5};

void write_two(const std::filesystem::path& path) {
  Pc2File cache = Pc2File::create(path, 2);
  cache.append(kFirst);
  cache.append(kSecond);
}

TEST_F(PointCache, HasTheBytesOfTheFormat) {
  write_two(path("a.pc2"));
  const std::string bytes = read_file(path("a.pc2"));
  ASSERT_EQ(bytes.size(), 32u + 2 * 24);
  EXPECT_EQ(bytes.substr(0, 32), std::string("POINTCACHE2\0"
                                             "\1\0\0\0"
                                             "\2\0\0\0"
                                             "\0\0\0\0"
                                             "\0\0\x80\x3f"
                                             "\2\0\0\0",
                                             32));
  EXPECT_EQ(bytes.substr(36, 4), std::string("\0\0\x80\x3f", 4));  // 1.0f
}

TEST_F(PointCache, CountsOnlyCompleteSamples) {
  Pc2File cache = Pc2File::create(path("a.pc2"), 2);
  EXPECT_EQ(read_file(path("a.pc2"))[28], 0);
  cache.append(kFirst);
  EXPECT_EQ(read_file(path("a.pc2"))[28], 1);
  EXPECT_EQ(cache.sample(0), (std::vector<float>{0, 1, 2, 3, 4, 5}));
}

TEST_F(PointCache, ResumedFileEqualsUninterruptedFile) {
  write_two(path("whole.pc2"));
  write_two(path("torn.pc2"));
  std::filesystem::resize_file(path("torn.pc2"), 32 + 24 + 7);  // the header counts the incomplete sample
  Pc2File cache = Pc2File::resume(path("torn.pc2"), 2, 1);
  EXPECT_EQ(cache.samples(), 1);
  cache.append(kSecond);
  EXPECT_EQ(read_file(path("torn.pc2")), read_file(path("whole.pc2")));
}

TEST_F(PointCache, ResumingRejectsMismatchingCaches) {
  write_two(path("a.pc2"));
  const auto message = [&](int points, int samples) {
    return message_of<InvalidInput>([&] { Pc2File::resume(path("a.pc2"), points, samples); });
  };
  EXPECT_THAT(message(3, 2), HasSubstr("a.pc2: is not a point cache of 3 points"));
  EXPECT_THAT(message(2, 3), HasSubstr("holds fewer than the 3 samples"));
  put(path("a.pc2"), "POINTCACHE2");
  EXPECT_THAT(message(2, 0), HasSubstr("is not a point cache"));
}

TEST_F(PointCache, ReadingDoesNotModifyFile) {
  write_two(path("a.pc2"));
  const std::string bytes = read_file(path("a.pc2"));
  Pc2Reader cache(path("a.pc2"));
  EXPECT_EQ(cache.points(), 2);
  ASSERT_EQ(cache.samples(), 2);
  EXPECT_EQ(cache.sample(1), (std::vector<float>{0.5, 1.5, 2.5, 3.5, 4.5, 5.5}));
  EXPECT_EQ(cache.sample(0), (std::vector<float>{0, 1, 2, 3, 4, 5}));
  EXPECT_EQ(read_file(path("a.pc2")), bytes);
}

TEST_F(PointCache, ReadingRejectsDamage) {
  write_two(path("a.pc2"));
  const std::string bytes = read_file(path("a.pc2"));
  const auto message = [&](const std::string& damaged) {
    write_file(path("b.pc2"), damaged);
    return message_of<InvalidInput>([&] { Pc2Reader(path("b.pc2")); });
  };
  EXPECT_THAT(message(bytes.substr(0, 20)), HasSubstr("b.pc2: cannot be read, or is too short"));
  EXPECT_THAT(message(bytes.substr(0, 70)), HasSubstr("b.pc2: the point cache is cut short"));
  EXPECT_THAT(message("x" + bytes.substr(1)), HasSubstr("b.pc2: is not a point cache"));
  std::string hostile = bytes;
  hostile.replace(16, 4, "\xff\xff\xff\x7f").replace(28, 4, "\xff\xff\xff\x7f");  // 2^31 - 1 points and samples
  EXPECT_THAT(message(hostile), HasSubstr("b.pc2: the point cache is cut short"));
  hostile.resize(32);
  hostile.replace(16, 4, 4, '\0');  // 2^31 - 1 samples of no points need no bytes
  EXPECT_THAT(message(hostile), HasSubstr("b.pc2: the point cache states 2147483647 samples of 0 points"));
}

}  // namespace
}  // namespace aspic
