#include "io/gzip.h"

#include <gmock/gmock.h>

#include <random>

#include "base/error.h"

namespace aspic {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

constexpr size_t kLimit = size_t{1} << 20;

std::string noise(size_t size) {
  std::mt19937 random(1);
  std::string bytes(size, ' ');
  for (char& byte : bytes) byte = static_cast<char>(random());
  return bytes;
}

TEST(Gzip, UnpacksWhatItPacked) {
  for (const size_t size : {size_t{0}, size_t{1}, size_t{65535}, size_t{65536}, size_t{300000}}) {
    const std::string bytes = noise(size);
    EXPECT_EQ(gunzipped(gzipped(bytes), kLimit), bytes) << size;
  }
}

TEST(Gzip, CompressesRepetition) { EXPECT_LT(gzipped(std::string(100000, 'a')).size(), 200u); }

TEST(Gzip, ReadsArchivesOfOtherPrograms) {
  const std::string hello(
      "\x1f\x8b\x08\x00\x00\x00\x00\x00\x02\x03\xcb\x48\xcd\xc9\xc9\x07\x00\x86\xa6\x10\x36\x05\x00\x00\x00", 25);
  EXPECT_EQ(gunzipped(hello, kLimit), "hello");
}

TEST(Gzip, DistinguishesDamageFromTruncation) {
  const std::string packed = gzipped(noise(1000));
  for (size_t size = 0; size < packed.size(); ++size)
    EXPECT_THAT([&] { gunzipped(packed.substr(0, size), kLimit); }, ThrowsMessage<InvalidInput>(HasSubstr("cut short")))
        << size;
  std::string damaged = packed;
  damaged[500] ^= 1;
  EXPECT_THROW(gunzipped(damaged, kLimit), InvalidInput);
  EXPECT_THAT([&] { gunzipped(packed + "x", kLimit); }, ThrowsMessage<InvalidInput>(HasSubstr("damaged")));
  EXPECT_THAT([&] { gunzipped("no gzip at all", kLimit); }, ThrowsMessage<InvalidInput>(HasSubstr("damaged")));
}

TEST(Gzip, RejectsMoreThanExpected) {
  const std::string bomb = gzipped(std::string(10 * kLimit, '\0'));
  EXPECT_THAT([&] { gunzipped(bomb, kLimit); }, ThrowsMessage<InvalidInput>(HasSubstr("more than the 1048576 bytes")));
  EXPECT_EQ(gunzipped(gzipped(std::string(kLimit, 'a')), kLimit).size(), kLimit);
}

}  // namespace
}  // namespace aspic
