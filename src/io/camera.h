// Perspective camera of files for other programs.
#pragma once
#include <array>

#include "math/small.h"

namespace aspic {

struct Camera {
  Vec3d eye, right, up;  // right and up are orthonormal
  double slope;          // half the visible height per distance
  double nearest;        // distance below which nothing is drawn [m]

  // Rows that are the images of the axes x, y, z of the camera, which looks along -z, and of its origin.
  std::array<std::array<double, 4>, 4> matrix() const {
    const Vec3d back = cross(right, up);
    return {{{right[0], right[1], right[2], 0},
             {up[0], up[1], up[2], 0},
             {back[0], back[1], back[2], 0},
             {eye[0], eye[1], eye[2], 1}}};
  }
};

}  // namespace aspic
