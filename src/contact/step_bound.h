// The largest step along a line on which no surfaces touch, and the pairs that bound it.
#pragma once
#include <optional>
#include <span>
#include <vector>

#include "contact/stencil_search.h"
#include "mesh/ccd.h"

namespace aspic {

// A pair that reaches its landing gap along a line. After a displacement of its points by u_i, its gap is about n . sum
// c_i (x_i + u_i) - offset.
struct Impact {
  std::array<int, 4> point = {-1, -1, -1, -1};  // indices in the ContactMesh
  Distance distance;                            // at the landing
  double offset = 0;                            // n . origin of a plane [m]
  double landing = 0;                           // landing gap [m]
  double stiffness = 0;                         // stiffness of a spring that keeps the gap [N/m]
};

class StepBound {
 public:
  // `sizes`: sizes of the parts at rest [m]. All arguments must outlive this.
  StepBound(const ContactMesh& mesh, const ContactLaws& laws, const StencilSearch& search,
            std::span<const double> sizes)
      : mesh_(mesh), laws_(laws), search_(search), sizes_(sizes) {}

  // Returns a step of at most 1 from the positions p of all points along u.
  double largest(std::span<const Vec3d> p, std::vector<Vec3d> u) const;
  // Returns the first impact of each point, and the edge pairs that are the first impact of both edges: with obstacles
  // and between parts, or if there are none, within parts.
  std::vector<Impact> impacts(std::span<const Vec3d> p, std::vector<Vec3d> u) const;

 private:
  // A line from p to p + u and the candidates along it.
  struct Line {
    std::span<const Vec3d> p, u;
    PathCandidates candidates;
  };
  double longest(std::span<const Vec3d> u) const;
  double among(PairScope scope, std::span<const Vec3d> p, std::vector<Vec3d>& u) const;
  double to_planes(std::span<const Vec3d> p, std::span<const Vec3d> u, int i, double step) const;
  static MovingPair pair(const Line& line, PairKind kind, const std::array<int, 4>& point);
  double step_of(const MovingPair& pair, const StepRule& rule) const;
  double to_triangle(const Line& line, int i, const NearTriangle& near, double step) const;
  double of_edges(const Line& line, const EdgePair& edges, double step) const;
  std::vector<Impact> with_planes(std::span<const Vec3d> p, std::span<const Vec3d> u) const;
  std::optional<Line> line(PairScope scope, std::span<const Vec3d> p, std::vector<Vec3d>& u, double& factor) const;
  Impact impact(const MovingPair& pair, const std::array<int, 4>& point, double alpha) const;
  void add_point_impacts(const Line& line, std::vector<Impact>& found) const;
  void add_edge_impacts(const Line& line, std::vector<Impact>& found) const;

  const ContactMesh& mesh_;
  const ContactLaws& laws_;
  const StencilSearch& search_;
  std::span<const double> sizes_;
};

}  // namespace aspic
