// V(x) = k/2 |sum_i w_i x_i - target(t)|^2: a spring between a point of a tet and a hand that moves. Which point, and
// where the hand goes, may change between steps.
#pragma once
#include <array>

#include "energy/energy.h"
#include "mesh/tet_mesh.h"

namespace aspic {

struct Grab {
  Tet vertices{};                   // of one tet
  std::array<double, 4> weights{};  // sum to 1
  double stiffness = 0;             // k [N/m]; 0: nothing is grabbed
  // The target moves along a line from one place and time to another, and rests before and after. [m, s]
  Vec3d from{}, to{};
  double from_time = 0, to_time = 0;

  Vec3d target(double time) const;
  Vec3d point(Positions x) const;
};

class GrabSpring : public Energy {
 public:
  std::string_view name() const override { return "mouse"; }

  // At that time, until the next step begins.
  void set(const Grab& grab, double time);
  const Grab& grab() const { return grab_; }
  Vec3d force(Positions x) const;  // on the body [N]

  void begin_step(const StepContext& step) override { target_ = grab_.target(step.time); }
  double value(Positions x) const override;
  void add_gradient(Positions x, double scale, std::span<double> g) const override;
  void bind(const BlockPattern& pattern) override;
  int add_hessian(Positions x, double scale, const Projection& projection, BlockSparse& H) const override;
  bool prepare_vertex_systems(int) override { return true; }
  void add_vertex_systems(Positions x, double scale, std::span<const int> vertices, std::span<Vec3d> g,
                          std::span<Mat3d> H) const override;

 private:
  void find_slots();

  Grab grab_;
  Vec3d target_{};
  const BlockPattern* pattern_ = nullptr;
  std::array<std::array<int64_t, 4>, 4> slot_{};  // blocks (i, j), of the larger vertex and the smaller
};

}  // namespace aspic
