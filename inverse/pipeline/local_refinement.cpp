#include "pipeline/local_refinement.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "data/surface_projection.h"
#include "mesh/surface.h"
#include "mesh/tet_nodes.h"
#include "pipeline/bisection.h"

namespace aspic {
namespace {

constexpr double kEdge = 0.5;                  // longest edge below an indenter, relative to its radius. Chosen
constexpr double kReach = 1.1, kDepth = 0.25;  // of the refined surface layer, relative to the radius. Chosen
constexpr int kRimGenerations = 3;             // bisections that halve all edges of a tet

// Corners of the tets of a mesh; those of quadratic tets are not their mid-edge nodes.
struct Corners {
  explicit Corners(const TetMesh& mesh) : number(mesh.rest.size(), -1) {
    for (const Tet& tet : mesh.tets)
      for (const int v : tet) number[v] = 0;
    int next = 0;
    for (size_t v = 0; v < number.size(); ++v)
      if (number[v] == 0) number[v] = next++, rest.push_back(mesh.rest[v]);
    for (const Tet& tet : mesh.tets) tets.push_back({number[tet[0]], number[tet[1]], number[tet[2]], number[tet[3]]});
  }

  std::vector<int> number;  // of the corner at each vertex; -1: none
  std::vector<Vec3d> rest;
  std::vector<Tet> tets;
};

// A set of vertices that are held, or moved by a grip, on the mesh of the data and on refined ones.
class HeldSet {
 public:
  HeldSet(const TetMesh& mesh, const Corners& corners, const std::vector<int>& vertices)
      : corners_(corners.rest.size(), 0) {
    std::vector<char> is_held(mesh.rest.size(), 0);
    for (const int v : vertices) is_held[v] = 1;
    for (size_t v = 0; v < is_held.size(); ++v)
      if (corners.number[v] >= 0) corners_[corners.number[v]] = is_held[v];
    for (int t = 0; t < mesh.tet_count(); ++t) {
      const Tet& tet = corners.tets[t];
      if (!mesh.mids.empty())
        for (int k = 0; k < 6; ++k)
          middles_[std::minmax({tet[kTetEdges[k][0]], tet[kTetEdges[k][1]]})] = is_held[mesh.mids[t][k]];
      if (all_held(tet)) places_.push_back(sorted(tet));
    }
    const TetMesh linear{.rest = corners.rest, .tets = corners.tets, .region = {}};
    for (const Triangle& face : boundary_triangles(linear, 0, linear.tet_count())) {
      if (all_held(face))
        places_.push_back(sorted(face));
      else
        for (const int v : face)
          if (corners_[v]) rim_.push_back(v);
    }
    std::sort(rim_.begin(), rim_.end());
    rim_.erase(std::unique(rim_.begin(), rim_.end()), rim_.end());
  }

  const std::vector<int>& rim() const { return rim_; }  // held corners of free boundary triangles

  // Whether a point is held: a corner, a middle of an edge, or in a held boundary triangle or tet.
  bool holds(const std::vector<int>& support, bool is_middle) const {
    if (!std::all_of(support.begin(), support.end(), [&](int v) { return corners_[v] != 0; })) return false;
    if (support.size() == 1) return true;
    if (support.size() == 2 && is_middle && !middles_.empty()) return middles_.at({support[0], support[1]});
    return std::any_of(places_.begin(), places_.end(), [&](const std::vector<int>& place) {
      return std::includes(place.begin(), place.end(), support.begin(), support.end());
    });
  }

 private:
  template <class Nodes>
  bool all_held(const Nodes& nodes) const {
    return std::all_of(nodes.begin(), nodes.end(), [&](int v) { return corners_[v] != 0; });
  }
  template <class Nodes>
  static std::vector<int> sorted(const Nodes& nodes) {
    std::vector<int> result(nodes.begin(), nodes.end());
    std::sort(result.begin(), result.end());
    return result;
  }

  std::vector<char> corners_;
  std::map<std::pair<int, int>, char> middles_;
  std::vector<std::vector<int>> places_;  // held boundary triangles and tets
  std::vector<int> rim_;
};

// The place that an indenter touches at rest.
struct Contact {
  Vec3d center{}, axis{};
  double radius = 0;

  // Whether a point lies below the indenter, near the surface.
  bool touches(const Vec3d& X) const {
    const Vec3d d = X - center;
    return norm(d) < kReach * radius && std::abs(dot(d, axis)) < kDepth * radius;
  }
};

class LocalRefinement {
 public:
  explicit LocalRefinement(const Experiment& coarse)
      : coarse_(coarse), corners_(coarse.mesh), mesh_(corners_.rest, corners_.tets), is_rim_(corners_.rest.size(), 0) {
    fixed_.emplace_back(coarse.mesh, corners_, coarse.fixed);
    bool has_grip = false;
    for (const LoadCase& load : coarse.cases) {
      if (load.grip) has_grip = true, mark_rim(held(load.grip->vertices));
      if (load.indenter) add_contact(load);
    }
    if (has_grip) mark_rim(fixed_.front());
  }

  Experiment refined() {
    const size_t most = kMostGrowth * corners_.tets.size();
    for (size_t before = 0; before != mesh_.parts().size() && mesh_.parts().size() < most;) {
      before = mesh_.parts().size();
      mesh_.bisect([&](const BisectedMesh::Part& part) { return is_large(part); });
    }
    if (mesh_.parts().size() == corners_.tets.size()) return coarse_;
    put_mesh();
    fine_.fixed = vertices_in(fixed_.front());
    fine_.errors = coarse_.errors;
    fine_.scan_gravity = coarse_.scan_gravity;
    const SurfaceProjection surface(fine_.mesh);
    for (const SurfacePoint& marker : coarse_.markers)
      fine_.markers.push_back(surface.nearest(position(marker, coarse_.mesh.rest)).point);
    for (LoadCase load : coarse_.cases) {
      if (load.grip) load.grip->vertices = vertices_in(held(load.grip->vertices));
      fine_.cases.push_back(std::move(load));
    }
    return std::move(fine_);
  }

 private:
  const HeldSet& held(const std::vector<int>& vertices) {
    const auto [place, is_new] = grips_.try_emplace(vertices, static_cast<int>(fixed_.size()));
    if (is_new) fixed_.emplace_back(coarse_.mesh, corners_, vertices);
    return fixed_[place->second];
  }

  void add_contact(const LoadCase& load) {
    Contact contact{load.touch.center, PlacedIndenter(load.touch).pose.axis, load.indenter->radius};
    if (load.indenter->shape == IndenterShape::sphere) contact.center = contact.center + contact.radius * contact.axis;
    const auto is_same = [&](const Contact& c) {
      return norm(c.center - contact.center) == 0 && c.radius == contact.radius;
    };
    if (std::none_of(contacts_.begin(), contacts_.end(), is_same)) contacts_.push_back(contact);
  }

  void mark_rim(const HeldSet& set) {
    for (const int v : set.rim()) is_rim_[v] = 1;
  }

  bool is_large(const BisectedMesh::Part& part) const {
    const bool is_at_rim = std::any_of(part.tet.begin(), part.tet.end(),
                                       [&](int v) { return v < static_cast<int>(is_rim_.size()) && is_rim_[v]; });
    if (is_at_rim && part.generation < kRimGenerations) return true;
    const double size = mesh_.longest_edge(part.tet);
    return std::any_of(contacts_.begin(), contacts_.end(), [&](const Contact& c) {
      const auto is_touched = [&](int v) { return c.touches(mesh_.rest()[v]); };
      return size > kEdge * c.radius && std::any_of(part.tet.begin(), part.tet.end(), is_touched);
    });
  }

  void put_mesh() {
    TetMesh& mesh = fine_.mesh;
    mesh.rest = mesh_.rest();
    fine_.midpoints = mesh_.midpoints();
    for (const BisectedMesh::Part& part : mesh_.parts()) {
      mesh.tets.push_back(part.tet);
      fine_.parent.push_back(coarse_.parent.empty() ? part.parent : coarse_.parent[part.parent]);
      if (!coarse_.mesh.region.empty()) mesh.region.push_back(coarse_.mesh.region[part.parent]);
      if (!coarse_.density.empty()) fine_.density.push_back(coarse_.density[part.parent]);
    }
    for (int v = 0; v < mesh.vertex_count(); ++v) support_.push_back(mesh_.support(v));
    if (coarse_.mesh.mids.empty()) return;
    mesh = raise_order(std::move(mesh));
    support_.resize(mesh.rest.size());
    for (int t = 0; t < mesh.tet_count(); ++t)
      for (int k = 0; k < 6; ++k) {
        const Tet& tet = mesh.tets[t];
        support_[mesh.mids[t][k]] = united(support_[tet[kTetEdges[k][0]]], support_[tet[kTetEdges[k][1]]]);
      }
  }

  std::vector<int> vertices_in(const HeldSet& set) const {
    std::vector<int> result;
    for (int v = 0; v < fine_.mesh.vertex_count(); ++v) {
      const std::vector<int>& s = support_[v];
      const bool is_middle =
          s.size() == 2 && norm(fine_.mesh.rest[v] - 0.5 * (corners_.rest[s[0]] + corners_.rest[s[1]])) == 0;
      if (set.holds(s, is_middle)) result.push_back(v);
    }
    return result;
  }

  const Experiment& coarse_;
  Corners corners_;
  BisectedMesh mesh_;
  Experiment fine_;
  std::vector<HeldSet> fixed_;             // the fixed vertices, then those of grips
  std::map<std::vector<int>, int> grips_;  // index of a grip's vertices
  std::vector<char> is_rim_;               // per corner
  std::vector<Contact> contacts_;
  std::vector<std::vector<int>> support_;  // of the vertices of the fine mesh
};

}  // namespace

Experiment locally_refined(const Experiment& experiment) {
  const auto has_pressure = [](const LoadCase& load) { return !load.pressed.empty(); };
  if (std::any_of(experiment.cases.begin(), experiment.cases.end(), has_pressure)) return experiment;
  return LocalRefinement(experiment).refined();
}

}  // namespace aspic
