#include "model/refined_experiment.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "base/check.h"
#include "mesh/box.h"
#include "mesh/surface.h"
#include "mesh/tet_nodes.h"
#include "mesh/tet_shape.h"

namespace aspic {
namespace {

constexpr double kMaxMultiple = 10;  // of the force whose error is known; chosen, for predictions that are far off

// Factor 1 / (1 - 1/2^p) for errors of order p.
double richardson(const TetMesh& mesh) { return mesh.mids.empty() ? 4.0 / 3 : 8.0 / 7; }

class Refinement {
 public:
  explicit Refinement(const Experiment& coarse) : coarse_(coarse) {
    fine_.mesh.rest = coarse.mesh.rest;
    fine_.midpoints = coarse.midpoints;
    keep_mid_nodes();
    for (int t = 0; t < coarse.mesh.tet_count(); ++t) split(t);
    add_mid_nodes();
    for (const SurfacePoint& marker : coarse.markers) fine_.markers.push_back(in_part(marker));
    fine_.fixed = in_parts(coarse.fixed);
    fine_.errors = coarse.errors;
    fine_.scan_gravity = coarse.scan_gravity;
    for (LoadCase load : coarse.cases) {
      load.pressed = split(load.pressed);
      if (load.grip) load.grip->vertices = in_parts(load.grip->vertices);
      fine_.cases.push_back(std::move(load));
    }
  }

  Experiment take() { return std::move(fine_); }

 private:
  // The mid-edge nodes of quadratic tets are corners of the parts.
  void keep_mid_nodes() {
    for (size_t t = 0; t < coarse_.mesh.mids.size(); ++t)
      for (int k = 0; k < 6; ++k) {
        const Tet& tet = coarse_.mesh.tets[t];
        const int a = tet[kTetEdges[k][0]], b = tet[kTetEdges[k][1]], middle = coarse_.mesh.mids[t][k];
        if (middle_.try_emplace(std::minmax(a, b), middle).second) fine_.midpoints.push_back({middle, a, b});
      }
  }

  void add_mid_nodes() {
    if (coarse_.mesh.mids.empty()) return;
    for (const Tet& tet : fine_.mesh.tets) {
      MidNodes& mids = fine_.mesh.mids.emplace_back();
      for (int k = 0; k < 6; ++k) mids[k] = middle(tet[kTetEdges[k][0]], tet[kTetEdges[k][1]]);
    }
  }

  int middle(int a, int b) {
    const auto [place, is_new] = middle_.try_emplace(std::minmax(a, b), fine_.mesh.vertex_count());
    if (!is_new) return place->second;
    fine_.mesh.rest.push_back(0.5 * (fine_.mesh.rest[a] + fine_.mesh.rest[b]));
    if (coarse_.mesh.mids.empty()) fine_.midpoints.push_back({place->second, a, b});
    return place->second;
  }

  void add(Tet tet, int parent) {
    fine_.mesh.tets.push_back(tet);
    if (volume(fine_.mesh, fine_.mesh.tet_count() - 1) < 0)
      std::swap(fine_.mesh.tets.back()[2], fine_.mesh.tets.back()[3]);
    fine_.parent.push_back(coarse_.parent.empty() ? parent : coarse_.parent[parent]);
    if (!coarse_.mesh.region.empty()) fine_.mesh.region.push_back(coarse_.mesh.region[parent]);
    if (!coarse_.density.empty()) fine_.density.push_back(coarse_.density[parent]);
  }

  void split(int t) {
    const auto& [a, b, c, d] = coarse_.mesh.tets[t];
    const int ab = middle(a, b), ac = middle(a, c), ad = middle(a, d), bc = middle(b, c), bd = middle(b, d),
              cd = middle(c, d);
    add({a, ab, ac, ad}, t), add({b, ab, bc, bd}, t), add({c, ac, bc, cd}, t), add({d, ad, bd, cd}, t);
    // Opposite corners of the octahedron, and the four others around them.
    const std::array<std::array<int, 6>, 3> ways = {
        {{ab, cd, ac, bc, bd, ad}, {ac, bd, ab, bc, cd, ad}, {ad, bc, ab, bd, cd, ac}}};
    const auto diagonal = [&](const std::array<int, 6>& way) {
      return norm(fine_.mesh.rest[way[0]] - fine_.mesh.rest[way[1]]);
    };
    const auto& way = *std::min_element(
        ways.begin(), ways.end(), [&](const auto& p, const auto& q) { return diagonal(p) < diagonal(q) * (1 - 1e-9); });
    for (int k = 0; k < 4; ++k) add({way[0], way[1], way[2 + k], way[2 + (k + 1) % 4]}, t);
  }

  SurfacePoint in_part(const SurfacePoint& p) {
    const auto& v = p.vertices;
    const auto& w = p.weights;
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3, k = (i + 2) % 3;
      if (w[i] >= 0.5) return {{v[i], middle(v[i], v[j]), middle(v[i], v[k])}, {2 * w[i] - 1, 2 * w[j], 2 * w[k]}};
    }
    return {{middle(v[0], v[1]), middle(v[1], v[2]), middle(v[2], v[0])}, {1 - 2 * w[2], 1 - 2 * w[0], 1 - 2 * w[1]}};
  }

  std::vector<Triangle> split(const std::vector<Triangle>& triangles) {
    std::vector<Triangle> parts;
    for (const auto& [a, b, c] : triangles) {
      const int ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      parts.insert(parts.end(), {{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}});
    }
    return parts;
  }

  // Adds the midpoint of an edge to held vertices if a surrounding surface triangle or tet is held.
  std::vector<int> in_parts(std::vector<int> held) {
    std::vector<char> is_held(coarse_.mesh.rest.size(), 0);
    for (const int v : held) is_held[v] = 1;
    const auto all_held = [&](const auto& nodes) {
      return std::all_of(nodes.begin(), nodes.end(), [&](int v) { return is_held[v] != 0; });
    };
    for (const Triangle& t : boundary_triangles(coarse_.mesh, 0, coarse_.mesh.tet_count()))
      for (int i = 0; i < 3 && all_held(t); ++i) held.push_back(middle(t[i], t[(i + 1) % 3]));
    for (int t = 0; t < coarse_.mesh.tet_count(); ++t)
      for (int part = 8 * t; part < 8 * (t + 1) && all_held(nodes_of(coarse_.mesh, t)); ++part) {
        const TetNodes nodes = nodes_of(fine_.mesh, part);
        held.insert(held.end(), nodes.begin(), nodes.end());
      }
    std::sort(held.begin(), held.end());
    held.erase(std::unique(held.begin(), held.end()), held.end());
    return held;
  }

  const Experiment& coarse_;
  Experiment fine_;
  std::map<std::pair<int, int>, int> middle_;
};

Wrench scaled(const Wrench& w, double factor) { return {factor * w.force, factor * w.torque}; }

double product(const Wrench& a, const Wrench& b, double lever) {
  return dot(a.force, b.force) + dot(a.torque, b.torque) / (lever * lever);
}

// Ratio of another wrench to `known` along it. An opposite one is noise and has no error.
double multiple_of(const Wrench& known, const Wrench& other, double lever) {
  const double squares = product(known, known, lever);
  return squares > 0 ? std::clamp(product(known, other, lever) / squares, 0.0, kMaxMultiple) : 1;
}

double ratio(const Wrench& a, const Wrench& b, double lever) {
  const double squares = product(b, b, lever);
  return squares > 0 ? std::sqrt(product(a, a, lever) / squares) : 1;
}

Vec3d interpolated_motion(const TetMesh& mesh, int tet, const std::array<double, 4>& l, std::span<const double> x) {
  const TetNodes nodes = nodes_of(mesh, tet);
  const std::array<double, 10> quadratic = quadratic_shapes(l);
  Vec3d u{};
  for (int n = 0; n < nodes.count; ++n)
    for (int i = 0; i < 3; ++i)
      u[i] += (nodes.count == 4 ? l[n] : quadratic[n]) * (x[3 * nodes[n] + i] - mesh.rest[nodes[n]][i]);
  return u;
}

// Positions on the fine mesh, from those on the mesh and both for the last material.
Predictions start_on_fine(const TetMesh& mesh, const TetMesh& fine, const ErrorPredictions& last) {
  Predictions start = last.on_mesh;
  for (size_t c = 0; c < start.cases.size(); ++c) {
    std::vector<double>& x = start.cases[c].x;
    if (x.empty()) continue;
    x = prolonged(mesh, fine, x);
    if (last.on_fine_mesh.cases.empty() || last.on_fine_mesh.cases[c].x.empty()) continue;
    const std::vector<double> before = prolonged(mesh, fine, last.below_fine.cases[c].x);
    for (size_t i = 0; i < x.size(); ++i) x[i] += last.on_fine_mesh.cases[c].x[i] - before[i];
  }
  return start;
}

// On fine meshes, from that on the mesh and on the refined one; extrapolates the logarithm of its size.
Wrench in_limit(const Wrench& coarse, const Wrench& fine, double lever, double factor) {
  const double growth = ratio(fine, coarse, lever);
  return scaled(fine, growth > 0 ? std::pow(growth, factor - 1) : 1);
}

void shift(Vec3d& value, Vec3d& sigma, const Vec3d& error) {
  value = value - error;
  for (int i = 0; i < 3; ++i) sigma[i] = std::hypot(sigma[i], kUncertain * norm(error));
}

}  // namespace

Wrench MeshError::limit() const { return {on_mesh.force + wrench.force, on_mesh.torque + wrench.torque}; }

Wrench MeshError::for_wrench_on_mesh(const Wrench& other) const {
  return scaled(wrench, multiple_of(on_mesh, other, lever));
}

Wrench MeshError::for_measured(const LoadCase& load) const {
  Wrench known = limit();
  if (!load.force) known.force = {};
  if (!load.torque) known.torque = {};
  return scaled(wrench, multiple_of(known, {load.force.value_or(Vec3d{}), load.torque.value_or(Vec3d{})}, lever));
}

double MeshError::factor() const { return ratio(limit(), on_mesh, lever); }

double MeshError::relative_force_error() const {
  const double smaller = std::min(norm(on_mesh.force), norm(limit().force));
  return smaller > 0 ? norm(wrench.force) / smaller : 0;
}

std::vector<double> prolonged(const TetMesh& mesh, const TetMesh& fine, std::span<const double> x) {
  std::vector<double> result(x.begin(), x.end());
  result.resize(3 * fine.rest.size());
  for (int part = 0; part < fine.tet_count(); ++part) {
    const int t = part / 8;
    for (const int v : nodes_of(fine, part))
      if (v >= mesh.vertex_count()) {
        const Vec3d X = fine.rest[v], u = interpolated_motion(mesh, t, barycentric(corners(mesh, t), X), x);
        for (int i = 0; i < 3; ++i) result[3 * v + i] = X[i] + u[i];
      }
  }
  return result;
}

Experiment refined(const Experiment& experiment) { return Refinement(experiment).take(); }

Experiment refined(Experiment experiment, int times) {
  for (int i = 0; i < times; ++i) experiment = refined(experiment);
  return experiment;
}

MeshErrors mesh_errors(const Experiment& experiment, const std::string& material,
                       std::span<const MaterialParameters> parameters, const EquilibriumOptions& options,
                       ErrorPredictions* last) {
  const Experiment fine = refined(experiment);
  const auto on = [&](const Experiment& e, const Predictions& start) {
    return predicted(e, material, of_tets(e, parameters), options, start);
  };
  ErrorPredictions first;
  ErrorPredictions& all = last ? *last : first;
  Predictions &on_mesh = all.on_mesh, &on_fine = all.on_fine_mesh;
  on_mesh = on(experiment, on_mesh);
  on_fine = on(fine, start_on_fine(experiment.mesh, fine.mesh, all));
  all.below_fine = on_mesh;
  MeshErrors errors{{}, on_mesh.failure.empty() ? on_fine.failure : on_mesh.failure};
  if (!errors.failure.empty()) return errors;
  const double factor = richardson(experiment.mesh);
  for (size_t c = 0; c < on_mesh.cases.size(); ++c) {
    const CasePrediction &coarse = on_mesh.cases[c], &better = on_fine.cases[c];
    MeshError& error = errors.cases.emplace_back();
    for (size_t k = 0; k < coarse.markers.size(); ++k)
      error.markers.push_back(factor * (better.markers[k] - coarse.markers[k]));
    error.lever = size_of(experiment.mesh) / 2;
    const Wrench limit = in_limit(coarse.wrench, better.wrench, error.lever, factor);
    error.wrench = {limit.force - coarse.wrench.force, limit.torque - coarse.wrench.torque};
    error.on_mesh = coarse.wrench;
  }
  return errors;
}

Corrected without_mesh_errors(Corrected experiment, const MeshErrors& errors) {
  if (errors.cases.empty()) return experiment;
  ASPIC_CHECK(errors.cases.size() == experiment.cases.size());
  for (size_t c = 0; c < errors.cases.size(); ++c) {
    LoadCase& load = experiment.cases[c];
    const MeshError& error = errors.cases[c];
    for (size_t k = 0; k < load.positions.size(); ++k)
      shift(load.positions[k].position, load.positions[k].sigma, error.markers[k]);
    const Wrench own = error.for_measured(load);
    if (load.force) shift(*load.force, load.force_sigma, own.force);
    if (load.torque) shift(*load.torque, load.torque_sigma, own.torque);
    CommonError& common = load.common_errors.emplace_back();
    common.cause = "the mesh";
    for (const Vec3d& e : error.markers) common.markers.push_back(kUncertain * e);
    common.wrench = scaled(own, kUncertain);
  }
  return experiment;
}

}  // namespace aspic
