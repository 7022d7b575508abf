// Pairs of a point and a triangle, or of two edges, that may come close while the points stay in given boxes.
#pragma once
#include <optional>
#include <span>
#include <vector>

#include "contact/contact_laws.h"
#include "contact/contact_mesh.h"
#include "mesh/close_pairs.h"

namespace aspic {

// Reach of the guards between two edges, and of points of the coarser surface, relative to that of their surfaces.
inline constexpr double kEdgeReach = 0.25;

struct EdgePair {
  int first, second;  // edges, first < second
  double reach;       // [m]
};

// Boxes around the paths of points: in space, and relative to the mean of the points of their part. Pairs within a part
// depend on the latter alone, so that bodies that move fast have few.
struct ContactRange {
  std::vector<Box> absolute, relative;
};

struct ContactCandidates {
  ContactRange range;                // the pairs are complete while each point stays in its boxes
  std::vector<int> triangle_start;   // of each point in `triangle`, and the end
  std::vector<int> triangle;         // near each point, ascending
  std::vector<EdgePair> edge_pairs;  // ascending

  bool cover(const ContactMesh& mesh, std::span<const Vec3d> points) const;
  std::span<const int> triangles_near(int point) const {
    return std::span(triangle).subspan(triangle_start[point], triangle_start[point + 1] - triangle_start[point]);
  }
};

// The positions, or displacements, relative to the mean of their part.
std::vector<Vec3d> relative_to_parts(const ContactMesh& mesh, std::span<const Vec3d> points);

class CandidateFinder {
 public:
  CandidateFinder(const ContactMesh& mesh, const ContactLaws& laws);  // both must outlive this
  // Finds all pairs whose gap can be below their reach. Returns nothing if they are more than the limit of PairQuery.
  std::optional<ContactCandidates> find(ContactRange range);

 private:
  bool add(const std::vector<Box>& boxes, bool within_parts, ClosePairs& all);
  double reach_of(const Edge& a, const Edge& b) const;

  const ContactMesh& mesh_;
  const ContactLaws& laws_;
  PairFinder finder_;
  std::vector<double> point_radius_, edge_radius_;
};

}  // namespace aspic
