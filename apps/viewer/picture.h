// Geometry and pictures as the binary messages of web/src/protocol.ts.
#pragma once
#include <cstdint>
#include <string>

#include "viewer/fields.h"

namespace aspic::viewer {

struct Stamp {
  int side = 0;  // 0: a, 1: b
  uint32_t generation = 0;
};

std::string encode_geometry(const Stamp& stamp, const Surface& surface, const Numbering& numbering);

struct PictureOptions {
  int step = 0;
  int iteration = -1;  // -1: the end of a step
  double time = 0;     // [s]
  std::string field;   // empty: none
};

class PictureEncoder {
 public:
  // Allocates only the message if a surface of this size was encoded before.
  std::string encode(const Stamp& stamp, const PictureOptions& options, const View& view, const Surface& surface);

 private:
  std::vector<Vec3d> position_, normal_;
  std::vector<float> value_;
  FieldValues fields_;
};

}  // namespace aspic::viewer
