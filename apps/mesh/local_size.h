// Target edge lengths from the local thickness of a body, so that thin parts keep their volume.
#pragma once
#include <string>
#include <vector>

#include "mesh/box_tree.h"
#include "mesh/tet_mesh.h"

namespace aspic {

// Surface point with the depth of material and of empty space along its normal.
struct SurfaceSample {
  Vec3d x{};
  double area = 0;
  double thickness = Box::kInfinity;  // distance to the opposite side of the body
  double gap = Box::kInfinity;        // distance to the next part of the same body
};

// Sides between which thickness is measured: opposite ones, or any. The latter also detects the tip of a three-sided
// needle, but also the edges of every block.
enum class Sides { opposite, any };

// Samples at a distance of about `spacing`, at least one per triangle up to a limit. `body` is oriented outward.
std::vector<SurfaceSample> surface_samples(const TriMesh& body, double spacing, Sides sides);

// Rule for edge lengths: thickness / tets_across, between `smallest` and `size`.
struct SizeRule {
  double size = 0;
  double tets_across = 2;
  double smallest = 0;
};

// Predicted number of tets with this edge length, and with smaller ones in thin parts.
double predicted_tets(const std::vector<SurfaceSample>& samples, double volume, const SizeRule& rule);

struct ThinParts {
  SizeRule rule;
  double tets = 0;       // predicted number
  std::string problem;   // reason why no rule keeps the thin parts; empty if one does
  double thickness = 0;  // thickness of the thinnest parts
};

// Chooses two tets across thin parts if that needs at most `most_tets`, otherwise fewer, but at least one.
ThinParts choose_rule(const std::vector<SurfaceSample>& samples, double volume, double size, double most_tets);

// Edge length at a point: the minimum over all thin samples, growing with the distance from them.
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
