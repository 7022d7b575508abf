// Pairs of a point and a triangle, or of two edges, that may come close while the points stay near given positions.
#pragma once
#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "contact/contact_laws.h"
#include "contact/contact_mesh.h"
#include "mesh/close_pairs.h"

namespace aspic {

// Gaps are measured at the time of the search [m].
struct NearTriangle {
  int point, triangle;
  double gap;

  bool operator<(const NearTriangle& other) const {
    return point != other.point ? point < other.point : triangle < other.triangle;
  }
};

struct EdgePair {
  int first, second;  // edges, first < second
  double gap;

  bool operator<(const EdgePair& other) const {
    return first != other.first ? first < other.first : second < other.second;
  }
};

struct ContactCandidates {
  std::vector<int> start;               // offset of each point in `triangles`, and the end
  std::vector<NearTriangle> triangles;  // ascending
  std::vector<EdgePair> edge_pairs;     // ascending

  std::span<const NearTriangle> near(int point) const {
    return std::span(triangles).subspan(start[point], start[point + 1] - start[point]);
  }
};

// Candidates for a path of all points, with its ends relative to the positions at the search. The points of a pair move
// together, so their relative displacement bounds the change of its gap. Between frames that differ by a rotation of
// angle a, the distance of points that are fixed to them shrinks at most by the factor cos(a / 2), which bounds the
// singular values of (1 - t) I + t R.
struct PathCandidates {
  std::shared_ptr<const ContactCandidates> pairs;
  std::vector<Vec3d> from, to;  // displacements of each point since the search [m]
  std::vector<double> shrink;   // cos(a / 2) of the part of each point

  // Return lower bounds of the gap along the path.
  double least_gap(const NearTriangle& near, const Triangle& t) const {
    const int p = near.point;
    return shrink[p] * near.gap - std::max({apart(p, t[0]), apart(p, t[1]), apart(p, t[2])});
  }
  double least_gap(const EdgePair& pair, const Edge& a, const Edge& b) const {
    return shrink[a[0]] * pair.gap -
           std::max({apart(a[0], b[0]), apart(a[0], b[1]), apart(a[1], b[0]), apart(a[1], b[1])});
  }

 private:
  double apart(int i, int j) const {
    return std::sqrt(std::max(squared_norm(from[i] - from[j]), squared_norm(to[i] - to[j])));
  }
};

// Returns the reach between two edges [m].
double edge_reach(const ContactMesh& mesh, const ContactLaws& laws, const EdgePair& pair);

enum class PairScope {
  within_parts,   // pairs of one body, in a frame that moves and rotates with it
  between_parts,  // pairs of different parts, at least one of which is a body
};

class CandidateSearch {
 public:
  CandidateSearch(PairScope scope, const ContactMesh& mesh, const ContactLaws& laws);  // both must outlive this

  // Returns all pairs whose gap can be below their reach on the lines from x to x + d, and some others; an empty d is
  // zero. Returns nothing if they exceed the limit of PairQuery. Results are cached for similar positions.
  std::optional<PathCandidates> along(std::span<const Vec3d> x, std::span<const Vec3d> d);

 private:
  struct Path {
    std::vector<Vec3d> from, to;
    std::vector<double> shrink;  // per point
  };
  // The primitives of a part: their first indices in the mesh, and trees over them.
  struct Surface {
    int first_edge = 0, first_triangle = 0;
    PairFinder finder;
  };
  class Near;

  Path path(std::span<const Vec3d> x, std::span<const Vec3d> d) const;
  double least_shrink() const;
  double twist() const;
  bool mark_new(std::span<const Vec3d> x);
  bool covers(const Path& path);
  void surround(const Path& path);
  SweptBox bounds_of(int part, double radius) const;
  bool find_pairs(ClosePairs& all);
  bool is_kept(const NearTriangle& pair) const;
  bool is_kept(const EdgePair& pair) const;
  std::shared_ptr<const ContactCandidates> find();

  PairScope scope_;
  const ContactMesh& mesh_;
  const ContactLaws& laws_;
  std::vector<double> margin_;  // least distance of each point from the paths that its candidates cover [m]
  std::vector<Surface> surfaces_;
  // The candidates are complete while there is a t in [0, 1] such that all points are within by_ of start_ + t move_.
  std::vector<Vec3d> start_, move_;
  std::vector<double> by_;
  std::vector<char> is_new_;  // points whose pairs are searched for next
  std::shared_ptr<const ContactCandidates> candidates_;
};

}  // namespace aspic
