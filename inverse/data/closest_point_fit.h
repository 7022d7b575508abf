// One run of iterative closest points from an initial guess.
#pragma once
#include <array>
#include <span>
#include <vector>

#include "data/surface_projection.h"
#include "scene/placement.h"

namespace aspic {

struct PoseFit {
  AffineMap map;
  double rms = 0, largest = 0;      // distances from the surface [m]
  std::array<double, 49> normal{};  // mean of J'J of the distances along the normals, by motion()
};

class ClosestPointFit {
 public:
  // Stores references. `center` and `length`: of the moved points [m], the origin and unit of motions.
  ClosestPointFit(const SurfaceProjection& surface, std::span<const Vec3d> points, bool scales)
      : surface_(surface), points_(points), scales_(scales) {}

  // Gauss-Newton steps with damping until the pose is stationary. The scale stays within a factor of 2 of the guess.
  PoseFit run(const AffineMap& guess, int iterations) const;
  bool is_scale_at_bound(const AffineMap& guess, const AffineMap& found) const;

  // Motion of a point x by the k-th of 7 unit motions about the center: 3 translations, 3 rotations, 1 dilation. All
  // move points at the distance `length` equally far.
  static Vec3d motion(int k, const Vec3d& from_center, double length);

 private:
  struct System {
    std::array<double, 49> A{}, normal{};
    std::array<double, 7> b{};
    double squares = 0, largest = 0;
  };
  System system(const AffineMap& map, const Vec3d& center, double length) const;
  AffineMap moved(const AffineMap& map, const std::array<double, 7>& step, const Vec3d& center, double length) const;

  const SurfaceProjection& surface_;
  std::span<const Vec3d> points_;
  bool scales_;
};

}  // namespace aspic
