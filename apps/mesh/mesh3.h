// Shared by the three kinds of domain: criteria from sizes, refinement, optimization, conversion to a TetMesh.
#pragma once
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Mesh_3/sliver_criteria.h>
#include <CGAL/Mesh_complex_3_in_triangulation_3.h>
#include <CGAL/Mesh_criteria_3.h>
#include <CGAL/Mesh_triangulation_3.h>
#include <CGAL/Random.h>
#include <CGAL/exceptions.h>
#include <CGAL/exude_mesh_3.h>
#include <CGAL/make_mesh_3.h>
#include <CGAL/odt_optimize_mesh_3.h>
#include <CGAL/perturb_mesh_3.h>

#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <utility>
#include <vector>

#include "base/error.h"
#include "mesher.h"

namespace aspic {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;

// Mesh_3 bounds circumradii. A regular tet of edge e has circumradius 0.61 e, its faces 0.58 e, and refinement leaves
// radii well below their bound. With this factor the mean edge is close to the target.
inline constexpr double kRadiusPerEdge = 0.75;
// Bound of the distance between facets and surface, relative to the bound of the facets' radii.
inline constexpr double kDistancePerRadius = 0.15;
// Largest diameter of the balls around sharp edges.
inline constexpr double kProtectedPerEdge = 1;
inline constexpr double kSliverBound = 12;  // [degrees] smallest dihedral angle that the optimizers aim for

// Given initial points of the refinement instead of random ones, so that no component is missed.
template <class Domain>
using Seeds = std::vector<std::pair<Point, typename Domain::Index>>;

template <class Domain, class Triangulation,
          bool has_features = CGAL::Mesh_3::internal::has_Has_features<Domain>::value>
struct ComplexOf {
  using type = CGAL::Mesh_complex_3_in_triangulation_3<Triangulation>;
};
template <class Domain, class Triangulation>
struct ComplexOf<Domain, Triangulation, true> {
  using type = CGAL::Mesh_complex_3_in_triangulation_3<Triangulation, typename Domain::Corner_index,
                                                       typename Domain::Curve_index>;
};

template <class Complex>
TetMesh to_tet_mesh(const Complex& complex) {
  TetMesh mesh;
  std::unordered_map<const void*, int> number;  // only for lookup; the order of iteration is undefined
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

// Field of target edge lengths times a factor.
template <class Field>
class Scaled {
 public:
  using FT = Kernel::FT;
  using Point_3 = Point;
  using Index = typename Field::Index;

  Scaled(const Field& edge, double factor) : edge_(&edge), factor_(factor) {}

  template <class AnyPoint>
  FT operator()(const AnyPoint& x, int dimension, const Index& index) const {
    return factor_ * (*edge_)(x, dimension, index);
  }

 private:
  const Field* edge_;
  double factor_;
};

// Adds the seeds that are outside and not close to the balls around sharp edges.
template <class Domain, class Field, class Complex>
void insert_seeds(const Seeds<Domain>& seeds, const Field& edge, Complex& complex) {
  constexpr double kApart = 0.5;  // edge lengths
  auto& triangulation = complex.triangulation();
  const auto weighted = triangulation.geom_traits().construct_weighted_point_3_object();
  std::vector<std::pair<Point, double>> balls;  // center, radius
  for (auto v = triangulation.finite_vertices_begin(); v != triangulation.finite_vertices_end(); ++v)
    balls.emplace_back(Point(v->point().x(), v->point().y(), v->point().z()), std::sqrt(v->point().weight()));
  const auto is_free = [&](const Point& x, double apart) {
    return std::none_of(balls.begin(), balls.end(), [&](const auto& ball) {
      const double reach = ball.second + apart;
      return CGAL::squared_distance(x, ball.first) < reach * reach;
    });
  };
  for (const auto& [x, index] : seeds) {
    const double apart = kApart * edge(x, 2, index);
    if (!is_free(x, apart)) continue;
    const auto vertex = triangulation.insert(weighted(x));
    if (vertex == typename Complex::Vertex_handle()) continue;
    complex.set_dimension(vertex, 2);
    complex.set_index(vertex, index);
    balls.emplace_back(x, 0);
  }
}

template <class Domain, class Complex, class Criteria>
void protect_sharp_edges(const Domain& domain, const Criteria& criteria, size_t most_vertices, Complex& complex) {
  if constexpr (CGAL::Mesh_3::internal::has_Has_features<Domain>::value) {
    CGAL::Mesh_error_code error{};
    CGAL::Mesh_3::internal::init_c3t3_with_features(complex, domain, criteria, false, most_vertices, &error);
  }
}

// Counts the moves of a perturbation and throws if there are too many: in the tip of a needle, slivers can turn into
// each other forever. Throws before a move, so the complex stays valid.
template <class Triangulation>
class CountedMoves : public CGAL::Mesh_3::Min_dihedral_angle_criterion<Triangulation> {
  using Base = CGAL::Mesh_3::Min_dihedral_angle_criterion<Triangulation>;

 public:
  struct TooMany {};

  CountedMoves(const Triangulation& triangulation, long& left) : Base(kSliverBound, triangulation), left_(&left) {}

  void before_move(const typename Base::Cell_vector& cells) const override {
    if (--*left_ < 0) throw TooMany();
    Base::before_move(cells);
  }

 private:
  long* left_;
};

template <class Domain, class Complex>
void perturb(const Domain& domain, Complex& complex) {
  namespace p = CGAL::parameters;
  using Criterion = CountedMoves<typename Complex::Triangulation>;
  constexpr long kMovesPerCell = 1;
  long moves = kMovesPerCell * static_cast<long>(complex.number_of_cells_in_complex());
  try {
    CGAL::perturb_mesh_3(complex, domain, p::time_limit = 0, p::sliver_bound = kSliverBound,
                         p::sliver_criterion = Criterion(complex.triangulation(), moves));
  } catch (const typename Criterion::TooMany&) {
  }
}

// Every optimizer runs until convergence or for a number of steps, without a time limit, so that the output is
// reproducible.
template <class Domain, class Complex>
void optimize(const Domain& domain, Complex& complex) {
  namespace p = CGAL::parameters;
  const double sweeps = 5e5 / static_cast<double>(1 + complex.number_of_cells_in_complex());
  const int iterations = static_cast<int>(std::clamp(sweeps, 10.0, 100.0));
  CGAL::odt_optimize_mesh_3(complex, domain, p::time_limit = 0, p::max_iteration_number = iterations);
  perturb(domain, complex);
  CGAL::exude_mesh_3(complex, p::time_limit = 0, p::sliver_bound = kSliverBound);
}

// Domain, edge lengths and limits of a mesh.
template <class Domain, class Field>
struct Filling {
  const Domain& domain;
  const Field& edge;  // target edge lengths
  const Seeds<Domain>& seeds;
  size_t most_vertices;   // at which refinement stops
  bool optimizes = true;  // whether to optimize after refinement
};

// `is_complete`: whether refinement finished within its limit.
template <class Domain, class Field>
TetMesh refined(const Filling<Domain, Field>& filling, bool& is_complete) {
  namespace p = CGAL::parameters;
  using Triangulation = typename CGAL::Mesh_triangulation_3<Domain, Kernel>::type;
  using Complex = typename ComplexOf<Domain, Triangulation>::type;
  using Criteria = CGAL::Mesh_criteria_3<Triangulation>;
  CGAL::get_default_random() = CGAL::Random(0);
  const auto& [domain, edge, seeds, most_vertices, optimizes] = filling;
  const Scaled<Field> radius(edge, kRadiusPerEdge), distance(edge, kRadiusPerEdge * kDistancePerRadius);
  const Criteria criteria(p::edge_size = Scaled<Field>(edge, kProtectedPerEdge), p::facet_angle = 25,
                          p::facet_size = radius, p::facet_distance = distance, p::cell_radius_edge_ratio = 2.2,
                          p::cell_size = radius);
  Complex complex;
  protect_sharp_edges(domain, criteria, most_vertices, complex);
  insert_seeds<Domain>(seeds, edge, complex);
  CGAL::refine_mesh_3(complex, domain, criteria, p::no_exude(), p::no_perturb(), p::no_odt(), p::no_lloyd(),
                      p::no_reset_c3t3(), p::mesh_3_options(p::maximal_number_of_vertices = most_vertices));
  is_complete = complex.triangulation().number_of_vertices() < most_vertices;
  if (is_complete && optimizes) optimize(domain, complex);
  return to_tet_mesh(complex);
}

// CGAL's optimizers can break the triangulation between many protected edges. Its assertions, which every build of this
// program contains, detect this; then the tets before optimization are used.
template <class Domain, class Field>
TetMesh filled(Filling<Domain, Field> filling, bool& is_complete) {
  try {
    return refined(filling, is_complete);
  } catch (const CGAL::Failure_exception&) {
    filling.optimizes = false;
    return refined(filling, is_complete);
  }
}

}  // namespace aspic
