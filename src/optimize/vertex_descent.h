// Vertex block descent [Chen et al. 2024]: Newton's method on one vertex after another, each with its 3x3 block of the
// Hessian, made definite. Vertices of one colour do not interact and move at the same time. The direction of an
// iteration is where some over-relaxed sweeps over the colours lead to.
#pragma once
#include <vector>

#include "optimize/model_step.h"
#include "optimize/search_direction.h"

namespace aspic {

class VertexDescent : public SearchDirection {
 public:
  std::string_view name() const override { return "vertex_descent"; }
  std::string description() const override;
  void begin() override;
  bool compute(Objective& E, std::span<const double> x, std::span<const double> g, const InnerAccuracy& accuracy,
               std::span<double> d, DirectionReport& report) override;
  bool retreat() override;  // one step of all the vertices at once: block Jacobi

 private:
  void color(Objective& E, std::span<const double> x, DirectionReport& report);
  void systems(Objective& E, std::span<const double> x, const std::vector<int>& vertices, DirectionReport& report);
  void move(Objective& E, const std::vector<int>& vertices, DirectionReport& report);
  void block_jacobi(Objective& E, std::span<const double> x, std::span<const double> g, std::span<double> d,
                    DirectionReport& report);

  std::vector<std::vector<int>> colors_;  // vertices that do not interact
  uint64_t colored_version_ = 0;          // of the pattern
  bool whole_ = false;                    // E offers no systems of single vertices
  ModelStep length_;
  bool cautious_next_ = false, cautious_ = false;  // block Jacobi at the next compute(), at the last one
  std::vector<double> y_, whole_gradient_;
  std::vector<Vec3d> g_;  // of the vertices of a colour
  std::vector<Mat3d> H_;
};

}  // namespace aspic
