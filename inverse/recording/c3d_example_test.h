// Builds C3D files word by word, for tests.
#pragma once
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

namespace aspic {

// A file of an Intel processor with two points, "A" and "B", and two frames at 50 Hz, in mm. B is not seen in the
// second.
struct C3dExample {
  float scale = -1;  // negative: floating-point points
  int points = 2, first = 1, last = 2, data_block = 3;
  char processor = 84;
  std::string labels = "A   B   ";
  std::string further;  // parameters behind the labels

  std::string bytes() const {
    std::string file = head();
    file += section();
    file.resize(1024, '\0');
    for (int frame = 0; frame < 2; ++frame)
      for (int point = 0; point < 2; ++point) add_point(file, frame, point);
    return file;
  }

  static void add16(std::string& to, int value) {
    to += static_cast<char>(value & 0xff);
    to += static_cast<char>(value >> 8 & 0xff);
  }
  static void add_real(std::string& to, float value) {
    uint32_t bits;
    std::memcpy(&bits, &value, sizeof bits);
    add16(to, static_cast<int>(bits & 0xffff));
    add16(to, static_cast<int>(bits >> 16));
  }
  static std::string parameter(const std::string& name, int type, const std::string& sizes, const std::string& data) {
    std::string entry;
    entry += static_cast<char>(name.size());
    entry += '\1';
    entry += name;
    add16(entry, static_cast<int>(5 + sizes.size() + data.size()));
    entry += static_cast<char>(type);
    entry += static_cast<char>(sizes.size());
    return entry + sizes + data + '\0';
  }

 private:
  std::string head() const {
    std::string file = "\x02\x50";
    for (const int word : {points, 0, first, last, 0}) add16(file, word);
    add_real(file, scale);
    add16(file, data_block);
    add16(file, 0);
    add_real(file, 50);
    file.resize(512, '\0');
    return file;
  }

  std::string section() const {
    std::string entries("\x01\x50\x01", 3);
    entries += processor;
    entries += std::string("\x05\xffPOINT\x03\x00\x00", 10);
    entries += parameter("LABELS", -1, "\x04\x02", labels);
    entries += parameter("UNITS", -1, "\x02", "mm");
    return entries + further;
  }

  void add_point(std::string& file, int frame, int point) const {
    const bool is_hidden = frame == 1 && point == 1;
    const int p[3] = {10 * point + frame, 20, -30};
    for (const int x : p) scale < 0 ? add_real(file, static_cast<float>(x)) : add16(file, x);
    scale < 0 ? add_real(file, is_hidden ? -1.0F : 1.0F) : add16(file, is_hidden ? -1 : 1);
  }
};

}  // namespace aspic
