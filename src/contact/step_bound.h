// The largest step along a line on which no surfaces touch.
#pragma once
#include <span>
#include <vector>

#include "contact/stencil_search.h"

namespace aspic {

class StepBound {
 public:
  // `sizes`: of the parts at rest [m]. All arguments must outlive this.
  StepBound(const ContactMesh& mesh, const ContactLaws& laws, const StencilSearch& search,
            std::span<const double> sizes)
      : mesh_(mesh), laws_(laws), search_(search), sizes_(sizes) {}

  // Returns a step of at most 1 from the positions p of all points along u.
  double largest(std::span<const Vec3d> p, std::vector<Vec3d> u) const;

 private:
  // A line from p to p + u and the candidates along it.
  struct Line {
    std::span<const Vec3d> p, u;
    PathCandidates candidates;
  };
  double longest(std::span<const Vec3d> u) const;
  double among(PairScope scope, std::span<const Vec3d> p, std::vector<Vec3d>& u) const;
  double to_planes(std::span<const Vec3d> p, std::span<const Vec3d> u, int i, double step) const;
  double to_triangles(const Line& line, int i, double step) const;
  double of_edges(const Line& line, int pair, double step) const;

  const ContactMesh& mesh_;
  const ContactLaws& laws_;
  const StencilSearch& search_;
  std::span<const double> sizes_;
};

}  // namespace aspic
