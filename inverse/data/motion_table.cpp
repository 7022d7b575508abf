#include "data/motion_table.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "base/error.h"
#include "base/formatted.h"
#include "base/printable.h"
#include "data/foreign_file.h"
#include "data/measured_table.h"
#include "data/surface_projection.h"
#include "data/units.h"
#include "io/csv_reader.h"
#include "mesh/box.h"
#include "model/limits.h"
#include "scene/value.h"

namespace aspic {
namespace {

constexpr size_t kMaxTracked = 100'000;  // chosen: above any camera system; more are positions instead of names

const std::vector<std::string> kColumns = {"time", "marker", "x", "y", "z", "sigma"};

void require_columns(const CsvReader& csv, const std::string& file) {
  for (const std::string& column : csv.columns()) {
    if (std::find(kColumns.begin(), kColumns.end(), column) == kColumns.end())
      throw InvalidInput(file + ":1: unknown column '" + column + "'" + suggestion(column, kColumns));
    if (std::count(csv.columns().begin(), csv.columns().end(), column) > 1)
      throw InvalidInput(file + ":1: the column '" + column + "' is there twice; remove one");
  }
  for (const std::string& column : kColumns)
    if (!csv.has(column) && column != "sigma")
      throw InvalidInput(file + ":1: the column '" + column + "' is missing; the header is time,marker,x,y,z");
}

class TableReader {
 public:
  explicit TableReader(const std::filesystem::path& path) : csv_(path, CsvOrigin::foreign) {
    table_.file = printable(path.string());
    require_columns(csv_, table_.file);
    table_.has_sigma = csv_.has("sigma");
  }

  MotionTable read() {
    while (csv_.next()) add_row();
    refuse_duplicates();
    if (table_.rows.empty() && errors_.is_empty()) errors_.add(table_.file + ": has no rows below the header");
    errors_.finish();
    return std::move(table_);
  }

 private:
  std::optional<double> number(const char* name) {
    const size_t column = csv_.column(name);
    const std::optional<double> value = csv_.try_number(column);
    if (value && std::isfinite(*value)) return value;
    errors_.add(csv_.where() + ": " + name + " = " + shown(csv_.text(column)) +
                " is no finite number; correct it, or remove the row if the marker was not seen");
    return std::nullopt;
  }

  void add_row() {
    const std::string& name = csv_.text(csv_.column("marker"));
    if (name.empty()) return errors_.add(csv_.where() + ": marker is blank; give its name");
    const std::optional<double> time = number("time"), x = number("x"), y = number("y"), z = number("z");
    const std::optional<double> sigma = table_.has_sigma ? number("sigma") : 1;
    if (sigma && !(*sigma > 0))
      return errors_.add(csv_.where() + ": sigma = " + number_text(*sigma) +
                         "; a standard deviation must be > 0 (remove the column to estimate it)");
    if (!time || !x || !y || !z || !sigma) return;
    const auto [marker, is_new] = index_.try_emplace(name, static_cast<int>(index_.size()));
    if (is_new) table_.markers.push_back(name);
    if (table_.markers.size() > kMaxTracked)
      throw InvalidInput(csv_.where() + ": more than " + std::to_string(kMaxTracked) +
                         " markers; the column marker holds a name per marker");
    table_.rows.push_back({*time, marker->second, {{*x, *y, *z}}, *sigma, csv_.line()});
  }

  void refuse_duplicates() {
    std::vector<MotionRow>& rows = table_.rows;
    std::stable_sort(rows.begin(), rows.end(), [](const MotionRow& a, const MotionRow& b) {
      return a.marker < b.marker || (a.marker == b.marker && a.time < b.time);
    });
    for (size_t i = 1; i < rows.size(); ++i)
      if (rows[i].marker == rows[i - 1].marker && rows[i].time == rows[i - 1].time)
        errors_.add(table_.file + ":" + std::to_string(rows[i].line) + ": marker '" + table_.markers[rows[i].marker] +
                    "' at time " + number_text(rows[i].time) + " is in line " + std::to_string(rows[i - 1].line) +
                    " already; remove one");
  }

  CsvReader csv_;
  MotionTable table_;
  ErrorList errors_;
  std::map<std::string, int> index_;
};

class Attachment {
 public:
  Attachment(const MotionTable& table, const TetMesh& mesh, const State& start, double h)
      : table_(table), body_(at_start(mesh, start)), surface_(body_), time_(start.time), h_(h), size_(size_of(body_)) {}

  MotionData attach(std::vector<std::string>& notes) {
    MotionData data{.has_sigma = table_.has_sigma};
    data.markers.resize(table_.markers.size());
    data.offset.resize(table_.markers.size());
    std::vector<int> first_line(table_.markers.size(), 0);
    std::vector<bool> is_placed(table_.markers.size(), false);
    for (const MotionRow& row : table_.rows) {
      if (first_line[row.marker] == 0) first_line[row.marker] = row.line;
      const double steps = (row.time - time_) / h_;
      if (steps < -kSame || steps > kMaxTimeSteps) {
        refuse_time(row, steps < 0);
      } else if (steps <= kSame) {
        place(row, data, notes);
        is_placed[row.marker] = true;
      } else {
        data.samples.push_back({row.marker, row.time, row.position, row.sigma});
      }
    }
    for (size_t m = 0; m < is_placed.size(); ++m)
      if (!is_placed[m])
        errors_.add(table_.file + ":" + std::to_string(first_line[m]) + ": marker '" + table_.markers[m] +
                    "' has no row at the start, time = " + number_text(time_) +
                    ", which places it on the body; add one or remove the marker");
    if (data.samples.empty() && errors_.is_empty())
      errors_.add(table_.file + ": has no rows after the start, time = " + number_text(time_) + "; add the motion");
    errors_.finish();
    return data;
  }

 private:
  static TetMesh at_start(const TetMesh& mesh, const State& start) {
    TetMesh body = mesh;
    for (size_t v = 0; v < body.rest.size(); ++v)
      for (int axis = 0; axis < 3; ++axis) body.rest[v][axis] = start.q[3 * v + axis];
    return body;
  }
  std::string where(const MotionRow& row) const { return table_.file + ":" + std::to_string(row.line); }

  void refuse_time(const MotionRow& row, bool is_early) {
    errors_.add(
        where(row) + ": time = " + number_text(row.time) +
        (is_early ? " is before the start of the scene, " + number_text(time_) + "; subtract a constant from all times"
                  : " is more than 1e6 time steps after the start; times are in seconds"));
  }

  void place(const MotionRow& row, MotionData& data, std::vector<std::string>& notes) {
    const ProjectedPoint projected = surface_.nearest(row.position);
    data.markers[row.marker] = projected.point;
    data.offset[row.marker] = row.position - projected.position;
    const std::string off = "marker '" + table_.markers[row.marker] + "' lies " +
                            formatted("%.3g", projected.distance) + " m off the surface of the body, whose size is " +
                            formatted("%.3g", size_) + " m";
    if (projected.distance > kFarOff * size_)
      errors_.add(where(row) + ": " + off + "; " + remedy(row.position, projected.distance));
    else if (projected.distance > kOffSurface * size_)
      notes.push_back(off + "; this offset is kept constant");
  }

  std::string remedy(const Vec3d& p, double distance) const {
    for (const std::string& unit : unit_names("length"))
      if (distance > size_ && surface_.nearest(unit_in_si("length", unit) * p).distance <= kFarOff * size_)
        return "the positions seem to be in " + unit + ", convert them to m";
    return "correct it, or move the body with `translate` to where the markers are";
  }

  const MotionTable& table_;
  TetMesh body_;
  SurfaceProjection surface_;
  double time_, h_, size_;
  ErrorList errors_;
};

}  // namespace

MotionTable read_motion_table(const std::filesystem::path& path) {
  require_table(path.string(), path.stem().string() + ".csv");
  return TableReader(path).read();
}

MotionData attach_markers(const MotionTable& table, const TetMesh& mesh, const State& start, double h,
                          std::vector<std::string>& notes) {
  return Attachment(table, mesh, start, h).attach(notes);
}

}  // namespace aspic
