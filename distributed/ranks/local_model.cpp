#include "ranks/local_model.h"

#include <algorithm>
#include <array>
#include <memory>
#include <numeric>
#include <optional>

#include "base/check.h"
#include "base/error.h"
#include "energy/linear_load.h"
#include "math/vectors.h"
#include "ranks/exchange.h"
#include "ranks/guarded.h"
#include "ranks/shared_terms.h"
#include "scene/body_actions.h"
#include "scene/body_material.h"
#include "scene/placement.h"
#include "scene/scene_builder.h"

namespace aspic::distributed {
namespace {

// What selections found on this rank, in the order of the document.
struct Selections {
  std::vector<std::string> error;
  std::vector<double> is_here;

  // Throws if none of the ranks found anything. Collective.
  void require_some() {
    max_over_ranks(is_here);
    all_succeed([&] {
      for (size_t i = 0; i < error.size(); ++i)
        if (is_here[i] == 0) throw InvalidInput(error[i]);
    });
  }
};

class BodyOfRanks : public WholeBody {
 public:
  BodyOfRanks(const RankScene& scene, size_t body, std::vector<int> vertices, Selections& selections)
      : share_(scene.share),
        range_(share_.of_bodies[body]),
        facts_(scene.bodies[body]),
        first_tet_(share_.bodies[body].first_tet),
        vertices_(std::move(vertices)),
        selections_(selections) {}

  int vertex_count() const override { return range_.vertex_count; }
  int number_of_vertex(int v) const override { return share_.user_vertex[vertices_[v]] - range_.first_vertex; }
  int number_of_tet(int t) const override { return share_.user_tet[first_tet_ + t] - range_.first_tet; }
  int vertex_of_part(int number) const override {
    if (by_number_.empty())
      for (size_t v = 0; v < vertices_.size(); ++v)
        by_number_.emplace_back(number_of_vertex(static_cast<int>(v)), static_cast<int>(v));
    if (!std::is_sorted(by_number_.begin(), by_number_.end())) std::sort(by_number_.begin(), by_number_.end());
    const auto found = std::lower_bound(by_number_.begin(), by_number_.end(), std::pair{number, 0});
    return found != by_number_.end() && found->first == number ? found->second : -1;
  }
  bool is_own(int v) const override { return vertices_[v] < share_.own(); }
  const Box& box() const override { return facts_.box; }
  std::pair<double, double> heights(const Vec3d& up) const override {
    if (facts_.corners.empty()) return facts_.heights;
    std::pair<double, double> range = {INFINITY, -INFINITY};
    for (const Vec3d& X : facts_.corners)
      range = {std::min(range.first, dot(up, X)), std::max(range.second, dot(up, X))};
    return range;
  }
  void note_selection(const std::string& error, bool is_selected_here) const override {
    selections_.error.push_back(error);
    selections_.is_here.push_back(is_selected_here ? 1 : 0);
  }

 private:
  const MeshShare& share_;
  BodyRange range_;
  const BodyFacts& facts_;
  int first_tet_;
  std::vector<int> vertices_;  // of the model, own ones first
  Selections& selections_;
  mutable std::vector<std::pair<int, int>> by_number_;
};

// The order of the loads in the models of scenes.
constexpr const char* kLoads[] = {"gravity", "body_force", "traction"};

class Maker {
 public:
  Maker(LocalSource source, const Share& share)
      : scene_(source.scene), document_(source.document), files_(std::move(source.files)) {
    local_.model.share = share;
  }

  LocalModel make() {
    all_succeed([&] { add_bodies(); });
    set_centers();
    selections_ = {};
    all_succeed([&] { add_model(); });
    selections_.require_some();
    unify_loads();
    for (std::unique_ptr<Energy>& damping : model().damping)
      damping = make_shared_damping(std::move(damping), 3 * scene_.share.own(), model().share);
    return std::move(local_);
  }

 private:
  Model& model() { return local_.model; }

  void add_bodies() {
    model().mesh = std::move(scene_.mesh);
    Array& scenes = document_.find("body")->array();
    bodies_.reserve(scenes.size());
    for (size_t b = 0; b < scenes.size(); ++b) add_body(scenes[b], b);
    if (!scene_.q.empty()) {
      local_.start.q = std::move(scene_.q);
      local_.start.qdot = std::move(scene_.qdot);
    } else {
      add_start();
    }
  }

  // The local vertices of a body, the own ones first.
  std::vector<int> vertices_of(const BodyRange& body) const {
    const std::vector<int>& numbers = scene_.share.vertex;
    std::vector<int> vertices;
    for (const auto& [begin, end] :
         {std::pair{0, scene_.share.own()}, {scene_.share.own(), scene_.share.local_vertices()}}) {
      const auto first = std::lower_bound(numbers.begin() + begin, numbers.begin() + end, body.first_vertex);
      const auto last = std::lower_bound(first, numbers.begin() + end, body.first_vertex + body.vertex_count);
      for (auto v = first; v != last; ++v) vertices.push_back(static_cast<int>(v - numbers.begin()));
    }
    return vertices;
  }

  void add_body(Value& scene, size_t b) {
    const MeshShare& share = scene_.share;
    const BodyRange& range = share.of_bodies[b];
    const MeshShare::Body& tets = share.bodies[b];
    PlacedBody body{scene, {}, {}, 0, tets.first_tet};
    body.part_vertices = vertices_of(range);
    wholes_.push_back(std::make_unique<BodyOfRanks>(scene_, b, body.part_vertices, selections_));
    body.whole = wholes_.back().get();
    std::vector<int> own_number(model().mesh.rest.size(), -1);
    for (const int v : body.part_vertices) {
      own_number[v] = body.mesh.vertex_count();
      body.mesh.rest.push_back(model().mesh.rest[v]);
    }
    for (int t = tets.first_tet; t < tets.first_tet + tets.counted + tets.halo; ++t) {
      Tet tet = model().mesh.tets[t];
      for (int& v : tet) v = own_number[v];
      body.mesh.tets.push_back(tet);
      if (!model().mesh.region.empty()) body.mesh.region.push_back(model().mesh.region[t]);
    }
    body.painted = std::make_shared<PaintedFields>(placement_of(scene), files_, body.name());
    if (scene_.q.empty()) {
      body.start = deformed(scene, body.mesh.rest, files_, body.name(), body.whole);
    } else {
      for (const int v : body.part_vertices) body.start.push_back(vec_at(scene_.q, v));
    }
    const int own = static_cast<int>(
        std::count_if(body.part_vertices.begin(), body.part_vertices.end(), [&](int v) { return v < share.own(); }));
    const int first = own > 0 ? body.part_vertices[0] : 0;
    model().bodies.push_back({range.name, first, own, tets.first_tet, tets.counted + tets.halo});
    bodies_.push_back(std::move(body));
  }

  void add_start() {
    State& start = local_.start;
    start.q.resize(3 * model().mesh.rest.size());
    start.qdot = start.q;
    for (const PlacedBody& body : bodies_) {
      const std::vector<double> no_mass(body.start.size(), 0.0);  // only matters for rotations
      std::vector<Vec3d> v;
      try {
        v = velocities(body.scene, body.mesh.rest, body.start, no_mass);
      } catch (const InvalidInput& e) {
        throw error_at(body.scene["velocity"].place, e.what());
      }
      for (size_t i = 0; i < v.size(); ++i) {
        set_vec(body.start[i], body.part_vertices[i], start.q);
        set_vec(v[i], body.part_vertices[i], start.qdot);
      }
    }
  }

  Vec3d up() const {
    const Vec3d gravity = document_.find("gravity")->vector();
    const double g = norm(gravity);
    return g > 0 ? (-1 / g) * gravity : Vec3d{{0, 1, 0}};
  }

  // A rotation without a center is about the mean of all vertices of its pin.
  void set_centers() {
    for (PlacedBody& body : bodies_) {
      Value* pins = body.scene.table().find("pin");
      if (!pins) continue;
      for (Value& pin : pins->array()) {
        Value* motion = pin.table().find("motion");
        Value* rotate = motion && motion->is_table() ? motion->table().find("rotate") : nullptr;
        if (rotate && !rotate->find("center")) set_center(body, pin, *rotate);
      }
    }
  }

  void set_center(const PlacedBody& body, Value& pin, Value& rotate) {
    double sums[4] = {};
    all_succeed([&] {
      Value& where = *pin.table().find("where");
      for (const int v : select_vertices(where, selection_scope(body, where, up()))) {
        if (!body.whole->is_own(v)) continue;
        for (int r = 0; r < 3; ++r) sums[r] += body.start[v][r];
        ++sums[3];
      }
    });
    model().share.sum(sums);
    if (sums[3] == 0) return;  // reported later
    Array center;
    for (int r = 0; r < 3; ++r) center.push_back({sums[r] / sums[3], rotate.place});
    rotate.table().set("center", {center, rotate.place});
  }

  void add_model() {
    const Value& solver = *document_.find("solver");
    const MassKind kind = solver["mass"].text() == "lumped" ? MassKind::lumped : MassKind::consistent;
    add_materials();
    model().mass = std::make_unique<MassMatrix>(model().mesh, model().density, kind);
    const SceneActions actions = {bodies_,
                                  document_.find("gravity")->vector(),
                                  document_.find("time")->find("duration")->number(),
                                  kind,
                                  files_,
                                  local_.notes,
                                  std::numeric_limits<std::int64_t>::max()};
    add_pins(actions, model());
    add_loads_and_damping(actions, model());
  }

  void add_materials() {
    const bool is_given = !scene_.density.empty();
    for (size_t b = 0; b < bodies_.size(); ++b) {
      const MeshShare::Body& tets = scene_.share.bodies[b];
      BodyMaterial material;
      if (is_given) {
        const auto first = tets.first_tet, last = first + tets.counted + tets.halo;
        material = {scene_.materials[b],
                    {scene_.parameters.begin() + first, scene_.parameters.begin() + last},
                    {scene_.density.begin() + first, scene_.density.begin() + last}};
      } else {
        material = body_material(bodies_[b], files_, local_.notes);
      }
      model().density.insert(model().density.end(), material.density.begin(), material.density.end());
      export_moduli(material.parameters, model());
      const std::span<const MaterialParameters> all(material.parameters);
      ElasticityOfRank parts;
      parts.counted = make_tet_elasticity(material.model, model().mesh, tets.first_tet, all.first(tets.counted));
      parts.halo =
          make_tet_elasticity(material.model, model().mesh, tets.first_tet + tets.counted, all.subspan(tets.counted));
      model().elasticity.push_back(make_shared_elasticity(std::move(parts), model().share));
    }
  }

  // A load of one rank is a load of all.
  void unify_loads() {
    std::vector<std::unique_ptr<Energy>> loads = std::move(model().loads);
    model().loads.clear();
    const int own = 3 * scene_.share.own();
    double exists[std::size(kLoads)] = {};
    for (size_t k = 0; k < std::size(kLoads); ++k)
      exists[k] = std::any_of(loads.begin(), loads.end(), [&](const auto& V) { return V->name() == kLoads[k]; });
    max_over_ranks(exists);
    size_t next = 0;
    for (size_t k = 0; k < std::size(kLoads); ++k) {
      if (exists[k] == 0) continue;
      std::unique_ptr<Energy> load;
      if (next < loads.size() && loads[next]->name() == kLoads[k])
        load = std::move(loads[next++]);
      else
        load = make_linear_load(kLoads[k], std::vector<double>(3 * model().mesh.rest.size(), 0.0));
      model().loads.push_back(make_shared_load(std::move(load), own, model().share));
    }
    ASPIC_CHECK(next == loads.size());
  }

  RankScene& scene_;
  Table& document_;
  SceneFiles files_;
  LocalModel local_;
  Selections selections_;
  std::vector<std::unique_ptr<BodyOfRanks>> wholes_;
  std::vector<PlacedBody> bodies_;
};

}  // namespace

LocalModel make_local_model(LocalSource source, const Share& share) { return Maker(std::move(source), share).make(); }

}  // namespace aspic::distributed
