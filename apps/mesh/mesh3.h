// What the three kinds of domain share: criteria from sizes, refinement, optimisation, and the way back to a TetMesh.
#pragma once
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Mesh_complex_3_in_triangulation_3.h>
#include <CGAL/Mesh_criteria_3.h>
#include <CGAL/Mesh_triangulation_3.h>
#include <CGAL/Random.h>
#include <CGAL/make_mesh_3.h>

#include <algorithm>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "base/error.h"
#include "mesher.h"

namespace aspic {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;

// Mesh_3 bounds circumradii. A regular tet of edge e has circumradius 0.61 e, its faces 0.58 e, and refinement leaves
// radii well below their bound: with the bound at this multiple of the wanted edge the mean edge comes out near it.
inline constexpr double kRadiusPerEdge = 0.75;
// Distance between the facets and the surface, relative to the bound of the facets' radii.
inline constexpr double kDistancePerRadius = 0.15;
inline constexpr double kSliverBound = 12;  // [degrees] smallest dihedral angle that the optimisers aim for

// A size given in other units than the input would never end.
inline void check_size(const CGAL::Bbox_3& box, double size) {
  constexpr double kMostCells = 1e9;  // cubes of that size in the bounding box
  const double cells = (box.x_span() / size + 1) * (box.y_span() / size + 1) * (box.z_span() / size + 1);
  if (cells > kMostCells)
    throw InvalidInput("--size " + std::to_string(size) + ": too fine for a shape " +
                       std::to_string(std::max({box.x_span(), box.y_span(), box.z_span()})) +
                       " long; it is in the units of the input, give a larger one");
}

// Bound of the radii at a point, from the region it is in or, on a surface, the finer of the two regions it separates.
template <class Domain>
class RadiusField {
 public:
  using FT = Kernel::FT;
  using Point_3 = Point;
  using Index = typename Domain::Index;

  RadiusField(const Domain& domain, double size, const std::map<int, double>& region_size, double factor)
      : domain_(&domain), size_(size), region_size_(&region_size), factor_(factor) {}

  template <class AnyPoint>
  FT operator()(const AnyPoint&, int dimension, const Index& index) const {
    if (region_size_->empty()) return factor_ * size_;
    if (dimension == 3) return factor_ * region(static_cast<int>(domain_->subdomain_index(index)));
    const auto patch = domain_->surface_patch_index(index);
    return factor_ * std::min(region(static_cast<int>(patch.first)), region(static_cast<int>(patch.second)));
  }

 private:
  double region(int label) const {
    const auto found = region_size_->find(label);
    return found == region_size_->end() ? size_ : found->second;
  }

  const Domain* domain_;
  double size_;
  const std::map<int, double>* region_size_;
  double factor_;
};

// Points that the refinement starts from, given rather than shot at random, so that no component is missed.
template <class Domain>
class SeededDomain : public Domain {
 public:
  using Domain::Domain;
  using Seeds = std::vector<std::pair<Point, typename Domain::Index>>;

  explicit SeededDomain(const Domain& domain) : Domain(domain) {}

  void set_seeds(Seeds seeds) { seeds_ = std::move(seeds); }

  struct Construct_initial_points {
    const Seeds* seeds;
    template <class Output>
    Output operator()(Output output, int = 0) const {
      return std::copy(seeds->begin(), seeds->end(), output);
    }
  };
  Construct_initial_points construct_initial_points_object() const { return {&seeds_}; }

 private:
  Seeds seeds_;
};

template <class Complex>
TetMesh to_tet_mesh(const Complex& complex) {
  TetMesh mesh;
  std::unordered_map<const void*, int> number;  // looked up only, never walked through
  for (auto cell = complex.cells_in_complex_begin(); cell != complex.cells_in_complex_end(); ++cell) {
    Tet tet;
    for (int corner = 0; corner < 4; ++corner) {
      const auto vertex = cell->vertex(corner);
      const auto [place, is_new] = number.try_emplace(&*vertex, mesh.vertex_count());
      if (is_new) mesh.rest.push_back({{vertex->point().x(), vertex->point().y(), vertex->point().z()}});
      tet[corner] = place->second;
    }
    mesh.tets.push_back(tet);
    mesh.region.push_back(static_cast<int>(complex.subdomain_index(cell)));
  }
  return mesh;
}

// Every optimiser runs until it has converged, not until a clock says so: that is what makes the output reproducible.
template <class Domain>
TetMesh filled(const Domain& domain, double size, const MesherOptions& options) {
  namespace p = CGAL::parameters;
  using Triangulation = typename CGAL::Mesh_triangulation_3<Domain, Kernel>::type;
  using Complex = CGAL::Mesh_complex_3_in_triangulation_3<Triangulation>;
  using Criteria = CGAL::Mesh_criteria_3<Triangulation>;
  using Field = RadiusField<Domain>;
  CGAL::get_default_random() = CGAL::Random(0);
  const Field radius(domain, size, options.region_size, kRadiusPerEdge);
  const Field distance(domain, size, options.region_size, kRadiusPerEdge * kDistancePerRadius);
  const Criteria criteria(p::facet_angle = 25, p::facet_size = radius, p::facet_distance = distance,
                          p::cell_radius_edge_ratio = 2.2, p::cell_size = radius);
  auto complex = CGAL::make_mesh_3<Complex>(domain, criteria, p::odt(p::time_limit = 0, p::max_iteration_number = 100),
                                            p::perturb(p::time_limit = 0, p::sliver_bound = kSliverBound),
                                            p::exude(p::time_limit = 0, p::sliver_bound = kSliverBound));
  TetMesh mesh = to_tet_mesh(complex);
  if (mesh.tets.empty()) throw InvalidInput("no tet fits into the shape; give a smaller --size");
  return mesh;
}

}  // namespace aspic
