// Orders of convergence in time, with motions that linear tets represent exactly.
#include <algorithm>
#include <cmath>
#include <string>

#include "dynamics/integrator.h"
#include "material/list.h"
#include "mesh/generators.h"
#include "mesh/tet_nodes.h"
#include "reference/integrators.h"
#include "reference/statics.h"
#include "verification/families.h"

namespace aspic::verify {
namespace {

struct SpaceError {
  double h;       // edge length of a cell [m]
  double l2, h1;  // sqrt(int |x_h - x|^2), sqrt(int |F_h - F|^2) [m^(5/2)], [m^(3/2)]
};

// u_k = a_k sin(w_k . X + p_k)
constexpr double kAmplitude[3] = {0.08, -0.06, 0.05}, kPhase[3] = {0.3, 1.1, -0.4};
const Vec3d kWave[3] = {{{2.1, 1.3, -0.8}}, {{-1.1, 1.9, 1.4}}, {{1.2, -0.9, 2.2}}};

struct Exact {
  Vec3d x;
  Mat3d F;
  double second[3];  // second derivatives: d2 u_k / dX_J dX_L = second[k] w_k[J] w_k[L]

  explicit Exact(const Vec3d& X) : x(X), F(identity3<double>()) {
    for (int k = 0; k < 3; ++k) {
      const double angle = dot(kWave[k], X) + kPhase[k];
      x[k] += kAmplitude[k] * std::sin(angle);
      for (int J = 0; J < 3; ++J) F(k, J) += kAmplitude[k] * kWave[k][J] * std::cos(angle);
      second[k] = -kAmplitude[k] * std::sin(angle);
    }
  }
};

// -Div P: P_iJ,J = H_(iJ)(kL) u_k,LJ.
template <class M>
Vec3d body_force(const Exact& exact, const typename M::template Params<double>& p) {
  const Mat9d H = M::hessian(exact.F, p);
  Vec3d b{};
  for (int i = 0; i < 3; ++i)
    for (int J = 0; J < 3; ++J)
      for (int k = 0; k < 3; ++k)
        for (int L = 0; L < 3; ++L) b[i] -= H(3 * J + i, 3 * L + k) * exact.second[k] * kWave[k][L] * kWave[k][J];
  return b;
}

struct Point {
  double weight;    // fraction of the tet's volume
  double share[4];  // barycentric coordinates
};

// Product of Gauss's three-point rule, collapsed to the tet; exact for cubics.
std::vector<Point> quadrature() {
  const double g = std::sqrt(0.6) / 2, node[3] = {0.5 - g, 0.5, 0.5 + g}, weight[3] = {5.0 / 18, 8.0 / 18, 5.0 / 18};
  std::vector<Point> points;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      for (int k = 0; k < 3; ++k) {
        const double a = node[i], b = (1 - a) * node[j], c = (1 - a - b) * node[k];
        points.push_back(
            {6 * weight[i] * weight[j] * weight[k] * (1 - a) * (1 - a) * (1 - node[j]), {1 - a - b - c, a, b, c}});
      }
  return points;
}

// The shape functions of a tet at a point, and their gradients.
struct Shapes {
  TetNodes nodes;
  std::array<double, 10> N;
  std::array<Vec3d, 10> gradient;

  Shapes(const TetMesh& mesh, int t, const Point& point) : nodes(nodes_of(mesh, t)), N{}, gradient{} {
    const Mat3d B = inverse(edge_matrix(mesh, t));
    const double* l = point.share;
    std::array<Vec3d, 4> b{};
    for (int i = 1; i < 4; ++i) {
      b[i] = {{B(i - 1, 0), B(i - 1, 1), B(i - 1, 2)}};
      b[0] = b[0] - b[i];
    }
    const bool is_linear = nodes.count == 4;
    for (int i = 0; i < 4; ++i) {
      N[i] = is_linear ? l[i] : l[i] * (2 * l[i] - 1);
      gradient[i] = (is_linear ? 1 : 4 * l[i] - 1) * b[i];
    }
    for (int k = 0; k < 6; ++k) {
      const auto [i, j] = kTetEdges[k];
      N[4 + k] = 4 * l[i] * l[j];
      gradient[4 + k] = 4 * l[i] * b[j] + 4 * l[j] * b[i];
    }
  }

  Vec3d position(std::span<const double> x) const {
    Vec3d sum{};
    for (int n = 0; n < nodes.count; ++n) sum = sum + N[n] * aspic::point(x, nodes[n]);
    return sum;
  }
  Mat3d F(std::span<const double> x) const {
    Mat3d sum{};
    for (int n = 0; n < nodes.count; ++n)
      for (int c = 0; c < 3; ++c)
        for (int r = 0; r < 3; ++r) sum(r, c) += x[3 * nodes[n] + r] * gradient[n][c];
    return sum;
  }
};

TetMesh irregular_cube(int n) {
  TetMesh mesh = make_box({{0, 0, 0}}, {{1, 1, 1}}, {n, n, n});
  const auto inner = [](double c) { return c > 1e-9 && c < 1 - 1e-9; };
  for (Vec3d& X : mesh.rest)
    if (std::all_of(X.a, X.a + 3, inner)) {
      const Vec3d at = static_cast<double>(n) * X;
      X = X + (0.2 / n) * Vec3d{{std::sin(9 * at[1] + at[2]), std::cos(7 * at[2]), std::sin(8 * at[0] + 3 * at[1])}};
    }
  return mesh;
}

std::vector<double> load_of(const std::string& material, const MaterialParameters& parameters, const TetMesh& mesh,
                            const std::vector<double>& rest) {
  std::vector<double> load(rest.size());
  const std::vector<Point> points = quadrature();
  with_material(material, [&]<class M>() {
    const auto p = M::params(parameters);
    for (int t = 0; t < mesh.tet_count(); ++t)
      for (const Point& point : points) {
        const Shapes shapes(mesh, t, point);
        const Vec3d b = body_force<M>(Exact(shapes.position(rest)), p);
        for (int n = 0; n < shapes.nodes.count; ++n)
          for (int r = 0; r < 3; ++r)
            load[3 * shapes.nodes[n] + r] += volume(mesh, t) * point.weight * shapes.N[n] * b[r];
      }
  });
  return load;
}

// An irregular cube of n cells per edge, of linear or quadratic tets.
struct Cube {
  int n;
  bool is_quadratic = false;
};

// Every inner vertex is moved by up to a fifth of a cell; E = 1 Pa. The body force belongs to `material`; the tets use
// `taken`.
SpaceError manufactured_error(const std::string& material, const std::string& taken, double poisson, const Cube& cube) {
  const TetMesh mesh = cube.is_quadratic ? raise_order(irregular_cube(cube.n)) : irregular_cube(cube.n);
  const std::vector<double> rest = at_rest(mesh).q;
  Model model = make_model(mesh, {.material = taken, .young = 1, .poisson = poisson, .gravity = {}});
  model.pins.push_back(
      {"boundary", boundary_vertices(mesh), [](const Vec3d& X, double t) { return (1 - t) * X + t * Exact(X).x; }});
  model.loads.push_back(make_growing_load(
      load_of(material, material_parameters(material, {.young = 1, .poisson = poisson}), mesh, rest)));
  const Simulation simulation = equilibrium(std::move(model), 2, material);
  SpaceError error{1.0 / cube.n, 0, 0};
  const std::vector<Point> points = quadrature();
  for (int t = 0; t < mesh.tet_count(); ++t) {
    for (const Point& point : points) {
      const Shapes shapes(mesh, t, point);
      const Exact exact(shapes.position(rest));
      const Vec3d d = shapes.position(simulation.state().q) - exact.x;
      error.l2 += volume(mesh, t) * point.weight * dot(d, d);
      error.h1 += volume(mesh, t) * point.weight * squared_norm(shapes.F(simulation.state().q) - exact.F);
    }
  }
  error.l2 = std::sqrt(error.l2), error.h1 = std::sqrt(error.h1);
  return error;
}

double order_between(double coarse, double fine) { return std::log2(coarse / fine); }

const char* text_of(Held held) {
  constexpr const char* kTexts[] = {"free", "one face held", "all faces held"};
  return kTexts[static_cast<size_t>(held)];
}

void check_time_order(const Subject& subject, Findings& found) {
  Plot plot{"error after 0.4 s, one face held", "time step h [s]", "largest error [m]", Scales::logarithmic, {}};
  for (const std::string& integrator : integrators_in_time()) {
    const int order = make_integrator(integrator)->facts().order;
    const std::string taken = subject.replacement(integrator);
    for (const Held held : {Held::on_one_face, Held::nowhere, Held::on_the_boundary}) {
      Curve curve{integrator, {}, {}, CurveStyle::line_and_points};
      const int count = subject.quick ? 3 : 4;
      for (int i = 0; i < count; ++i) {
        curve.x.push_back((order == 4 ? 0.04 : 0.01) / (1 << i));
        curve.y.push_back(affine_motion_error(taken, curve.x.back(), held));
      }
      found.expect(integrator + ": order, " + text_of(held),
                   {order_between(curve.y[curve.y.size() - 2], curve.y.back()), static_cast<double>(order), 0.2},
                   "the next term of the error has the relative size h; it changes the order by up to 0.1");
      if (held == Held::on_one_face) plot.curves.push_back(curve);
    }
  }
  found.plots.push_back(plot);
}

void check_driven_order(const Subject& subject, Findings& found) {
  for (const std::string& integrator : integrators_in_time()) {
    const int order = make_integrator(integrator)->facts().order;
    const double h = 0.004;
    const std::string taken = subject.replacement(integrator);
    found.expect(integrator + ": order",
                 {order_between(driven_oscillator_error(taken, h), driven_oscillator_error(taken, h / 2)),
                  static_cast<double>(order), 0.1},
                 "the next term of the error at w h = 0.04");
  }
}

// Returns the last of the errors C1 h^p + C2 h^(p+1) + ..., with h halved each time, after eliminating as many terms as
// possible.
double without_terms(std::vector<double> errors, int order) {
  for (; errors.size() > 1; ++order) {
    for (size_t i = 0; i + 1 < errors.size(); ++i)
      errors[i] = (std::exp2(order) * errors[i + 1] - errors[i]) / (std::exp2(order) - 1);
    errors.pop_back();
  }
  return errors[0];
}

void check_time_floor(const Subject& subject, Findings& found) {
  found.expect_small("rk4, h = 2.5 ms: error",
                     affine_motion_error(subject.replacement("rk4"), 0.0025, Held::on_one_face), 1e-10,
                     "the fourth order is visible down to the accuracy of the solves", "m");
  const std::string taken = subject.replacement("tr_bdf2");
  const double fine = affine_motion_error(taken, 0.0005, Held::on_one_face);
  const double coarse = affine_motion_error(taken, 0.01, Held::on_one_face);
  found.expect("tr_bdf2: error at 10 ms / error at 0.5 ms", {coarse / fine, 400, 40},
               "20 times smaller steps; a tenth for the next term of the error");
  for (const std::string integrator : {"backward_euler", "bdf2", "tr_bdf2", "midpoint"}) {
    std::vector<double> errors;
    for (int i = 0; i < 6; ++i)
      errors.push_back(affine_motion_error(subject.replacement(integrator), 0.01 / (1 << i), Held::on_one_face));
    found.expect_small(integrator + ", 10 to 0.3 ms: error without its first five terms",
                       without_terms(errors, make_integrator(integrator)->facts().order), 1e-10,
                       "only powers of h from the order upward, down to the accuracy of the solves", "m");
  }
}

void check_space_order(const Subject& subject, Findings& found) {
  Plot plot{"manufactured solution, nu = 0.3", "edge of a cell h [m]", "error", Scales::logarithmic, {}};
  const std::vector<int> cells = subject.quick ? std::vector<int>{4, 8} : std::vector<int>{4, 8, 16};
  for (const MaterialInfo& info : materials()) {
    Curve l2{info.name + ", L2", {}, {}}, h1{info.name + ", H1", {}, {}};
    for (const int n : cells) {
      const SpaceError error = manufactured_error(info.name, subject.replacement(info.name), 0.3, {n});
      l2.x.push_back(error.h), l2.y.push_back(error.l2);
      h1.x.push_back(error.h), h1.y.push_back(error.h1);
    }
    const double tolerance = subject.quick ? 0.15 : 0.1;
    const std::string reason = "the next term of the error has the relative size h, with 8 or 16 cells along an edge";
    found.expect(info.name + ": order in L2", {order_between(l2.y[l2.y.size() - 2], l2.y.back()), 2, tolerance},
                 reason);
    found.expect(info.name + ": order in H1", {order_between(h1.y[h1.y.size() - 2], h1.y.back()), 1, tolerance},
                 reason);
    if (info.name != "neo_hookean_log" && info.name != "stable_neo_hookean" && info.name != "stvk") continue;
    plot.curves.push_back(l2);
    plot.curves.push_back(h1);
  }
  found.plots.push_back(plot);
}

void check_quadratic_order(const Subject& subject, Findings& found) {
  Plot plot{"quadratic tets, nu = 0.3", "edge of a cell h [m]", "error", Scales::logarithmic, {}};
  const std::vector<int> cells = subject.quick ? std::vector<int>{2, 4} : std::vector<int>{2, 4, 8};
  for (const char* material : {"neo_hookean_log", "stable_neo_hookean", "stvk", "linear"}) {
    Curve l2{std::string(material) + ", L2", {}, {}}, h1{std::string(material) + ", H1", {}, {}};
    for (const int n : cells) {
      const SpaceError error = manufactured_error(material, subject.replacement(material), 0.3, {n, true});
      l2.x.push_back(error.h), l2.y.push_back(error.l2);
      h1.x.push_back(error.h), h1.y.push_back(error.h1);
    }
    const std::string reason = "the next term of the error has the relative size h, with 4 or 8 cells along an edge";
    found.expect(std::string(material) + ": order in L2", {order_between(l2.y[l2.y.size() - 2], l2.y.back()), 3, 0.2},
                 reason);
    found.expect(std::string(material) + ": order in H1", {order_between(h1.y[h1.y.size() - 2], h1.y.back()), 2, 0.2},
                 reason);
    plot.curves.push_back(l2);
    plot.curves.push_back(h1);
  }
  found.plots.push_back(plot);
}

}  // namespace

void add_order_checks(std::vector<Check>& checks) {
  checks.push_back({"orders",
                    "space",
                    "Order in space by a manufactured solution",
                    "A cube of irregular tets under the body force that belongs to a smooth deformation of up to 17 % "
                    "strain, held around: errors of position and of deformation gradient, every material.",
                    "Linear elements: 2 in L2, 1 in H1",
                    check_space_order,
                    {"Roache1998"},
                    {R"tex(\|x_h - x\|_{L^2} = O(h^2), \quad \|F_h - F\|_{L^2} = O(h))tex"}});
  checks.push_back({"orders",
                    "space_quadratic",
                    "Order in space of quadratic tets",
                    "The manufactured solution of orders/space on quadratic tets with straight edges.",
                    "Quadratic elements: 3 in L2, 2 in H1",
                    check_quadratic_order,
                    {"Roache1998"},
                    {R"tex(\|x_h - x\|_{L^2} = O(h^3), \quad \|F_h - F\|_{L^2} = O(h^2))tex"}});
  checks.push_back(
      {"orders",
       "time",
       "Order in time by a manufactured motion",
       "A box moves by x = X + s(t) B X under the nodal forces that keep it going, held nowhere, on one "
       "face or all around: linear tets represent the motion exactly, so only time integration has an error.",
       "The order of the scheme",
       check_time_order,
       {"Hairer1996"},
       {R"tex(x(t) = X + s(t)\, B X)tex", R"tex(\max_i |x_i - x(t)| = O(h^p))tex"}});
  checks.push_back({"orders",
                    "time_floor",
                    "Orders are measured down to the accuracy of the solves",
                    "The same motion with short steps. Halving the steps separates the terms of the error by "
                    "order; a term of a lower order would remain.",
                    "The order of the scheme",
                    check_time_floor,
                    {"Hairer1996"},
                    {R"tex(e(h) = C_1 h^p + C_2 h^{p+1} + \dots)tex"}});
  checks.push_back({"orders",
                    "time_damped",
                    "Order in time with damping and a moving target",
                    "x'' + 2 x' + 100 (x - s(t)) = 0 with s such that x = cos 3t; position and velocity after 1 s.",
                    "The order of the scheme",
                    check_driven_order,
                    {"Hairer1996"},
                    {R"tex(\ddot x + 2 \dot x + 100\, (x - s(t)) = 0, \quad x = \cos 3 t)tex"}});
}

}  // namespace aspic::verify
