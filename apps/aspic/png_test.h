// Reads the pixels of PNG files in tests: 8 bits per channel, RGB or RGBA, not interlaced, as written by browsers.
#pragma once
#include <gtest/gtest.h>
#include <zlib.h>

#include <array>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "io/atomic_file.h"

namespace aspic::cli {

using Pixel = std::array<int, 3>;

struct Image {
  unsigned width = 0, height = 0;  // 0: not a PNG of this kind
  std::vector<Pixel> pixels;       // rows from top to bottom

  const Pixel& at(unsigned x, unsigned y) const { return pixels[size_t{y} * width + x]; }
};

inline unsigned big_endian(const std::string& bytes, size_t at) {
  unsigned value = 0;
  for (size_t i = 0; i < 4; ++i) value = value << 8 | static_cast<unsigned char>(bytes[at + i]);
  return value;
}

// PNG stores each byte as the difference from the prediction by its neighbors [PNG, 9.2].
inline int predicted(int filter, int left, int above, int corner) {
  const int p = left + above - corner, a = std::abs(p - left), b = std::abs(p - above), c = std::abs(p - corner);
  const int paeth = a <= b && a <= c ? left : b <= c ? above : corner;
  return std::array{0, left, above, (left + above) / 2, paeth}.at(static_cast<size_t>(filter));
}

inline Image read_png(const std::filesystem::path& path) {
  const std::string bytes = read_file(path);
  if (!bytes.starts_with("\x89PNG\r\n\x1a\n") || bytes.substr(12, 4) != "IHDR") return {};
  Image image{big_endian(bytes, 16), big_endian(bytes, 20), {}};
  const size_t channels = bytes[25] == 6 ? 4 : 3;
  EXPECT_EQ(bytes[24], 8) << "bits per channel";
  EXPECT_EQ(bytes[28], 0) << "interlaced";
  std::string packed;
  for (size_t at = 8; at + 12 <= bytes.size(); at += 12 + big_endian(bytes, at))
    if (bytes.substr(at + 4, 4) == "IDAT") packed += bytes.substr(at + 8, big_endian(bytes, at));
  const size_t row = channels * image.width;
  std::vector<unsigned char> raw((row + 1) * image.height);
  uLongf size = raw.size();
  const auto* from = reinterpret_cast<const Bytef*>(packed.data());
  EXPECT_EQ(uncompress(raw.data(), &size, from, packed.size()), Z_OK);
  std::vector<int> above(row, 0), line(row, 0);
  for (size_t y = 0; y < image.height; ++y) {
    const unsigned char* stored = raw.data() + y * (row + 1);
    for (size_t i = 0; i < row; ++i) {
      const bool has_left = i >= channels;
      const int left = has_left ? line[i - channels] : 0, corner = has_left ? above[i - channels] : 0;
      line[i] = (stored[1 + i] + predicted(stored[0], left, above[i], corner)) & 255;
    }
    for (size_t i = 0; i < row; i += channels) image.pixels.push_back({line[i], line[i + 1], line[i + 2]});
    above = line;
  }
  return image;
}

}  // namespace aspic::cli
