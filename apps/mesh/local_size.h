// Target edge lengths that follow the local thickness of a body, so that thin parts keep their volume.
#pragma once
#include <string>
#include <vector>

#include "mesh/box_tree.h"
#include "mesh/tet_mesh.h"

namespace aspic {

// A point of a surface, and how far the material and the space around it reach along its normal.
struct SurfaceSample {
  Vec3d x{};
  double area = 0;
  double thickness = Box::kInfinity;  // to the opposite side of the body
  double gap = Box::kInfinity;        // to the next part of the same body
};

// The sides between which thickness is measured: opposite ones, or any, which finds the tip of a three-sided needle
// thin, but also the edges of every block.
enum class Sides { opposite, any };

// Samples at a distance of about `spacing`, at least one per triangle up to a limit. `body` faces outwards.
std::vector<SurfaceSample> surface_samples(const TriMesh& body, double spacing, Sides sides);

// How edge lengths follow from thickness: thickness / tets_across, between `smallest` and `size`.
struct SizeRule {
  double size = 0;
  double tets_across = 2;
  double smallest = 0;
};

// Number of tets of this edge length, with smaller ones in thin parts.
double predicted_tets(const std::vector<SurfaceSample>& samples, double volume, const SizeRule& rule);

struct ThinParts {
  SizeRule rule;
  double tets = 0;       // predicted
  std::string problem;   // why no rule keeps the thin parts; empty when one does
  double thickness = 0;  // of the thinnest parts
};

// Two tets across the thin parts where that takes at most `most_tets`, else fewer, at least one.
ThinParts choose_rule(const std::vector<SurfaceSample>& samples, double volume, double size, double most_tets);

// The edge length at a point: the smallest over all thin samples, growing with the distance from them.
class LocalSize {
 public:
  LocalSize(const std::vector<SurfaceSample>& samples, const SizeRule& rule);
  double operator()(const Vec3d& x) const;
  double least() const { return least_; }

 private:
  SizeRule rule_;
  std::vector<Vec3d> points_;
  std::vector<double> sizes_;
  double least_;
  BoxTree tree_;
};

}  // namespace aspic
