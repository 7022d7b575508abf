// V(x) = k/2 |sum_i w_i x_i - target(t)|^2: a spring between a point of a tet and a moving target. Both may change
// between steps.
#pragma once
#include <array>

#include "energy/energy.h"
#include "mesh/tet_mesh.h"

namespace aspic {

struct Grab {
  Tet vertices{};                   // vertices of the tet
  std::array<double, 4> weights{};  // sum to 1
  double stiffness = 0;             // k [N/m]; 0: inactive
  // The target moves linearly from `from` to `to` and is at rest before and after. [m, s]
  Vec3d from{}, to{};
  double from_time = 0, to_time = 0;

  Vec3d target(double time) const;
  Vec3d point(Positions x) const;
  double value(Positions x, const Vec3d& target) const;
  void add_gradient(Positions x, const Vec3d& target, double scale, std::span<double> g) const;
};

// Slots of the 3x3 blocks of a grab.
class GrabBlocks {
 public:
  GrabBlocks() = default;
  GrabBlocks(const Grab& grab, const BlockPattern& pattern);
  void add_hessian(const Grab& grab, double scale, BlockSparse& H) const;

 private:
  std::array<std::array<int64_t, 4>, 4> slot_{};  // blocks (i, j) of the larger and the smaller vertex
};

class GrabSpring : public Energy {
 public:
  std::string_view name() const override { return "mouse"; }

  void set(const Grab& grab);
  const Grab& grab() const { return grab_; }

  double value(Positions x, const Context& context) const override;
  void add_gradient(Positions x, const Context& context, double scale, std::span<double> g) const override;
  void bind(const BlockPattern& pattern) override;
  int add_hessian(Positions x, const Context& context, double scale, const Projection& projection,
                  BlockSparse& H) const override;

 private:
  Grab grab_;
  const BlockPattern* pattern_ = nullptr;
  GrabBlocks blocks_;
};

}  // namespace aspic
