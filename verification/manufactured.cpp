#include "verification/manufactured.h"

#include <algorithm>
#include <cmath>

#include "material/list.h"
#include "mesh/generators.h"
#include "verification/statics.h"

namespace aspic::verify {
namespace {

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

Vec3d combination(const Point& point, const std::array<Vec3d, 4>& corner) {
  Vec3d sum{};
  for (int c = 0; c < 4; ++c) sum = sum + point.share[c] * corner[c];
  return sum;
}

std::array<Vec3d, 4> corners(const TetMesh& mesh, int t, const std::vector<double>& x) {
  std::array<Vec3d, 4> corner;
  for (int c = 0; c < 4; ++c) {
    const double* at = &x[3 * mesh.tets[t][c]];
    corner[c] = {{at[0], at[1], at[2]}};
  }
  return corner;
}

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
    for (int t = 0; t < mesh.tet_count(); ++t) {
      const auto corner = corners(mesh, t, rest);
      for (const Point& point : points) {
        const Vec3d b = body_force<M>(Exact(combination(point, corner)), p);
        for (int c = 0; c < 4; ++c)
          for (int r = 0; r < 3; ++r)
            load[3 * mesh.tets[t][c] + r] += volume(mesh, t) * point.weight * point.share[c] * b[r];
      }
    }
  });
  return load;
}

}  // namespace

SpaceError manufactured_error(const std::string& material, const std::string& taken, double poisson, int n) {
  const TetMesh mesh = irregular_cube(n);
  const std::vector<double> rest = at_rest(mesh).q;
  Model model = make_model(mesh, {.material = taken, .young = 1, .poisson = poisson, .gravity = {}});
  model.pins.push_back(
      {"boundary", boundary_vertices(mesh), [](const Vec3d& X, double t) { return (1 - t) * X + t * Exact(X).x; }});
  model.loads.push_back(make_growing_load(
      load_of(material, material_parameters(material, {.young = 1, .poisson = poisson}), mesh, rest)));
  const Simulation simulation = equilibrium(std::move(model), 2, material);
  SpaceError error{1.0 / n, 0, 0};
  const std::vector<Point> points = quadrature();
  for (int t = 0; t < mesh.tet_count(); ++t) {
    const auto corner = corners(mesh, t, rest), moved = corners(mesh, t, simulation.state().q);
    const Mat3d F =
        from_columns(moved[1] - moved[0], moved[2] - moved[0], moved[3] - moved[0]) * inverse(edge_matrix(mesh, t));
    for (const Point& point : points) {
      const Exact exact(combination(point, corner));
      const Vec3d d = combination(point, moved) - exact.x;
      error.l2 += volume(mesh, t) * point.weight * dot(d, d);
      error.h1 += volume(mesh, t) * point.weight * squared_norm(F - exact.F);
    }
  }
  error.l2 = std::sqrt(error.l2), error.h1 = std::sqrt(error.h1);
  return error;
}

}  // namespace aspic::verify
