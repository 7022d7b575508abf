// Springs whose targets move along given paths, such as recorded drags of the viewer. Each spring acts from the first
// to the last time of its path.
#pragma once
#include <vector>

#include "energy/grab_spring.h"

namespace aspic {

struct PathPoint {
  double time = 0;   // [s]
  Vec3d position{};  // position of the target [m]
};

struct GrabPath {
  Grab grab;                    // vertices, weights and stiffness
  std::vector<PathPoint> path;  // at least two points, with ascending times
};

class GrabPaths : public Energy {
 public:
  explicit GrabPaths(std::vector<GrabPath> paths) : paths_(std::move(paths)) {}

  std::string_view name() const override { return "grab"; }

  double value(Positions x, const Context& context) const override;
  void add_gradient(Positions x, const Context& context, double scale, std::span<double> g) const override;
  void bind(const BlockPattern& pattern) override;
  int add_hessian(Positions x, const Context& context, double scale, const Projection& projection,
                  BlockSparse& H) const override;

 private:
  std::vector<GrabPath> paths_;
  std::vector<GrabBlocks> blocks_;  // blocks of each path
};

}  // namespace aspic
