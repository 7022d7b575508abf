// Meshing of domains with a label at each point: images and implicit shapes.
#pragma once
#include <CGAL/Labeled_mesh_domain_3.h>

#include <string>

#include "mesh/disjoint_sets.h"
#include "mesh3.h"

namespace aspic {

using LabeledDomain = CGAL::Labeled_mesh_domain_3<Kernel>;

// Accuracy of intersections with the surface, relative to the bounding box.
inline constexpr double kSurfaceTolerance = 1e-5;

// Labels at the centers of a grid of cells over the bounding box, the crossings between neighbors of different labels,
// and points on the surface of every connected component that the grid resolves.
class LabelGrid {
 public:
  LabelGrid(const LabeledDomain& domain, const CGAL::Bbox_3& box, double spacing) : domain_(domain), box_(box) {
    constexpr double kMin = 16, kMax = 96;  // cells per axis
    for (int axis = 0; axis < 3; ++axis)
      cells_[axis] = static_cast<int>(std::clamp((box.max(axis) - box.min(axis)) / spacing, kMin, kMax));
    labels_.resize(static_cast<size_t>(cells_[0]) * cells_[1] * cells_[2]);
    for (int i = 0; i < static_cast<int>(labels_.size()); ++i) labels_[i] = label(center(i));
  }

  bool has(int wanted) const { return std::find(labels_.begin(), labels_.end(), wanted) != labels_.end(); }
  bool is_empty() const {
    return std::all_of(labels_.begin(), labels_.end(), [](int label) { return label == 0; });
  }

  double box_volume() const { return box_.x_span() * box_.y_span() * box_.z_span(); }

  Seeds<LabeledDomain> seeds() const {
    Seeds<LabeledDomain> seeds;
    for (const auto& [component, crossings] : crossings_of_components()) {
      constexpr size_t kSeedsPerComponent = 20;
      const size_t count = std::min(kSeedsPerComponent, crossings.size());
      for (size_t i = 0; i < count; ++i) {
        const auto& [from, to] = crossings[i * crossings.size() / count];
        const auto hit = domain_.construct_intersection_object()(Kernel::Segment_3(center(from), center(to)));
        if (std::get<2>(hit) == 2) seeds.emplace_back(std::get<0>(hit), std::get<1>(hit));
      }
    }
    return seeds;
  }

 private:
  using Crossings = std::vector<std::pair<int, int>>;

  std::map<int, Crossings> crossings_of_components() const {
    DisjointSets sets(static_cast<int>(labels_.size()));
    Crossings all;
    for_each_neighbors([&](int a, int b) {
      if (labels_[a] == labels_[b])
        sets.join(a, b);
      else
        all.emplace_back(a, b);
    });
    std::map<int, Crossings> crossings;
    for (const auto& [a, b] : all)
      for (int side : {a, b})
        if (labels_[side] != 0) crossings[sets.find(side)].emplace_back(a, b);
    return crossings;
  }

  template <class Visit>
  void for_each_neighbors(Visit visit) const {
    const std::array<int, 3> stride = {1, cells_[0], cells_[0] * cells_[1]};
    for (int i = 0; i < static_cast<int>(labels_.size()); ++i)
      for (int axis = 0; axis < 3; ++axis)
        if (i / stride[axis] % cells_[axis] + 1 < cells_[axis]) visit(i, i + stride[axis]);
  }

  Point center(int i) const {
    const std::array<int, 3> cell = {i % cells_[0], i / cells_[0] % cells_[1], i / cells_[0] / cells_[1]};
    double x[3];
    for (int axis = 0; axis < 3; ++axis)
      x[axis] = box_.min(axis) + (cell[axis] + 0.5) * (box_.max(axis) - box_.min(axis)) / cells_[axis];
    return Point(x[0], x[1], x[2]);
  }

  int label(const Point& x) const {
    const auto subdomain = domain_.is_in_domain_object()(x);
    return subdomain ? static_cast<int>(*subdomain) : 0;
  }

  const LabeledDomain& domain_;
  CGAL::Bbox_3 box_;
  std::array<int, 3> cells_;
  std::vector<int> labels_;
};

// Defined in labeled.cpp for images and implicit shapes. `name`: the object in messages.
TetMesh mesh_labeled(const std::string& name, const LabeledDomain& domain, const LabelGrid& grid,
                     const MesherOptions& options);

}  // namespace aspic
