// Springs between vertices and points of elements, which join bodies: seams, a cape on a jacket.
#pragma once
#include <array>
#include <vector>

#include "energy/energy.h"

namespace aspic {

// Spring between a vertex and the point sum w_i x_i of an element that does not have the vertex.
struct AttachedVertex {
  int vertex = 0;
  int count = 0;                   // 1 to 4 vertices of the element
  std::array<int, 4> target{};     // distinct; the first `count` are used
  std::array<double, 4> weight{};  // w, sum to 1
  double stiffness = 0;            // k [N/m]: V = k/2 (|d| - l0)^2, d = x_vertex - sum w_i x_i
  double rest_length = 0;          // l0 [m]; 0: V = k/2 |d|^2

  Vec3d separation(Positions x) const;  // d [m]
};

// The sum of V over attached vertices. Forces and torques of each of them sum to zero.
class Attachment : public SteadyEnergy {
 public:
  explicit Attachment(std::vector<AttachedVertex> attached);

  std::string_view name() const override { return "attachment"; }
  const std::vector<AttachedVertex>& attached() const { return attached_; }
  double largest_gap(Positions x) const;  // maximum of ||d| - l0| [m]

  void add_couplings(Couplings& couplings) const override;
  void bind(const BlockPattern& pattern) override;

  using SteadyEnergy::add_gradient, SteadyEnergy::add_hessian, SteadyEnergy::value;
  double value(Positions x, const Context&) const override;
  void add_gradient(Positions x, const Context&, double scale, std::span<double> g) const override;
  int add_hessian(Positions x, const Context&, double scale, const Projection& projection,
                  BlockSparse& H) const override;

 private:
  std::vector<AttachedVertex> attached_;
  std::vector<std::array<int64_t, 15>> slot_;  // blocks (i, j), j <= i, of the vertex and the targets
};

}  // namespace aspic
