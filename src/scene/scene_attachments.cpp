#include "scene/scene_attachments.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>

#include "contact/barrier.h"
#include "energy/attachment.h"
#include "mesh/box_tree.h"
#include "mesh/distance.h"
#include "mesh/locate.h"
#include "mesh/surface.h"
#include "mesh/tet_nodes.h"
#include "scene/selection.h"

namespace aspic {
namespace {

// The vertices of an attachment in the numbering of their bodies.
struct NearestPoint {
  std::vector<int> vertices;  // of the target
  std::vector<double> weights;
  double distance = 0;  // [m]

  void add(int vertex, double weight) {
    constexpr double kRoundOff = 1e-9;
    if (weight < kRoundOff) return;
    vertices.push_back(vertex);
    weights.push_back(weight);
  }
};

std::vector<Triangle> surface_of(const TetMesh& mesh) {
  return mesh.sheet.empty() ? boundary_triangles(mesh, 0, mesh.tet_count()) : mesh.sheet;
}

// The selected part of a body at the start: its tets, surface triangles, edges and vertices whose corners are all
// selected. The parts of quadratic tets are linear.
class AttachTarget {
 public:
  // is_selected: one per vertex; empty: the whole body.
  AttachTarget(const PlacedBody& body, const std::vector<char>& is_selected)
      : parts_(linear_parts(body.mesh).mesh), tree_(select(body, is_selected)) {
    if (!parts_.tets.empty()) tets_.emplace(parts_);
  }

  NearestPoint nearest(const Vec3d& p) const {
    NearestPoint best;
    if (tets_) {
      const Located inside = tets_->locate(p);
      if (!inside.is_outside()) {
        for (int i = 0; i < 4; ++i) best.add(parts_.tets[inside.tet][i], inside.weights[i]);
        return best;
      }
    }
    double reach = std::numeric_limits<double>::infinity();
    int nearest = -1;
    Distance there;
    tree_.for_each_near(p, reach, [&](int i) {
      const Triangle& t = features_[i];
      const Distance here = point_triangle_distance({p, parts_.rest[t[0]], parts_.rest[t[1]], parts_.rest[t[2]]});
      if (nearest >= 0 && (here.d > there.d || (here.d == there.d && i > nearest))) return;
      nearest = i, there = here, reach = here.d * here.d;
    });
    best.distance = there.d;
    for (int i = 1; i < there.count; ++i) best.add(features_[nearest][there.point[i] - 1], -there.c[i]);
    return best;
  }

 private:
  std::vector<Box> select(const PlacedBody& body, const std::vector<char>& is_selected) {
    parts_.rest = body.start;
    features_ = surface_of(body.mesh);
    if (!is_selected.empty()) {
      const auto is_whole = [&](const auto& corners) {
        return std::all_of(corners.begin(), corners.end(), [&](int v) { return is_selected[v] != 0; });
      };
      std::vector<Triangle> features;  // an edge or a vertex repeats its last corner
      for (const Triangle& t : features_)
        for (int c = 0; c < 3; ++c) {
          const Triangle edge = {t[c], t[(c + 1) % 3], t[(c + 1) % 3]};
          if (c == 0 && is_whole(t)) features.push_back(t);
          if (!is_whole(t) && is_whole(edge)) features.push_back(edge);
        }
      for (int v = 0; v < body.mesh.vertex_count(); ++v)
        if (is_selected[v]) features.push_back({v, v, v});
      features_ = std::move(features);
      std::erase_if(parts_.tets, [&](const Tet& tet) { return !is_whole(tet); });
    }
    std::vector<Box> boxes(features_.size());
    for (size_t i = 0; i < boxes.size(); ++i)
      for (const int v : features_[i]) boxes[i].add(parts_.rest[v]);
    return boxes;
  }

  TetMesh parts_;                   // at the start
  std::vector<Triangle> features_;  // triangles, edges and vertices
  BoxTree tree_;
  std::optional<TetLocator> tets_;
};

// Mean edge of the surface at rest [m].
double mean_edge(const TetMesh& mesh) {
  const std::vector<Triangle> surface = surface_of(mesh);
  double sum = 0;
  for (const Triangle& t : surface)
    for (int c = 0; c < 3; ++c) sum += norm(mesh.rest[t[c]] - mesh.rest[t[(c + 1) % 3]]);
  return sum / (3.0 * static_cast<double>(surface.size()));
}

class AttachmentBuilder {
 public:
  AttachmentBuilder(const std::vector<PlacedBody>& bodies, const Model& model, const Vec3d& gravity)
      : bodies_(bodies), model_(model), up_(norm(gravity) > 0 ? (-1 / norm(gravity)) * gravity : Vec3d{{0, 1, 0}}) {}

  // Adds the springs of a table. Returns a note.
  std::string add(Value& table) {
    Value &points = *table.table().find("points"), &to = *table.table().find("to");
    const size_t of_points = body_of(points), of_target = body_of(to);
    const PlacedBody &body = bodies_[of_points], &target = bodies_[of_target];
    const std::vector<int> vertices = selected(points, body);
    std::vector<char> is_target;
    if (to.find("where")) {
      is_target.resize(target.mesh.rest.size());
      for (const int v : selected(to, target)) is_target[v] = 1;
    }
    if (of_points == of_target) require_disjoint(to, body, vertices, is_target);
    const AttachTarget near(target, is_target);
    std::vector<NearestPoint> found;
    for (const int v : vertices) found.push_back(near.nearest(body.start[v]));
    require_near(table, body, target, vertices, found);
    const double stiffness = stiffness_of(table, of_points, of_target);
    const bool keeps_gap = table["gap"].text() == "keep";
    const double closed = contact_distance(static_cast<int>(of_points), static_cast<int>(of_target));
    double largest = 0;
    for (size_t i = 0; i < vertices.size(); ++i) {
      AttachedVertex a{.vertex = body.model_vertex(vertices[i]), .stiffness = stiffness};
      double sum = 0;
      for (const double w : found[i].weights) sum += w;
      for (const int v : found[i].vertices) {
        a.weight[a.count] = found[i].weights[a.count] / sum;
        a.target[a.count++] = target.model_vertex(v);
      }
      a.rest_length = keeps_gap ? found[i].distance : closed;
      largest = std::max(largest, found[i].distance);
      attached_.push_back(a);
    }
    return std::to_string(vertices.size()) + " vertices of body '" + body.name() + "' are attached to '" +
           target.name() + "', at most " + three_digits(largest) + " m apart at the start, with " +
           three_digits(stiffness) + " N/m each";
  }

  std::vector<AttachedVertex> take() { return std::move(attached_); }

 private:
  size_t body_of(const Value& end) const {
    const Value& name = end["body"];
    std::vector<std::string> names;
    for (const PlacedBody& body : bodies_) {
      if (body.name() == name.text()) return names.size();
      names.push_back(body.name());
    }
    throw error_at(name.place,
                   "body = " + toml_string(name.text()) + "; there is no such body" + suggestion(name.text(), names));
  }

  std::vector<int> selected(Value& end, const PlacedBody& body) const {
    Value& where = *end.table().find("where");
    return select_vertices(where, selection_scope(body, where, up_));
  }

  static void require_disjoint(const Value& to, const PlacedBody& body, const std::vector<int>& vertices,
                               const std::vector<char>& is_target) {
    if (is_target.empty())
      throw error_at(to.place,
                     "body '" + body.name() + "' is attached to itself; select the other place with where in `to`");
    for (const int v : vertices)
      if (is_target[v])
        throw error_at(to["where"].place, "vertex " + std::to_string(body.user_vertex(v)) + " of body '" + body.name() +
                                              "' at " + point_text(body.mesh.rest[v]) +
                                              " is selected in `points` and in `to`; exclude it from one of them");
  }

  static void require_near(const Value& table, const PlacedBody& body, const PlacedBody& target,
                           const std::vector<int>& vertices, const std::vector<NearestPoint>& found) {
    const Value* given = table.find("distance");
    const double most = given ? given->number() : mean_edge(target.mesh);
    const auto is_far = [most](const NearestPoint& point) { return !(point.distance <= most); };
    const auto first = std::find_if(found.begin(), found.end(), is_far);
    if (first == found.end()) return;
    const int v = vertices[first - found.begin()];
    double largest = 0;
    for (const NearestPoint& point : found) largest = std::max(largest, point.distance);
    throw error_at((given ? *given : table).place,
                   "vertex " + std::to_string(body.user_vertex(v)) + " of body '" + body.name() + "' at " +
                       point_text(body.start[v]) + " is " + three_digits(first->distance) + " m from body '" +
                       target.name() + "', beyond distance = " + three_digits(most) + (given ? "" : ", its mean edge") +
                       ", as " + std::to_string(std::count_if(found.begin(), found.end(), is_far)) + " of " +
                       std::to_string(found.size()) + " vertices are (select fewer, move the bodies closer, or set " +
                       "distance = " + three_digits(1.01 * largest) + ")");
  }

  // Returns the distance at which contact of two bodies begins, where it does not push attached places apart; 0 without
  // contact.
  double contact_distance(int a, int b) const {
    if (!model_.contact) return 0;
    const ContactLaw &first = model_.contact->laws()(a, b), &second = model_.contact->laws()(b, a);
    return std::max(first.offset + first.reach, second.offset + second.reach);
  }

  // Returns Young's modulus times the thickness of a sheet, or times the mean edge of a solid; 0 without elasticity.
  double own_stiffness(size_t b) const {
    const BodyRange& range = model_.bodies[b];
    const std::vector<double>& young = model_.tet_fields[0].second;
    double smallest = 0;
    for (int e = range.first_element(model_.mesh); e < range.first_element(model_.mesh) + range.element_count(); ++e)
      if (young[e] > 0 && (smallest == 0 || young[e] < smallest)) smallest = young[e];
    return smallest * (range.is_sheet() ? bodies_[b].mesh.thickness[0] : mean_edge(bodies_[b].mesh));
  }

  double stiffness_of(const Value& table, size_t a, size_t b) const {
    if (const Value* given = table.find("stiffness")) return given->number();
    const double first = own_stiffness(a), second = own_stiffness(b);
    if (first == 0 && second == 0)
      throw error_at(table.place, "neither body '" + bodies_[a].name() + "' nor '" + bodies_[b].name() +
                                      "' is elastic, so the attachment has no default stiffness; set stiffness [N/m]");
    return first == 0 || second == 0 ? std::max(first, second) : std::min(first, second);
  }

  const std::vector<PlacedBody>& bodies_;
  const Model& model_;
  Vec3d up_;
  std::vector<AttachedVertex> attached_;
};

// `what`: body or obstacle.
Value& named(Array& list, const Value& name, const std::string& what) {
  std::vector<std::string> names;
  for (Value& item : list) {
    const Value* own = item.find("name");
    names.push_back(own ? own->text() : what + std::to_string(names.size() + 1));
    if (names.back() == name.text()) return item;
  }
  throw error_at(name.place, what + " = " + toml_string(name.text()) + "; there is no such " + what +
                                 suggestion(name.text(), names));
}

// Returns the motion of an obstacle as that of a pin of the body.
Value pin_motion(const Value& obstacle, const Value& body, const Value& name) {
  const auto refuse = [&](const std::string& why) {
    return error_at(name.place, "obstacle = " + toml_string(name.text()) + "; " + why);
  };
  if (const Value* recording = obstacle.find("recording")) {
    for (const char* key : {"translate", "rotate", "scale"}) {
      const Value *of_obstacle = obstacle.find(key), *of_body = body.find(key);
      if ((of_obstacle ? inline_toml(*of_obstacle) : "") != (of_body ? inline_toml(*of_body) : ""))
        throw refuse("its recording moves it, and `" + std::string(key) + "` of it and of body '" +
                     body["name"].text() + "' differ; place both alike, and model the body where it is attached");
    }
    Table table = recording->table();
    table.set("mesh", obstacle["mesh"]);
    Table motion;
    motion.set("recording", {table, recording->place});
    return {motion, recording->place};
  }
  const Value& motion = obstacle["motion"];
  const Value* spin = motion.is_table() ? motion.find("rotate") : nullptr;
  if (spin && !spin->find("center"))
    throw error_at(spin->place, "rotate has no center, which body '" + body["name"].text() +
                                    "' needs to follow; set center to the point about which the obstacle turns");
  return motion;
}

}  // namespace

void pin_to_obstacles(Table& document) {
  Value* attached = document.find("attach");
  if (!attached) return;
  Array others;
  for (Value& table : attached->array()) {
    const Value* name = table["to"].find("obstacle");
    if (!name) {
      others.push_back(table);
      continue;
    }
    for (const char* key : {"distance", "gap", "stiffness"})
      if (is_given(table.table(), key))
        throw error_at(table[key].place, std::string(key) +
                                             " is for springs between bodies; vertices attached to an "
                                             "obstacle follow it exactly (remove it)");
    Array none;
    Value* obstacles = document.find("obstacle");
    const Value& obstacle = named(obstacles ? obstacles->array() : none, *name, "obstacle");
    const Value& points = table["points"];
    Value& body = named(document.find("body")->array(), points["body"], "body");
    Table pin;
    pin.set("name", {"attach" + std::to_string(&table - attached->array().data() + 1), table.place});
    pin.set("where", points["where"]);
    pin.set("motion", pin_motion(obstacle, body, *name));
    pin.set("axes", {std::string("xyz"), {}});
    if (!body.find("pin")) body.table().set("pin", {Array{}, table.place});
    body.table().find("pin")->array().push_back({pin, table.place});
  }
  if (others.empty())
    erase(document, "attach");
  else
    attached->array() = others;
}

void add_attachments(Table& document, const std::vector<PlacedBody>& bodies, Model& model,
                     std::vector<std::string>& notes) {
  Value* tables = document.find("attach");
  if (!tables) return;
  AttachmentBuilder builder(bodies, model, document.find("gravity")->vector());
  for (Value& table : tables->array()) notes.push_back(builder.add(table));
  model.loads.push_back(std::make_unique<Attachment>(builder.take()));
}

}  // namespace aspic
