// Contact parameters for pairs of parts.
#pragma once
#include <array>
#include <vector>

#include "contact/contact_mesh.h"

namespace aspic {

// Reach of the guards between two edges, and of points of the coarser surface, relative to the reach of their surfaces.
inline constexpr double kGuardReach = 0.25;

struct ContactLaw {
  double reach = 0;       // gap at which contact begins [m]
  double edge_reach = 0;  // reach of two edges [m]
  double stiffness = 0;   // kappa [Pa]
  double share = 0;       // weight of the integral over the first surface; the second one has the rest
  double friction = 0;    // coefficient
  double radius = 0;      // radius of a capsule [m]; gaps are distances minus this
  double guard = 0;       // minimum area of a point within the guards' reach [m^2]
};

struct PairFriction {
  std::array<int, 2> parts;
  double friction;  // coefficient
};

struct ContactOptions {
  double reach = 0;      // [m]; 0: a fiftieth of the mean edge of the finer surface
  double stiffness = 0;  // [Pa]; 0: a tenth of the smaller Young's modulus
  // Pairs with a coefficient other than the geometric mean of those of the parts.
  std::vector<PairFriction> pairs = {};
};

// Parameters of all pairs of parts, for points of the first part near the second one.
class ContactLaws {
 public:
  ContactLaws() = default;
  ContactLaws(const ContactMesh& mesh, const ContactOptions& options);
  const ContactLaw& operator()(int first, int second) const { return law_[first * parts_ + second]; }
  ContactLaw& operator()(int first, int second) { return law_[first * parts_ + second]; }
  double largest_reach() const;
  bool has_friction() const;

 private:
  size_t parts_ = 0;
  std::vector<ContactLaw> law_;
};

}  // namespace aspic
