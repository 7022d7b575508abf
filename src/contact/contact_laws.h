// Contact parameters for pairs of parts.
#pragma once
#include <array>
#include <set>
#include <vector>

#include "contact/contact_mesh.h"

namespace aspic {

// Reach of the guards between two edges, and of points of the coarser surface, relative to the reach of their surfaces.
inline constexpr double kGuardReach = 0.25;

// Default reach relative to the mean edge of the finer surface. Sliding surfaces need fewer iterations with a larger
// one; in statics, where bodies are pressed, gaps change forces.
inline constexpr double kReachPerEdge = 1.0 / 10, kStaticReachPerEdge = 1.0 / 50;

// What a reach is derived from: contact.reach, the mean edge, the gap at the start, or the thickness of a part.
// `touching`: the mean edge, for surfaces that touch at the start.
enum class ReachBasis { given, edge, gap, touching, thickness };

struct ContactLaw {
  double reach = 0;       // gap at which contact begins [m]
  double edge_reach = 0;  // reach of two edges [m]
  double stiffness = 0;   // kappa [Pa]
  double share = 0;       // weight of the integral over the first surface; the second one has the rest
  double friction = 0;    // coefficient
  double offset = 0;      // gaps are distances minus this [m]
  bool is_round = false;  // one part is a capsule, a sphere or a rod
  double guard = 0;       // minimum area of a point within the guards' reach [m^2]
  double edge = 0;        // mean edge of the finer surface [m]
  double widest = 0;      // default reach of parts that are thick and far apart [m]
  ReachBasis basis = ReachBasis::given;
  double length = 0;  // edge, gap or thickness of which the reach is a fraction [m]
};

struct PairFriction {
  std::array<int, 2> parts;
  double friction;  // coefficient
};

struct ContactOptions {
  double reach = 0;      // [m]; 0: see bound_reaches()
  double stiffness = 0;  // [Pa]; 0: a tenth of the smaller Young's modulus
  // Pairs with a coefficient other than the geometric mean of those of the parts.
  std::vector<PairFriction> pairs = {};
  std::vector<double> start = {};                 // 3 per vertex of the model, at the start [m]; empty: at rest
  std::set<std::array<int, 2>> overlapping = {};  // pairs of parts (ascending) that overlap at the start
  double reach_per_edge = kReachPerEdge;          // if `reach` is 0
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
