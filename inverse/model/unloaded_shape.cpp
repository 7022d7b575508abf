#include "model/unloaded_shape.h"

#include <algorithm>
#include <cmath>

#include "base/formatted.h"
#include "dynamics/model_builder.h"
#include "energy/linear_load.h"
#include "mesh/tet_nodes.h"
#include "mesh/tet_shape.h"
#include "mesh/vertices.h"

namespace aspic {
namespace {

constexpr int kMaxRounds = 100;       // of a fixed-point iteration that a factor of 0.79 lets reach kClose
constexpr double kClose = 1e-10;      // largest distance of a vertex from the scan, relative to the largest sag
constexpr double kStalled = 1e-7;     // the same, accepted if it does not decrease any more
constexpr double kTolerance = 1e-12;  // of equilibria: a hundredth of kClose

void center(const std::vector<Midpoint>& midpoints, TetMesh& mesh) {
  for (const auto& [vertex, a, b] : midpoints) mesh.rest[vertex] = 0.5 * (mesh.rest[a] + mesh.rest[b]);
  for (size_t t = 0; t < mesh.mids.size(); ++t)
    for (int k = 0; k < 6; ++k)
      mesh.rest[mesh.mids[t][k]] =
          0.5 * (mesh.rest[mesh.tets[t][kTetEdges[k][0]]] + mesh.rest[mesh.tets[t][kTetEdges[k][1]]]);
}

bool is_valid(const TetMesh& mesh) {
  for (int t = 0; t < mesh.tet_count(); ++t)
    if (!(volume(mesh, t) > 0)) return false;
  return true;
}

class Unloading {
 public:
  Unloading(const Experiment& scanned, const std::string& material, std::span<const MaterialParameters> parameters,
            const EquilibriumOptions& options)
      : scanned_(scanned), material_(material), parameters_(parameters), options_(options), is_scanned_(count(), 0) {
    options_.tolerance = std::min(options_.tolerance, kTolerance);
    for (const Tet& tet : scanned.mesh.tets)
      for (const int v : tet) is_scanned_[v] = 1;
    for (const Midpoint& m : scanned.midpoints) is_scanned_[m.vertex] = 0;
    for (const int v : scanned.fixed) is_scanned_[v] = 0;  // they do not move
  }

  UnloadedShape find() {
    Experiment shape = scanned_;
    std::vector<double> x = rest_positions(scanned_.mesh);
    double sag = 0, before = INFINITY;
    for (int round = 0; round < kMaxRounds; ++round) {
      if (!is_valid(shape.mesh)) return failed("tets of the unloaded shape are inverted");
      const std::string failure = balance(shape.mesh, x);
      if (!failure.empty()) return failed(failure);
      const double distance = correct(shape.mesh, x);
      sag = std::max(sag, distance);
      if (distance <= kClose * sag || (distance <= kStalled * sag && distance >= 0.5 * before)) {
        shape.scan_gravity.reset();
        for (const SurfacePoint& marker : scanned_.markers) shape.marker_offset.push_back(offset(marker, x));
        return {std::move(shape), ""};
      }
      before = distance;
    }
    return failed("its equilibrium remains " + three_digits(before) + " m away from the scan");
  }

 private:
  size_t count() const { return scanned_.mesh.rest.size(); }

  UnloadedShape failed(const std::string& why) const {
    return {{}, "no unloaded shape of the scanned mesh was found: " + why + "; the body is too soft for its weight"};
  }

  // Equilibrium of this shape from x; a message if there is none.
  std::string balance(const TetMesh& mesh, std::vector<double>& x) const {
    ModelBuilder builder(mesh);
    builder.material(material_, parameters_)
        .density(scanned_.density)
        .mass(MassKind::lumped)
        .pin("fixed", scanned_.fixed);
    Model model = builder.build();
    std::vector<double> weight(x.size());
    for (int t = 0; t < mesh.tet_count(); ++t)
      add_body_force(mesh, t, model.density[t] * *scanned_.scan_gravity, weight);
    model.loads.push_back(make_linear_load("gravity", std::move(weight)));
    Equilibrium equilibrium(std::move(model), x, options_);
    if (!is_success(equilibrium.solve().status)) return equilibrium.failure();
    x.assign(equilibrium.x().begin(), equilibrium.x().end());
    return "";
  }

  // From the point of the equilibrium to that of the scan.
  Vec3d offset(const SurfacePoint& marker, std::span<const double> x) const {
    Vec3d d{};
    for (int i = 0; i < 3; ++i) {
      const int v = marker.vertices[i];
      d = d + marker.weights[i] * (scanned_.mesh.rest[v] - point(x, v));
    }
    return d;
  }

  // Moves the shape by the distance of x from the scan; returns the largest.
  double correct(TetMesh& mesh, std::span<const double> x) const {
    double largest = 0;
    for (size_t v = 0; v < count(); ++v) {
      if (!is_scanned_[v]) continue;
      const Vec3d d = scanned_.mesh.rest[v] - point(x, static_cast<int>(v));
      mesh.rest[v] = mesh.rest[v] + d;
      largest = std::max(largest, norm(d));
    }
    center(scanned_.midpoints, mesh);
    return largest;
  }

  const Experiment& scanned_;
  const std::string& material_;
  std::span<const MaterialParameters> parameters_;
  EquilibriumOptions options_;
  std::vector<char> is_scanned_;  // free corners of the mesh of the data
};

}  // namespace

UnloadedShape unloaded(const Experiment& scanned, const std::string& material,
                       std::span<const MaterialParameters> parameters, const EquilibriumOptions& options) {
  if (!scanned.scan_gravity) return {scanned, ""};
  return Unloading(scanned, material, parameters, options).find();
}

}  // namespace aspic
