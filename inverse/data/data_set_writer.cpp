#include <algorithm>

#include "base/error.h"
#include "data/case_table.h"
#include "data/data_set.h"
#include "data/stated_errors.h"
#include "data/surface_projection.h"
#include "indenter/indenter_depth.h"
#include "io/atomic_file.h"
#include "io/csv.h"
#include "io/mesh_file.h"
#include "scene/value.h"

namespace aspic {
namespace {

namespace fs = std::filesystem;

bool same(const Vec3d& a, const Vec3d& b) { return a[0] == b[0] && a[1] == b[1] && a[2] == b[2]; }
bool same(const Indenter& a, const Indenter& b) {
  return a.shape == b.shape && a.contact == b.contact && a.radius == b.radius && a.stiffness == b.stiffness &&
         a.friction == b.friction && a.rim == b.rim;
}
bool same(const Grip& a, const Grip& b) { return a.vertices == b.vertices && same(a.center, b.center); }

class Csv {
 public:
  explicit Csv(const std::vector<std::string>& columns) {
    CsvRow head;
    for (const std::string& c : columns) head.add(c);
    add(head);
  }
  void add(const CsvRow& row) { text_ += row.text() + "\n"; }
  void write(const fs::path& path) const { write_file(path, text_); }

 private:
  std::string text_;
};

void add(CsvRow& row, const Vec3d& v) { row.add(v[0]).add(v[1]).add(v[2]); }
void add(CsvRow& row, const std::optional<Vec3d>& v) {
  if (v) return add(row, *v);
  row.add("").add("").add("");
}

class DataSetWriter {
 public:
  DataSetWriter(const fs::path& folder, const DataSet& data) : folder_(folder), data_(data) {}

  void write() {
    collect();
    write_mesh(folder_ / "rest.msh", to_user(data_.numbering, data_.experiment.mesh));
    write_markers();
    write_cases();
    write_positions();
    for (size_t p = 0; p < patches_.size(); ++p) write_patch(p);
    write_settings();
  }

 private:
  int user(int vertex) const { return data_.numbering.vertex.to_user(vertex); }

  void collect() {
    for (const LoadCase& load : data_.experiment.cases) {
      const auto is_equal = [&](const Indenter& indenter) { return same(indenter, *load.indenter); };
      if (load.indenter && std::none_of(indenters_.begin(), indenters_.end(), is_equal))
        indenters_.push_back(*load.indenter);
      if (load.grip && std::none_of(grips_.begin(), grips_.end(), [&](const Grip& g) { return same(g, *load.grip); }))
        grips_.push_back(*load.grip);
      if (!load.pressed.empty() && std::find(patches_.begin(), patches_.end(), load.pressed) == patches_.end())
        patches_.push_back(load.pressed);
      if (load.indenter && !same(load.pose.axis, turned_axis(load.touch, load.pose.rotation)))
        throw InvalidInput("case '" + load.name + "': the axis of the pose is not the rotated axis of the touch");
    }
  }

  static std::string numbered(const char* name, size_t index, size_t count) {
    return count == 1 ? name : name + ("_" + std::to_string(index + 1));
  }
  std::string indenter_name(const Indenter& indenter) const {
    const auto found =
        std::find_if(indenters_.begin(), indenters_.end(), [&](const Indenter& t) { return same(t, indenter); });
    return numbered("tip", found - indenters_.begin(), indenters_.size());
  }
  std::string grip_name(const Grip& grip) const {
    const auto found = std::find_if(grips_.begin(), grips_.end(), [&](const Grip& g) { return same(g, grip); });
    return numbered("grip", found - grips_.begin(), grips_.size());
  }
  std::string patch_name(size_t p) const { return numbered("patch", p, patches_.size()); }

  void write_markers() const {
    Csv csv({"marker", "x", "y", "z", "corner_1", "corner_2", "corner_3", "weight_1", "weight_2", "weight_3"});
    for (size_t m = 0; m < data_.experiment.markers.size(); ++m) {
      const SurfacePoint& point = data_.experiment.markers[m];
      CsvRow row;
      row.add(data_.marker_names[m]);
      add(row, position(point, data_.experiment.mesh.rest));
      for (const int v : point.vertices) row.add(user(v));
      for (const double w : point.weights) row.add(w);
      csv.add(row);
    }
    csv.write(folder_ / "markers.csv");
  }

  void write_cases() const {
    Csv csv({"case",        "group",       "session",    "grip",          "move_x",     "move_y",     "move_z",
             "tip",         "touch_x",     "touch_y",    "touch_z",       "axis_x",     "axis_y",     "axis_z",
             "center_x",    "center_y",    "center_z",   "rotation_x",    "rotation_y", "rotation_z", "gravity_x",
             "gravity_y",   "gravity_z",   "pressure",   "dead_pressure", "patch",      "force_x",    "force_y",
             "force_z",     "force_sd_x",  "force_sd_y", "force_sd_z",    "torque_x",   "torque_y",   "torque_z",
             "torque_sd_x", "torque_sd_y", "torque_sd_z"});
    for (const LoadCase& load : data_.experiment.cases) csv.add(row_of(load));
    csv.write(folder_ / "cases.csv");
  }

  CsvRow row_of(const LoadCase& load) const {
    using Maybe = std::optional<Vec3d>;
    CsvRow row;
    row.add(load.name).add(load.group).add(load.session).add(load.grip ? grip_name(*load.grip) : "");
    add(row, load.grip ? Maybe(load.grip->displacement) : std::nullopt);
    row.add(load.indenter ? indenter_name(*load.indenter) : "");
    add(row, load.indenter ? Maybe(load.touch.center) : std::nullopt);
    add(row, load.indenter ? Maybe(load.touch.axis) : std::nullopt);
    add(row, load.indenter ? Maybe(load.pose.center) : std::nullopt);
    add(row, load.indenter ? Maybe(load.pose.rotation) : load.grip ? Maybe(load.grip->rotation) : std::nullopt);
    add(row, load.gravity);
    if (load.is_dead_pressure)
      row.add("").add(load.pressure);
    else
      row.add(load.pressure).add("");
    const auto patch = std::find(patches_.begin(), patches_.end(), load.pressed);
    row.add(patch == patches_.end() ? "" : patch_name(patch - patches_.begin()));
    add(row, load.force);
    add(row, load.force ? Maybe(load.force_sigma) : std::nullopt);
    add(row, load.torque);
    add(row, load.torque ? Maybe(load.torque_sigma) : std::nullopt);
    return row;
  }

  void write_positions() const {
    Csv csv({"case", "marker", "x", "y", "z", "sd_x", "sd_y", "sd_z"});
    for (const LoadCase& load : data_.experiment.cases)
      for (const MarkerReading& r : load.positions) {
        CsvRow row;
        row.add(load.name).add(data_.marker_names[r.marker]);
        add(row, r.position);
        add(row, r.sigma);
        csv.add(row);
      }
    csv.write(folder_ / "positions.csv");
  }

  void write_patch(size_t p) const {
    Csv csv({"a", "b", "c"});
    for (const Triangle& t : patches_[p]) csv.add(CsvRow().add(user(t[0])).add(user(t[1])).add(user(t[2])));
    csv.write(folder_ / (patch_name(p) + ".csv"));
  }

  std::string density_text() const {
    const std::vector<double>& density = data_.experiment.density;
    if (std::all_of(density.begin(), density.end(), [&](double d) { return d == density.front(); }))
      return inline_toml({density.empty() ? 1000.0 : density.front(), {}});
    std::string text = "density\n";
    for (const double d : data_.numbering.tet.to_user(density)) text += number_text(d) + "\n";
    write_file(folder_ / "density.csv", text);
    return "{ file = \"density.csv\" }";
  }

  std::string list_of(const std::vector<int>& vertices) const {
    std::vector<int> numbers;
    for (const int v : vertices) numbers.push_back(user(v));
    std::sort(numbers.begin(), numbers.end());
    std::string list;
    for (const int v : numbers) list += (list.empty() ? "" : ", ") + std::to_string(v);
    return "[" + list + "]";
  }

  std::string layer_sigma_text(const Indenter& indenter) const {
    for (const LoadCase& load : data_.experiment.cases)
      if (load.indenter && same(*load.indenter, indenter) && load.layer_sigma)
        return inline_toml({*load.layer_sigma, {}});
    return "\"unknown\"";
  }

  std::string friction_text(const Indenter& indenter) const {
    if (!(indenter.friction > 0)) return "";
    double sigma = 0;
    for (const LoadCase& load : data_.experiment.cases)
      if (load.indenter && same(*load.indenter, indenter)) sigma = load.friction_sigma;
    return "friction = " + inline_toml({indenter.friction, {}}) + "\nfriction_deviation = " + inline_toml({sigma, {}}) +
           "\n";
  }

  // A rim that is not known is not written.
  std::string rim_text(const Indenter& indenter) const {
    if (indenter.shape != IndenterShape::disc || indenter.contact != IndenterContact::sliding) return "";
    const auto is_unknown = [&](const LoadCase& load) {
      return load.indenter && same(*load.indenter, indenter) && load.rim_sigma > 0;
    };
    const std::vector<LoadCase>& cases = data_.experiment.cases;
    if (std::any_of(cases.begin(), cases.end(), is_unknown)) return "";
    return "rim = " + inline_toml({rim_of(indenter), {}}) + "\n";
  }

  void write_settings() const {
    std::string text =
        "# Measurements, in SI units: inverse/docs/capture_format.md\nversion = 1\nname = " + toml_string(data_.name) +
        "\nmesh = \"rest.msh\"" + (data_.experiment.mesh.mids.empty() ? "\norder = 1" : "\norder = 2") +
        "\ndensity = " + density_text() + "\nfixed = " + list_of(data_.experiment.fixed) + "\n";
    if (const std::optional<Vec3d>& g = data_.experiment.scan_gravity)
      text +=
          "mesh_gravity = [" + number_text((*g)[0]) + ", " + number_text((*g)[1]) + ", " + number_text((*g)[2]) + "]\n";
    if (!data_.experiment.errors.empty()) text += "errors = " + errors_text(data_.experiment.errors) + "\n";
    for (const Indenter& indenter : indenters_)
      text += "\n[[tip]]\nname = " + toml_string(indenter_name(indenter)) +
              "\nshape = " + (indenter.shape == IndenterShape::disc ? "\"disc\"" : "\"sphere\"") +
              "\ncontact = " + (indenter.contact == IndenterContact::bonded ? "\"bonded\"" : "\"sliding\"") +
              "\nradius = " + inline_toml({indenter.radius, {}}) +
              "\nstiffness = " + inline_toml({indenter.stiffness, {}}) +
              "\nstiffness_deviation = " + layer_sigma_text(indenter) + "\n" + rim_text(indenter) +
              friction_text(indenter);
    for (const Grip& grip : grips_)
      text += "\n[[grip]]\nname = " + toml_string(grip_name(grip)) + "\nwhere = " + list_of(grip.vertices) +
              "\ncenter = [" + number_text(grip.center[0]) + ", " + number_text(grip.center[1]) + ", " +
              number_text(grip.center[2]) + "]\n";
    for (size_t p = 0; p < patches_.size(); ++p)
      text += "\n[[patch]]\nname = " + toml_string(patch_name(p)) +
              "\ntriangles = " + toml_string(patch_name(p) + ".csv") + "\n";
    write_file(folder_ / "capture.toml", text);
  }

  const fs::path& folder_;
  const DataSet& data_;
  std::vector<Indenter> indenters_;
  std::vector<Grip> grips_;  // without regard to their motions
  std::vector<std::vector<Triangle>> patches_;
};

}  // namespace

// Writes beside the old data, which are touched only once everything is on disk. A folder without capture.toml is no
// data set, so that file is removed first and added last: two data sets are never mixed.
void write_data_set(const fs::path& folder, const DataSet& data, const WriteBeside& beside) {
  const fs::path unfinished = folder / ".aspic-unfinished", settings = "capture.toml";
  std::error_code error;
  fs::remove_all(unfinished, error);
  fs::create_directories(unfinished, error);
  if (error) throw InvalidInput(folder.string() + ": cannot be created (" + error.message() + "); choose another");
  try {
    DataSetWriter(unfinished, data).write();
    if (beside) beside(unfinished);
  } catch (...) {
    fs::remove_all(unfinished, error);
    throw;
  }
  std::vector<fs::path> names;
  for (const auto& entry : fs::directory_iterator(unfinished))
    if (entry.path().filename() != settings) names.push_back(entry.path().filename());
  names.push_back(settings);
  fs::remove(folder / settings, error);
  for (const fs::path& name : names) {
    fs::rename(unfinished / name, folder / name, error);
    if (error) throw InvalidInput((folder / name).string() + ": cannot be written (" + error.message() + ")");
  }
  fs::remove(unfinished, error);
}

}  // namespace aspic
