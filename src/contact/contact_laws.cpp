#include "contact/contact_laws.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace aspic {
namespace {

constexpr double kStiffness = 1.0 / 10;  // relative to Young's modulus

// The finer surface has the larger share of the integral: its points sample the pressure between the points of the
// coarser one.
double share_of_finer(double own, double other) {
  if (std::isinf(other)) return 1;
  const double a = own * own * own, b = other * other * other;
  return a + b > 0 ? b / (a + b) : 0.5;
}

// A sphere may press on the middle of a triangle, and a capsule on the middle of an edge. Hence the pressure of a
// sphere is integrated over the triangles near its center, and the pressure of a capsule half over the body's points
// and half over its edges.
double share_over_points(const ContactPart& round) { return round.point_count == 1 ? 0 : 0.5; }

// The pressure of a rod is integrated half over the points of the rod and half over its edges, since surfaces may press
// on the middle of a segment. Two rods share the first half. Planes have no edges.
double share_beside_rod(const ContactPart& own, const ContactPart& other) {
  if (own.is_rod && other.is_rod) return 0.25;
  if (!own.is_rod) return 0;
  return other.point_count == 0 ? 1 : 0.5;
}

double share_of(const ContactPart& own, const ContactPart& other) {
  if (other.is_round) return share_over_points(other);
  if (own.is_round) return 1 - share_over_points(own);
  if (own.is_rod || other.is_rod) return share_beside_rod(own, other);
  return share_of_finer(own.mean_triangle, other.mean_triangle);
}

double smaller_young(const ContactPart& a, const ContactPart& b) {
  const double infinite = std::numeric_limits<double>::infinity();
  const double E = std::min(a.is_obstacle ? infinite : a.young, b.is_obstacle ? infinite : b.young);
  return std::isfinite(E) ? E : 0;
}

}  // namespace

ContactLaws::ContactLaws(const ContactMesh& mesh, const ContactOptions& options)
    : parts_(mesh.parts.size()), law_(parts_ * parts_) {
  for (size_t i = 0; i < parts_; ++i)
    for (size_t j = 0; j < parts_; ++j) {
      const ContactPart &a = mesh.parts[i], &b = mesh.parts[j];
      if (a.is_obstacle && b.is_obstacle) continue;
      const double edge = std::min(a.mean_edge, b.mean_edge);
      const double widest = options.reach_per_edge * edge, reach = options.reach > 0 ? options.reach : widest;
      const bool is_round = a.is_round || b.is_round || a.is_rod || b.is_rod;
      law_[i * parts_ + j] = {.reach = reach,
                              .edge_reach = is_round ? reach : kGuardReach * reach,
                              .stiffness = options.stiffness > 0 ? options.stiffness : kStiffness * smaller_young(a, b),
                              .share = i != j     ? share_of(a, b)
                                       : a.is_rod ? 0.25
                                                  : 0.5,
                              .friction = std::sqrt(a.friction * b.friction),
                              .offset = i == j ? a.self_offset : a.offset + b.offset,
                              .is_round = is_round,
                              .guard = i == j ? 0 : std::min(a.mean_triangle, b.mean_triangle),
                              .edge = edge,
                              .widest = widest,
                              .basis = options.reach > 0 ? ReachBasis::given : ReachBasis::edge,
                              .length = edge};
    }
  for (const auto& [parts, friction] : options.pairs)
    law_[parts[0] * parts_ + parts[1]].friction = law_[parts[1] * parts_ + parts[0]].friction = friction;
}

bool ContactLaws::has_friction() const {
  return std::any_of(law_.begin(), law_.end(), [](const ContactLaw& law) { return law.friction > 0; });
}

double ContactLaws::largest_reach() const {
  double largest = 0;
  for (const ContactLaw& law : law_) largest = std::max(largest, law.reach);
  return largest;
}

}  // namespace aspic
