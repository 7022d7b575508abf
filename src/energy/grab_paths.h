// Springs of a hand along paths that are known beforehand: what a drag in the viewer was, as a part of a scene. Each
// spring acts from the first time of its path to the last one, and is absent before and after.
#pragma once
#include <vector>

#include "energy/grab_spring.h"

namespace aspic {

struct PathPoint {
  double time = 0;   // [s]
  Vec3d position{};  // of the spring's end [m]
};

struct GrabPath {
  Grab grab;                    // its vertices, weights and stiffness
  std::vector<PathPoint> path;  // at least two points; each later than the one before
};

class GrabPaths : public Energy {
 public:
  explicit GrabPaths(std::vector<GrabPath> paths) : paths_(std::move(paths)), springs_(paths_.size()) {}

  std::string_view name() const override { return "grab"; }

  void begin_step(const StepContext& step) override;
  double value(Positions x) const override;
  void add_gradient(Positions x, double scale, std::span<double> g) const override;
  void bind(const BlockPattern& pattern) override;
  int add_hessian(Positions x, double scale, const Projection& projection, BlockSparse& H) const override;
  bool prepare_vertex_systems(int) override { return true; }
  void add_vertex_systems(Positions x, double scale, std::span<const int> vertices, std::span<Vec3d> g,
                          std::span<Mat3d> H) const override;

 private:
  std::vector<GrabPath> paths_;
  std::vector<GrabSpring> springs_;  // one per path, as it acts now
};

}  // namespace aspic
