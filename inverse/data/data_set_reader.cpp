#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/function_ref.h"
#include "base/printable.h"
#include "data/capture_schema.h"
#include "data/case_table.h"
#include "data/data_findings.h"
#include "data/data_set.h"
#include "data/foreign_file.h"
#include "data/histories.h"
#include "data/patch_table.h"
#include "data/rigid_motion.h"
#include "data/scan_gravity.h"
#include "data/settings.h"
#include "data/stated_errors.h"
#include "data/surface_projection.h"
#include "data/units.h"
#include "data/unstated_values.h"
#include "io/mesh_file.h"
#include "mesh/box.h"
#include "mesh/tet_nodes.h"
#include "scene/placement.h"
#include "scene/selection.h"
#include "scene/tables.h"

namespace aspic {
namespace {

namespace fs = std::filesystem;

// A million readings take 1.3 GB (docs/fitting.md).
constexpr size_t kMaxMarkers = 1'000'000, kMaxReadings = 5'000'000;

void add_notes(const std::string& what, const std::vector<Finding>& findings, std::vector<std::string>& notes) {
  for (const Finding& f : findings) {
    const std::string sentence = what + ": " + f.message + (f.remedy.empty() ? "" : "; " + f.remedy);
    if (f.severity == Severity::error) throw InvalidInput(sentence);
    if (f.severity == Severity::warning) notes.push_back(sentence);
  }
}

class DataSetReader {
 public:
  DataSetReader(const fs::path& path, std::optional<RegistrationKind> registers)
      : settings_(path), registers_(registers) {
    data_.source.settings = settings_.file_name();
    data_.source.markers = settings_["markers"].text();
    data_.source.cases = settings_["cases"].text();
    data_.source.positions = settings_["positions"].text();
  }

  DataSet read() {
    read_name();
    read_rest();
    const SurfaceProjection surface(data_.experiment.mesh);
    register_markers(surface);
    read_markers(surface);
    read_indenters();
    read_grips();
    read_patches(surface);
    if (settings_.find("forces")) forces_ = read_force_series(settings_, errors_, data_.notes);
    read_cases(settings_, {indenters_, tip_sigmas_, grips_, patches_, surface, forces_ ? &*forces_ : nullptr}, errors_,
               data_);
    read_positions();
    errors_.finish();
    data_.experiment.errors = read_systematic_errors(settings_, data_.experiment.cases);
    const ForceSeries* series = forces_ ? &*forces_ : nullptr;
    if (has_histories(settings_)) add_end_forces(series, data_);
    choose_sigmas(data_);
    choose_layers(data_);
    if (has_histories(settings_)) take_histories(series, errors_, data_);
    errors_.finish();
    data_.name = printable(data_.name);
    for (std::string& note : data_.notes) note = printable(note);
    return std::move(data_);
  }

 private:
  void read_name() {
    const Value* name = settings_.find("name");
    data_.name = name ? name->text() : fs::absolute(settings_.folder()).lexically_normal().filename().string();
    if (data_.name.empty())
      data_.name = fs::absolute(settings_.folder()).lexically_normal().parent_path().filename().string();
  }

  void read_rest() {
    const fs::path path = settings_.file("mesh");
    user_mesh_ = read_tet_mesh(path, &data_.notes, &groups_);
    const double unit = settings_.unit("mesh");
    if (unit != 1)
      for (Vec3d& X : user_mesh_.rest) X = unit * X;
    add_notes(path.filename().string(), diagnose(user_mesh_), data_.notes);
    if (user_mesh_.mids.empty() && order() == 2) user_mesh_ = raise_order(std::move(user_mesh_));
    data_.is_order_reduced = user_mesh_.mids.empty() && !settings_.find("order");
    data_.numbering = locality_numbering(user_mesh_);
    data_.experiment.mesh = from_user(data_.numbering, user_mesh_);
    size_ = size_of(user_mesh_);
    PaintedFields painted({}, settings_.files(), data_.name);
    const std::vector<double> density =
        element_values(settings_.document(), capture_schema().key("capture", "density"),
                       {user_mesh_, settings_.files(), "density", painted, nullptr, &groups_});
    data_.experiment.density = data_.numbering.tet.from_user(density);
    read_fixed();
    if (const Value* gravity = settings_.find("mesh_gravity"))
      data_.experiment.scan_gravity = read_scan_gravity(settings_, *gravity);
  }

  int order() const {
    if (const Value* given = settings_.find("order")) return given->integer();
    return user_mesh_.tet_count() <= kMaxQuadratic ? 2 : 1;
  }

  SelectionScope scope() const {
    const Vec3d up = settings_["up"].vector();
    if (norm(up) == 0) throw error_at(settings_["up"].place, "up = [0, 0, 0]; it needs a direction");
    return {user_mesh_, (1 / norm(up)) * up, data_.name, nullptr, nullptr, &groups_};
  }

  void read_fixed() {
    if (const Value* where = settings_.find("fixed")) data_.experiment.fixed = selected(*where, "fixed");
  }

  // Returns ascending vertices of a list or a selection.
  std::vector<int> selected(const Value& where, const std::string& key) const {
    Value selection = where;
    if (where.is_array()) {
      if (where.array().empty()) return {};
      selection = {Table{}, where.place};
      selection.table().set("vertices", where);
      for (const Value& v : where.array())
        if (v.number() < 0) throw error_at(v.place, key + ": " + inline_toml(v) + " is no vertex; count from 0");
    }
    std::vector<int> vertices;
    for (const int v : select_vertices(selection, scope())) vertices.push_back(data_.numbering.vertex.from_user(v));
    std::sort(vertices.begin(), vertices.end());
    return vertices;
  }

  void read_grips() {
    const Value* grips = settings_.find("grip");
    if (!grips) return;
    const std::vector<Vec3d>& rest = data_.experiment.mesh.rest;
    const std::vector<int>& fixed = data_.experiment.fixed;
    for (const Value& g : grips->array()) {
      Grip grip{.vertices = selected(g["where"], "where")};
      if (grip.vertices.empty()) throw error_at(g["where"].place, "where: the grip holds no vertex; list some");
      for (const int v : grip.vertices) {
        if (std::binary_search(fixed.begin(), fixed.end(), v))
          throw error_at(g["where"].place, "where: the grip moves vertex " +
                                               std::to_string(data_.numbering.vertex.to_user(v)) +
                                               ", which is fixed; leave it out here or in fixed");
        grip.center = grip.center + (1.0 / static_cast<double>(grip.vertices.size())) * rest[v];
      }
      if (const Value* center = g.find("center")) grip.center = settings_.unit("length") * center->vector();
      for (const int v : grip.vertices) grip.radius = std::max(grip.radius, norm(rest[v] - grip.center));
      if (!grips_.try_emplace(g["name"].text(), grip).second)
        throw error_at(g["name"].place, "name = " + toml_string(g["name"].text()) + " is used by another grip");
    }
  }

  // The registration of the settings, or one that is found now.
  void register_markers(const SurfaceProjection& surface) {
    const Value* given = settings_.find("registration");
    if (given && registers_)
      throw error_at(given->place, "registration is given; remove the key, or do not use --register");
    if (given) to_mesh_ = read_registration(settings_.file("registration"));
    if (registers_) {
      data_.registration = found_registration(surface);
      to_mesh_ = data_.registration->to_mesh;
      data_.notes.push_back(text_of(*data_.registration));
    }
  }

  // The vertices of the triangles: others, such as those inside a body, are not on its surface. Without triangles all.
  static std::vector<Vec3d> surface_points(const TriMesh& scan) {
    std::vector<char> is_used(scan.vertices.size(), scan.triangles.empty());
    for (const Triangle& t : scan.triangles)
      for (const int v : t) is_used[v] = 1;
    std::vector<Vec3d> points;
    for (size_t v = 0; v < is_used.size(); ++v)
      if (is_used[v]) points.push_back(scan.vertices[v]);
    return points;
  }

  Registration found_registration(const SurfaceProjection& surface) {
    if (settings_.find("scan")) {
      std::vector<Vec3d> points = surface_points(read_tri_mesh(settings_.file("scan")));
      const double unit = settings_["units"].find("recording") ? settings_.unit("recording") : settings_.unit("length");
      for (Vec3d& p : points) p = unit * p;
      return register_to_surface(surface, points, *registers_);
    }
    std::vector<Vec3d> points, placed, targets;
    if (has_table("markers")) {
      ErrorList ignored;  // read_marker_table() reports errors of the table
      std::vector<std::string> notes;
      MeasuredTable table(settings_.file("markers"), settings_.columns("markers"), ignored, notes);
      while (table.next()) add_point(table, points, placed, targets);
    }
    if (placed.size() >= 3) return register_to_targets(placed, targets, *registers_);
    return register_to_surface(surface, points, *registers_);
  }

  // A marker with coordinates and a vertex is a pair of corresponding points.
  void add_point(MeasuredTable& table, std::vector<Vec3d>& points, std::vector<Vec3d>& placed,
                 std::vector<Vec3d>& targets) {
    const std::optional<Vec3d> p = table.vector("", settings_.unit("length"));
    if (!p) return;
    points.push_back(*p);
    const std::optional<int> vertex = table.integer("vertex");
    if (!vertex || *vertex < 0 || *vertex >= user_mesh_.vertex_count()) return;
    placed.push_back(*p);
    targets.push_back(user_mesh_.rest[*vertex]);
  }

  bool has_table(std::string_view key) const {
    std::error_code error;
    return settings_.is_given(key) || fs::exists(settings_.folder() / settings_[key].text(), error);
  }

  void read_markers(const SurfaceProjection& surface) {
    if (has_table("markers")) {
      read_marker_table(surface);
    } else if (has_table("positions")) {
      throw InvalidInput("there is no " + data_.source.markers + ", but " + data_.source.positions +
                         " has positions of markers; add it with the columns marker, x, y, z at rest, or remove " +
                         data_.source.positions + " to fit forces only");
    }
  }

  void add_marker(const std::string& name, const SurfacePoint& point, const Vec3d& gap) {
    marker_of_.try_emplace(name, static_cast<int>(data_.marker_names.size()));
    data_.experiment.markers.push_back(point);
    data_.marker_names.push_back(name);
    data_.marker_gap.push_back(norm(gap));
    gap_.push_back(gap);
  }

  void read_marker_table(const SurfaceProjection& surface) {
    MeasuredTable table(settings_.file("markers"), settings_.columns("markers"), errors_, data_.notes);
    const bool has_corners = table.has("corner_1"), has_points = table.has("x");
    if (!has_corners && !has_points && !table.has("vertex"))
      throw InvalidInput(data_.source.markers +
                         ":1: has no column x, vertex or corner_1 for the position of a marker (columns in " +
                         data_.source.settings + " gives them other names)");
    for (const Triangle& t : surface.triangles())
      for (int i = 0; i < 3; ++i) corner_of_.try_emplace(t[i], t, i);
    while (table.next()) {
      if (data_.marker_names.size() == kMaxMarkers)
        throw InvalidInput(data_.source.markers + ": more than " + std::to_string(kMaxMarkers) + " markers");
      const std::string given = table.text("marker");
      const std::string name = given.empty() ? std::to_string(data_.marker_names.size()) : given;
      if (const auto other = marker_of_.find(name); other != marker_of_.end())
        table.error("the marker '" + name + "' already occurs in line " +
                    std::to_string(data_.source.marker_line[other->second]) + "; give each its own name");
      Vec3d gap{};
      const SurfacePoint point = marker(table, surface, gap);
      add_marker(name, point, gap);
      data_.source.marker_line.push_back(table.line());
    }
  }

  SurfacePoint marker(MeasuredTable& table, const SurfaceProjection& surface, Vec3d& gap) {
    if (!table.text("corner_1").empty()) return marker_in_triangle(table);
    if (const std::optional<int> vertex = table.integer("vertex")) return marker_at_vertex(table, gap);
    const std::optional<Vec3d> p = position_at_rest(table);
    if (!p) {
      table.error("the marker has no position; give x, y, z or vertex");
      return {};
    }
    return point_near(*p, surface, gap, [&](const std::string& text) { table.error(text); });
  }

  std::optional<Vec3d> position_at_rest(MeasuredTable& table) {
    const std::optional<Vec3d> p = table.vector("", settings_.unit("length"));
    return p ? std::optional(to_mesh_(*p)) : std::nullopt;
  }

  SurfacePoint point_near(const Vec3d& p, const SurfaceProjection& surface, Vec3d& gap,
                          FunctionRef<void(const std::string&)> error) const {
    const ProjectedPoint projected = surface.nearest(p);
    gap = p - projected.position;
    if (projected.distance > kFarOff * size_)
      error("the marker lies " + three_digits(projected.distance) + " m off the surface of the body, whose size is " +
            three_digits(size_) + " m; " + unit_hint(surface, p));
    return projected.point;
  }

  // Suggests a unit if another one would move the point onto the body.
  std::string unit_hint(const SurfaceProjection& surface, const Vec3d& p) const {
    for (const std::string& unit : unit_names("length")) {
      const double factor = unit_in_si("length", unit) / settings_.unit("length");
      if (surface.nearest(factor * p).distance < kFarOff * size_ && norm(factor * p) > kFarOff * size_)
        return "in " + unit + " it would not: units = { length = \"" + unit + "\" }";
    }
    return "correct it, or align the markers with the mesh by --register rigid";
  }

  std::optional<int> stored_vertex(MeasuredTable& table, const char* column) {
    const std::optional<int> v = table.integer(column);
    if (v && *v >= 0 && *v < user_mesh_.vertex_count()) return data_.numbering.vertex.from_user(*v);
    if (v)
      table.error(std::string(column) + " = " + std::to_string(*v) + "; the mesh has the vertices 0 to " +
                  std::to_string(user_mesh_.vertex_count() - 1));
    return std::nullopt;
  }

  // For a marker with a vertex and a position, only the measured motion counts.
  SurfacePoint marker_at_vertex(MeasuredTable& table, Vec3d& gap) {
    const std::optional<int> v = stored_vertex(table, "vertex");
    if (!v) return {};
    const auto found = corner_of_.find(*v);
    if (found == corner_of_.end()) {
      table.error("vertex = " + table.text("vertex") + " is inside the body; markers lie on its surface");
      return {};
    }
    SurfacePoint point{found->second.first, {}};
    point.weights[found->second.second] = 1;
    if (const std::optional<Vec3d> p = position_at_rest(table)) gap = *p - data_.experiment.mesh.rest[*v];
    return point;
  }

  SurfacePoint marker_in_triangle(MeasuredTable& table) {
    SurfacePoint point;
    double sum = 0;
    for (int i = 0; i < 3; ++i) {
      const std::string number = std::to_string(i + 1);
      const std::optional<int> v = stored_vertex(table, ("corner_" + number).c_str());
      const std::optional<double> w = table.number("weight_" + number);
      if (!v || !w) {
        table.error("corner_1 to corner_3 and weight_1 to weight_3 must all be given; some are blank or invalid");
        return {};
      }
      point.vertices[i] = *v;
      sum += point.weights[i] = *w;
    }
    for (const int v : point.vertices)
      if (!corner_of_.contains(v)) table.error("a corner of the marker is inside the body; markers lie on its surface");
    if (std::abs(sum - 1) > 1e-6) table.error("the weights add up to " + number_text(sum) + "; they must sum to 1");
    return point;
  }

  void read_indenters() {
    const Value* indenters = settings_.find("tip");
    if (!indenters) return;
    for (const Value& t : indenters->array()) {
      Indenter indenter{t["shape"].text() == "disc" ? IndenterShape::disc : IndenterShape::sphere,
                        t["contact"].text() == "bonded" ? IndenterContact::bonded : IndenterContact::sliding,
                        settings_.unit("length") * t["radius"].number(),
                        0,
                        t["friction"].number(),
                        read_rim(settings_, t)};
      if (const Value* k = t.find("stiffness")) indenter.stiffness = k->number();
      tip_sigmas_.emplace(t["name"].text(), read_tip_sigmas(settings_, t));
      if (!indenters_.try_emplace(t["name"].text(), indenter).second)
        throw error_at(t["name"].place, "name = " + toml_string(t["name"].text()) + " is used by another tip");
    }
  }

  void read_patches(const SurfaceProjection& surface) {
    const Value* patches = settings_.find("patch");
    if (!patches) return;
    const std::vector<Triangle> boundary = to_user(surface.triangles());
    for (const Value& p : patches->array()) {
      const Value* where = p.find("where");
      std::vector<Triangle> triangles = where ? select_triangles(*where, scope(), boundary)
                                              : listed_triangles(settings_.files().find(p["triangles"]), p["triangles"],
                                                                 boundary, errors_, data_.notes);
      for (Triangle& t : triangles)
        for (int& v : t) v = data_.numbering.vertex.from_user(v);
      if (!patches_.try_emplace(p["name"].text(), std::move(triangles)).second)
        throw error_at(p["name"].place, "name = " + toml_string(p["name"].text()) + " is used by another patch");
    }
  }

  std::vector<Triangle> to_user(std::vector<Triangle> triangles) const {
    for (Triangle& t : triangles)
      for (int& v : t) v = data_.numbering.vertex.to_user(v);
    return triangles;
  }

  void read_positions() {
    data_.source.position_line.resize(data_.experiment.cases.size());
    const Value& name = settings_["positions"];
    std::error_code error;
    if (!settings_.is_given("positions") && !fs::exists(settings_.folder() / name.text(), error)) {
      const std::vector<LoadCase>& cases = data_.experiment.cases;
      const bool has_torque =
          std::any_of(cases.begin(), cases.end(), [](const LoadCase& load) { return load.torque.has_value(); });
      data_.notes.push_back("there is no " + name.text() + ": only forces" + (has_torque ? " and torques" : "") +
                            " are fitted");
      return;
    }
    require_table(name.text(), settings_.folder().string());
    MeasuredTable table(settings_.file("positions"), settings_.columns("positions"), errors_, data_.notes);
    for (const char* column : {"x", "y", "z"})
      if (!table.has(column))
        throw InvalidInput(data_.source.positions + ":1: has no column " + column + " (columns in " +
                           data_.source.settings + " gives it another name; tables of image correlation are " +
                           conversion(name.text(), settings_.folder().string()) + ")");
    std::map<std::string, int> case_of;
    for (size_t c = 0; c < data_.experiment.cases.size(); ++c)
      case_of[data_.experiment.cases[c].name] = static_cast<int>(c);
    std::map<std::pair<int, int>, int> line_of;
    size_t count = 0;
    for (; table.next(); ++count) {
      if (count == kMaxReadings) throw too_many_positions();
      read_position(table, case_of, line_of);
    }
    if (count == 0)
      data_.notes.push_back(data_.source.positions + " has no row below its header: only forces are fitted");
  }

  InvalidInput too_many_positions() const {
    return InvalidInput(data_.source.positions + ": more than " + std::to_string(kMaxReadings) +
                        " positions; remove markers or cases");
  }

  // Standard deviations along the axes of the mesh. A coordinate that was not measured has a huge one, which must not
  // reach other axes through round-off of the registration.
  Vec3d on_mesh_axes(const Vec3d& sd) const {
    if (sd[0] == sd[1] && sd[1] == sd[2]) return sd;
    constexpr double kAside = 0.014;  // sine of 0.8 degrees, chosen between the round-off and a deliberate rotation
    const Mat3d R = rotation_of(to_mesh_);
    Vec3d turned{};
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        if (std::abs(R(i, j)) > kAside) turned[i] = std::hypot(turned[i], R(i, j) * sd[j]);
    return turned;
  }

  double position_sigma() const {  // [m]; 0: chosen later
    const Value* typical = settings_["deviation"].find("position");
    if (!typical) return 0;
    return typical->number() * settings_.unit("length") * scale_of(to_mesh_);
  }

  void read_position(MeasuredTable& table, const std::map<std::string, int>& case_of,
                     std::map<std::pair<int, int>, int>& line_of) {
    const int c = table.index_of("case", case_of), m = table.index_of("marker", marker_of_);
    const double length = settings_.unit("length");
    const std::optional<Vec3d> p = table.vector("", length);
    const std::optional<Vec3d> sd = table.sigma("sd", length * scale_of(to_mesh_));
    if (c < 0 || m < 0 || !p) return;  // blank: hidden from the cameras
    if (const auto [first, is_new] = line_of.try_emplace({c, m}, table.line()); !is_new)
      table.error("this marker was given for this case in line " + std::to_string(first->second) + " already");
    const double all = position_sigma();
    // Uses the displacement from rest, because the measured surface never matches the mesh exactly.
    data_.experiment.cases[c].positions.push_back(
        {m, to_mesh_(*p) - gap_[m], sd ? on_mesh_axes(*sd) : Vec3d{{all, all, all}}});
    data_.source.position_line[c].push_back(table.line());
  }

  CaptureSettings settings_;
  ErrorList errors_;
  DataSet data_;
  TetMesh user_mesh_;
  MeshGroups groups_;  // of its file
  std::optional<RegistrationKind> registers_;
  AffineMap to_mesh_;  // from the coordinates of the markers
  std::optional<ForceSeries> forces_;
  double size_ = 0;  // size of the body [m]
  std::map<std::string, int> marker_of_;
  std::vector<Vec3d> gap_;                             // offset of each marker at rest from its surface point [m]
  std::map<int, std::pair<Triangle, int>> corner_of_;  // a triangle of each vertex of the surface, and which corner
  std::map<std::string, Indenter> indenters_;
  std::map<std::string, TipSigmas> tip_sigmas_;
  std::map<std::string, Grip> grips_;
  std::map<std::string, std::vector<Triangle>> patches_;
};

}  // namespace

DataSet read_data_set(const fs::path& path, std::optional<RegistrationKind> registers) {
  return DataSetReader(path, registers).read();
}

}  // namespace aspic
