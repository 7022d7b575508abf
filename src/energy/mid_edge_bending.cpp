#include "energy/mid_edge_bending.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/check.h"
#include "base/parallel.h"
#include "energy/element_groups.h"
#include "energy/hinge_angle.h"
#include "math/vectors.h"
#include "mesh/topology.h"

namespace aspic {
namespace {

constexpr int kNodes = 9;  // six vertices and three rows of angles

// Edges of a sheet and the mean of their lengths.
struct Edges {
  std::vector<EdgeUse> uses;
  int count = 0;
  double mean_length = 0;

  Edges(std::span<const Vec3d> rest, const std::vector<Triangle>& triangles) : uses(edge_uses(triangles)) {
    for_each_edge(uses, [&](const EdgeUse* first, const EdgeUse*) {
      mean_length += norm(rest[first->edge[1]] - rest[first->edge[0]]);
      ++count;
    });
    mean_length /= std::max(count, 1);
  }
  int row_count() const { return (count + 2) / 3; }
};

double area_of(std::span<const Vec3d> rest, const Triangle& t) {
  return 0.5 * norm(cross(rest[t[1]] - rest[t[0]], rest[t[2]] - rest[t[0]]));
}

// Returns the corner of the triangle opposite to the edge.
int opposite_corner(const Triangle& triangle, const std::array<int, 2>& edge) {
  int k = 0;
  while (triangle[k] == edge[0] || triangle[k] == edge[1]) ++k;
  return k;
}

// The half angle of a triangle at one of its edges: a = theta_share theta + xi_share x[row, entry].
struct Side {
  std::array<int, 4> hinge = {-1, -1, -1, -1};  // vertices a, b, c, d of theta, see hinge_angle.h; -1: no theta
  int row = 0, entry = 0;
  double theta_share = 0, xi_share = 0;
  double rest = 0;  // a0

  bool has_theta() const { return theta_share != 0; }
  HingeCorners corners(Positions x) const {
    return {point(x, hinge[0]), point(x, hinge[1]), point(x, hinge[2]), point(x, hinge[3])};
  }
  double angle(Positions x) const {
    const double theta = has_theta() ? theta_share * hinge_angle(corners(x)) : 0;
    return theta + xi_share * x[3 * static_cast<size_t>(row) + entry];
  }
};

// A triangle of the sheet. Its nodes are the vertices and rows of angles that it depends on.
struct Element {
  std::array<Side, 3> sides;
  Mat3d Q;  // [N m]
  double area = 0;
  std::array<int, kNodes> nodes;  // ascending; the first one fills unused places
  int node_count = 0;

  int place(int node) const {
    return static_cast<int>(std::lower_bound(nodes.begin(), nodes.begin() + node_count, node) - nodes.begin());
  }
  Vec3d change(Positions x) const {  // a - a0
    Vec3d a;
    for (int k = 0; k < 3; ++k) a[k] = sides[k].angle(x) - sides[k].rest;
    return a;
  }
  double energy(Positions x) const {
    const Vec3d a = change(x);
    return 0.5 * dot(a, Q * a);
  }
};

// The Hessian of an element: J'QJ, and the moments times the Hessians of theta.
class ElementHessian {
 public:
  ElementHessian(const Element& element, Positions x, Definiteness kind) : e_(element) {
    const Vec3d moment = e_.Q * e_.change(x);
    for (int k = 0; k < 3; ++k) {
      const Side& side = e_.sides[k];
      slope_[k][e_.place(side.row)][side.entry] += side.xi_share;
      if (side.has_theta()) add_hinge(k, moment[k], kind, side.corners(x));
    }
    for (int j = 0; j < e_.node_count; ++j) add_square(j);
  }

  bool is_modified() const { return is_modified_; }
  // Returns the block of places u >= v in Element::nodes.
  const Mat3d& operator()(int u, int v) const { return K_[u][v]; }

 private:
  void add_hinge(int k, double moment, Definiteness kind, const HingeCorners& corners) {
    const Side& side = e_.sides[k];
    const double stiffness = e_.Q(k, k);
    const HingeHessian H(HingeShape(corners), side.theta_share * moment / stiffness, kind, 0);
    is_modified_ |= H.is_modified();
    const HingeCorners gradient = hinge_gradient(corners).gradient;
    for (int u = 0; u < 4; ++u) {
      const int i = e_.place(side.hinge[u]);
      slope_[k][i] = slope_[k][i] + side.theta_share * gradient[u];
      for (int v = 0; v < 4; ++v)
        if (const int j = e_.place(side.hinge[v]); i >= j) add(i, j, stiffness * H(u, v));
    }
  }

  // Adds the blocks (i, j) of J'QJ, i >= j.
  void add_square(int j) {
    for (int k = 0; k < 3; ++k) {
      const Vec3d weighted = e_.Q(k, 0) * slope_[0][j] + e_.Q(k, 1) * slope_[1][j] + e_.Q(k, 2) * slope_[2][j];
      for (int i = j; i < e_.node_count; ++i) add(i, j, outer(slope_[k][i], weighted));
    }
  }
  void add(int i, int j, const Mat3d& block) { K_[i][j] = K_[i][j] + block; }

  const Element& e_;
  bool is_modified_ = false;
  Vec3d slope_[3][kNodes] = {};  // da/dx
  Mat3d K_[kNodes][kNodes] = {};
};

// Returns Q = A B'DB of a triangle.
Mat3d angle_stiffness(const std::array<Vec3d, 3>& X, double area, const PlateStiffness& plate) {
  const Vec3d e = X[1] - X[0], m = cross(cross(e, X[2] - X[0]), e);
  const Vec3d u = (1 / norm(e)) * e, w = (1 / norm(m)) * m;
  const Vec3d axis1 = plate.axis[0] * u + plate.axis[1] * w, axis2 = plate.axis[0] * w - plate.axis[1] * u;
  Mat3d B;
  for (int k = 0; k < 3; ++k) {
    const Vec3d edge = X[(k + 2) % 3] - X[(k + 1) % 3];
    const double l = norm(edge), n1 = dot(edge, axis2) / l, n2 = -dot(edge, axis1) / l, s = l / area;
    B(0, k) = s * n1 * n1;
    B(1, k) = s * n2 * n2;
    B(2, k) = 2 * s * n1 * n2;
  }
  const Mat3d D = {{plate.D11, plate.D12, 0, plate.D12, plate.D22, 0, 0, 0, plate.D33}};
  return area * (transpose(B) * (D * B));
}

// Builds the elements, and lists the unused entries of the rows.
class SheetBuilder {
 public:
  explicit SheetBuilder(const MidEdgeSheet& sheet)
      : sheet_(sheet), edges_(sheet.rest, sheet.triangles), elements_(sheet.triangles.size()) {
    for (size_t t = 0; t < elements_.size(); ++t) add_stiffness(static_cast<int>(t));
    is_used_.assign(3 * static_cast<size_t>(edges_.row_count()), 0);
    int edge = 0;
    for_each_edge(edges_.uses, [&](const EdgeUse* first, const EdgeUse* last) {
      ASPIC_CHECK(last - first <= 2);
      add_sides(edge++, first, last - first == 2 ? first + 1 : nullptr);
    });
    for (Element& e : elements_) finish(e);
  }

  std::vector<Element> elements() const { return elements_; }
  std::vector<int> unused_entries() const {
    std::vector<int> unused;
    for (size_t i = 0; i < is_used_.size(); ++i)
      if (!is_used_[i]) unused.push_back(3 * sheet_.first_row + static_cast<int>(i));
    return unused;
  }
  // Returns a stiffness for the unused entries [N/m].
  double largest_stiffness() const {
    double largest = 0;
    for (const Element& e : elements_)
      for (int k = 0; k < 3; ++k) largest = std::max(largest, e.Q(k, k));
    return (largest > 0 ? largest : 1) / (edges_.mean_length * edges_.mean_length);
  }

 private:
  void add_stiffness(int t) {
    const Triangle& triangle = sheet_.triangles[t];
    Element& e = elements_[t];
    e.area = area_of(sheet_.rest, triangle);
    ASPIC_CHECK(e.area > 0);
    const auto& X = sheet_.rest;
    e.Q = angle_stiffness({X[triangle[0]], X[triangle[1]], X[triangle[2]]}, e.area, sheet_.stiffness[t]);
  }

  bool is_held(int t) const {
    const Triangle& v = sheet_.triangles[t];
    return !sheet_.held.empty() && sheet_.held[v[0]] && sheet_.held[v[1]] && sheet_.held[v[2]];
  }

  // `other`: null for an edge of the border.
  void add_sides(int edge, const EdgeUse* use, const EdgeUse* other) {
    const bool is_held_here = is_held(use->triangle), is_held_there = other && is_held(other->triangle);
    const bool is_free = !is_held_here && !is_held_there;
    is_used_[edge] = is_free;
    const double xi_share = is_free ? 1 / edges_.mean_length : 0;
    if (!other) {
      Side& side = add_side(edge, *use, 0, xi_share);
      if (!use->forward) reverse(side);
      return;
    }
    const bool is_halved = is_held_here == is_held_there;
    Side& side = add_side(edge, *use, is_halved ? 0.5 : is_held_here ? 0 : 1, xi_share);
    Side& opposite = add_side(edge, *other, is_halved ? 0.5 : is_held_there ? 0 : 1, -xi_share);
    side.hinge = opposite.hinge = {use->edge[0], use->edge[1], opposite_vertex(*use), opposite_vertex(*other)};
    if (other->forward) reverse(opposite);
    if (!use->forward) reverse(side);
    set_rest(side, opposite);
  }

  int opposite_vertex(const EdgeUse& use) const {
    const Triangle& triangle = sheet_.triangles[use.triangle];
    return triangle[opposite_corner(triangle, use.edge)];
  }

  Side& add_side(int edge, const EdgeUse& use, double theta_share, double xi_share) {
    Side& side = elements_[use.triangle].sides[opposite_corner(sheet_.triangles[use.triangle], use.edge)];
    side.row = sheet_.first_row + edge / 3;
    side.entry = edge % 3;
    side.theta_share = theta_share;
    side.xi_share = xi_share;
    return side;
  }

  // The triangle has the opposite orientation, so that its normal is that of the other side.
  static void reverse(Side& side) {
    side.theta_share = -side.theta_share;
    side.xi_share = -side.xi_share;
  }

  void set_rest(Side& side, Side& opposite) const {
    if (sheet_.rest_angles == RestAngles::flat) return;
    const auto& [a, b, c, d] = side.hinge;
    const double theta = hinge_angle({sheet_.rest[a], sheet_.rest[b], sheet_.rest[c], sheet_.rest[d]});
    for (Side* s : {&side, &opposite}) s->rest = s->theta_share * theta;
  }

  static void finish(Element& e) {
    std::vector<int> nodes;
    for (const Side& side : e.sides) {
      nodes.push_back(side.row);
      if (side.has_theta()) nodes.insert(nodes.end(), side.hinge.begin(), side.hinge.end());
    }
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    e.node_count = static_cast<int>(nodes.size());
    e.nodes.fill(nodes[0]);
    std::copy(nodes.begin(), nodes.end(), e.nodes.begin());
  }

  const MidEdgeSheet& sheet_;
  Edges edges_;
  std::vector<Element> elements_;
  std::vector<char> is_used_;  // entries of the rows
};

class SheetMidEdgeBending : public MidEdgeBending {
 public:
  explicit SheetMidEdgeBending(const SheetBuilder& builder)
      : elements_(builder.elements()), unused_(builder.unused_entries()), spring_(builder.largest_stiffness()) {
    std::vector<std::array<int, kNodes>> nodes;
    for (const Element& e : elements_) nodes.push_back(e.nodes);
    groups_ = ElementGroups(nodes);
  }

  std::string_view name() const override { return "bending"; }

  double value(Positions x, const Context&) const override {
    const double V = parallel_sum(count(), [&](int first, int last) {
      double sum = 0;
      for (int t = first; t < last; ++t) sum += elements_[t].energy(x);
      return sum;
    });
    double springs = 0;
    for (const int i : unused_) springs += 0.5 * spring_ * x[i] * x[i];
    return std::isnan(V) ? std::numeric_limits<double>::infinity() : V + springs;
  }

  void add_gradient(Positions x, const Context&, double scale, std::span<double> g) const override {
    groups_.for_each([&](int t) {
      const Element& e = elements_[t];
      const Vec3d moment = scale * (e.Q * e.change(x));
      for (int k = 0; k < 3; ++k) {
        const Side& side = e.sides[k];
        g[3 * static_cast<size_t>(side.row) + side.entry] += moment[k] * side.xi_share;
        if (!side.has_theta()) continue;
        const HingeCorners gradient = hinge_gradient(side.corners(x)).gradient;
        for (int u = 0; u < 4; ++u) add_vec((moment[k] * side.theta_share) * gradient[u], side.hinge[u], g);
      }
    });
    for (const int i : unused_) g[i] += scale * spring_ * x[i];
  }

  void add_couplings(Couplings& couplings) const override {
    for (const Element& e : elements_)
      for (int i = 0; i < e.node_count; ++i)
        for (int j = 0; j < i; ++j) couplings.emplace_back(e.nodes[i], e.nodes[j]);
  }
  void bind(const BlockPattern& pattern) override {
    diagonal_.clear();
    for (const int i : unused_) diagonal_.push_back(pattern.diagonal(i / 3));
    slots_.resize(elements_.size());
    parallel_for(count(), [&](int t) {
      const Element& e = elements_[t];
      for (int i = 0, k = 0; i < e.node_count; ++i)
        for (int j = 0; j <= i; ++j) slots_[t][k++] = pattern.slot(e.nodes[i], e.nodes[j]);
    });
  }

  int add_hessian(Positions x, const Context&, double scale, const Projection& projection,
                  BlockSparse& H) const override {
    const int modified = groups_.count_if([&](int t) {
      const Element& e = elements_[t];
      const ElementHessian K(e, x, is_covered(e.nodes, projection) ? projection.kind : Definiteness::exact);
      for (int i = 0, k = 0; i < e.node_count; ++i)
        for (int j = 0; j <= i; ++j, ++k) {
          double* to = H.block[slots_[t][k]].a;
          for (int m = 0; m < 9; ++m) to[m] += scale * K(i, j).a[m];
        }
      return K.is_modified();
    });
    for (size_t k = 0; k < unused_.size(); ++k)
      H.block[diagonal_[k]](unused_[k] % 3, unused_[k] % 3) += scale * spring_;
    return modified;
  }

  void evaluate(Positions x, std::vector<double>& energy_density) const override {
    energy_density.clear();
    for (const Element& e : elements_) energy_density.push_back(e.energy(x) / e.area);
  }

 private:
  using Slots = std::array<int64_t, kNodes*(kNodes + 1) / 2>;  // of an element's blocks i >= j, row by row

  int count() const { return static_cast<int>(elements_.size()); }

  std::vector<Element> elements_;
  std::vector<int> unused_;  // entries of x
  double spring_;            // their stiffness [N/m]
  std::vector<Slots> slots_;
  std::vector<int64_t> diagonal_;  // slots of the unused entries
  ElementGroups groups_;
};

}  // namespace

PlateStiffness plate_stiffness(const MembraneLaw& law) {
  if (const auto* woven = std::get_if<OrthotropicSheet>(&law)) {
    const double nu21 = woven->poisson * woven->weft_young / woven->warp_young;
    const double s = std::pow(woven->thickness, 3) / 12, r = s / (1 - woven->poisson * nu21);
    return {r * woven->warp_young, r * woven->weft_young, r * woven->poisson * woven->weft_young, s * woven->shear,
            woven->warp};
  }
  const IsotropicSheet& sheet = std::get<IsotropicSheet>(law);
  const double nu = sheet.poisson, D = sheet.young * std::pow(sheet.thickness, 3) / (12 * (1 - nu * nu));
  return {D, D, nu * D, 0.5 * (1 - nu) * D};
}

std::vector<AngleRow> make_angle_rows(std::span<const Vec3d> rest, const std::vector<Triangle>& triangles,
                                      std::span<const double> mass) {
  const Edges edges(rest, triangles);
  const double square = edges.mean_length * edges.mean_length;
  std::vector<AngleRow> rows;
  int edge = 0;
  for_each_edge(edges.uses, [&](const EdgeUse* first, const EdgeUse* last) {
    const auto [a, b] = first->edge;
    if (edge % 3 == 0) rows.push_back({{}, 0, a});
    const int row = edge / 3, in_row = std::min(3, edges.count - 3 * row);
    rows[row].center = rows[row].center + (0.5 / in_row) * (rest[a] + rest[b]);
    for (const EdgeUse* use = first; use != last; ++use)
      rows[row].mass += mass[use->triangle] * area_of(rest, triangles[use->triangle]) / (3 * square * in_row);
    ++edge;
  });
  return rows;
}

std::unique_ptr<MidEdgeBending> make_mid_edge_bending(const MidEdgeSheet& sheet) {
  ASPIC_CHECK(sheet.stiffness.size() == sheet.triangles.size());
  return std::make_unique<SheetMidEdgeBending>(SheetBuilder(sheet));
}

}  // namespace aspic
