#include "data/case_table.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/error.h"
#include "data/data_findings.h"
#include "data/histories.h"
#include "model/gauge.h"
#include "model/limits.h"
#include "scene/placement.h"

namespace aspic {
namespace {

constexpr int kMaxCases = 20'000;  // chosen

class CaseReader {
 public:
  CaseReader(const CaptureSettings& settings, const CaseScope& scope, ErrorList& errors, DataSet& data)
      : settings_(settings),
        scope_(scope),
        data_(data),
        table_(settings.file("cases"), settings.columns("cases"), errors, data.notes) {}

  void read() {
    std::vector<LoadCase>& cases = data_.experiment.cases;
    while (table_.next()) {
      if (cases.size() == kMaxCases)
        throw InvalidInput(data_.source.cases + ": more than " + std::to_string(kMaxCases) + " cases; split them");
      LoadCase load = row();
      const auto [first, is_new] = line_of_.try_emplace(load.name, table_.line());
      if (!is_new)
        table_.error("the case '" + load.name + "' already occurs in line " + std::to_string(first->second) +
                     "; give each case its own name");
      cases.push_back(std::move(load));
      data_.source.case_line.push_back(table_.line());
      data_.case_time.push_back(time_);
    }
    if (cases.empty()) throw InvalidInput(data_.source.cases + ": has no cases; a fit needs at least one");
  }

 private:
  LoadCase row() {
    LoadCase load;
    time_ = table_.number("time");
    const std::string number = std::to_string(data_.experiment.cases.size() + 1);
    load.name = table_.text("case").empty() ? "case " + number : table_.text("case");
    load.group = table_.text("group").empty() ? load.name : table_.text("group");
    load.session = table_.text("session");
    load.gravity = table_.vector("gravity_", settings_.unit("gravity"), MissingColumn::zero)
                       .value_or(data_.experiment.scan_gravity.value_or(Vec3d{}));
    read_pressure(load);
    read_indenter(load);
    read_grip(load);
    read_wrench(load);
    return load;
  }

  void read_pressure(LoadCase& load) {
    const auto follower = table_.number("pressure", settings_.unit("pressure")),
               dead = table_.number("dead_pressure", settings_.unit("pressure"));
    if (follower && dead) table_.error("the columns pressure and dead_pressure exclude each other: leave one blank");
    load.is_dead_pressure = dead && !follower;
    load.pressure = load.is_dead_pressure ? *dead : follower.value_or(0);
    const std::string patch = table_.text("patch");
    if (load.pressure == 0 && patch.empty()) return;
    const auto* found = named(scope_.patches, patch, "patch", "patch");
    if (found) load.pressed = *found;
  }

  // Returns the item of this name; for a blank name, the only item.
  template <class Thing>
  const Thing* named(const std::map<std::string, Thing>& things, const std::string& name, const char* what,
                     const char* key) {
    std::vector<std::string> known;
    for (const auto& [k, thing] : things) known.push_back(k);
    if (name.empty() && things.size() == 1) return &things.begin()->second;
    if (const auto found = things.find(name); found != things.end()) return &found->second;
    if (things.empty()) {
      table_.error(std::string("there is no ") + what + "; describe it as [[" + key + "]] in capture.toml");
    } else if (name.empty()) {
      table_.error(std::string("the column ") + what + " is blank, and there are several (known: " + joined(known) +
                   ")");
    } else {
      table_.error(std::string(what) + " = '" + name + "' is unknown" + suggestion(name, known));
    }
    return nullptr;
  }

  static std::string joined(const std::vector<std::string>& words) {
    std::string text;
    for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
    return text;
  }

  // A row without a touch uses the last touch of its group.
  void read_indenter(LoadCase& load) {
    const double length = settings_.unit("length");
    std::optional<Vec3d> touch = table_.vector("touch_", length), axis = table_.vector("axis_", 1, MissingColumn::zero);
    const std::optional<Vec3d> center = table_.vector("center_", length);
    const std::optional<double> depth = table_.number("depth", length);
    const Vec3d rotation = table_.vector("rotation_", settings_.unit("angle"), MissingColumn::zero).value_or(Vec3d{});
    if (!touch && !center && !depth && table_.text("tip").empty()) return;
    const Indenter* indenter = named(scope_.indenters, table_.text("tip"), "tip", "tip");
    if (!indenter) return;
    load.indenter = *indenter;
    load.tip = table_.text("tip").empty() ? scope_.indenters.begin()->first : table_.text("tip");
    load.layer_sigma = scope_.tip_sigmas.at(load.tip).layer;
    load.friction_sigma = scope_.tip_sigmas.at(load.tip).friction;
    load.rim_sigma = scope_.tip_sigmas.at(load.tip).rim;
    if (const auto last = touch_of_.find(load.group); last != touch_of_.end() && !touch && !(center && depth)) {
      touch = last->second.center;
      if (!axis) axis = last->second.axis;
    }
    if (!axis && (touch || center)) axis = inward_axis(touch ? *touch : *center);
    if (axis && norm(*axis) == 0)
      return table_.error("the axis is 0 0 0; it must point out of the indenter, into the body");
    if (!touch && center && depth) touch = *center - *depth * unit(*axis);
    if (!touch || (!center && !depth))
      return table_.error(
          "the pose of the indenter is incomplete; give touch_x, touch_y, touch_z, its center when "
          "it touched the body at rest, and center_x, center_y, center_z or depth");
    load.touch = {*touch, *axis, {}};
    load.pose = {center ? *center : *touch + *depth * unit(*axis), turned_axis(load.touch, rotation), rotation};
    touch_of_[load.group] = load.touch;
  }

  void read_grip(LoadCase& load) {
    const std::optional<Vec3d> move = table_.vector("move_", settings_.unit("length"), MissingColumn::zero),
                               rotation = table_.vector("rotation_", settings_.unit("angle"), MissingColumn::zero);
    const bool is_named = !table_.text("grip").empty();
    if (!is_named && !move) return;
    if (load.indenter)
      return table_.error("has an indenter and a grip; give each its own case, or leave the columns of one blank");
    if (!move && !rotation)
      return table_.error("the motion of the grip is missing; give move_x, move_y, move_z or its rotation");
    const Grip* grip = named(scope_.grips, table_.text("grip"), "grip", "grip");
    if (!grip) return;
    load.grip = *grip;
    load.grip->displacement = move.value_or(Vec3d{});
    load.grip->rotation = rotation.value_or(Vec3d{});
  }

  static Vec3d unit(const Vec3d& axis) { return (1 / norm(axis)) * axis; }
  Vec3d inward_axis(const Vec3d& p) const { return -1.0 * scope_.surface.nearest(p).normal; }

  void read_wrench(LoadCase& load) {
    const double sign = settings_["force_of"].text() == "tip" ? 1 : -1;
    const double newton = settings_.unit("force"), newton_meter = settings_.unit("torque");
    load.force_sigma = stated_sigma("force", newton);
    load.force = components("force_", newton * sign, load.gauge);
    const std::optional<double> axial = table_.number("force", newton * sign);
    if (load.force && axial) table_.error("force and force_x, force_y, force_z are both given; keep one of them");
    if (axial && !load.force) take_force_along_axis(load, *axial);
    if (!load.force && !axial && (load.indenter || load.grip) && !has_histories(settings_)) take_force_of_series(load);
    load.torque_sigma = stated_sigma("torque", newton_meter);
    load.torque = components("torque_", newton_meter * sign, load.torque_gauge);
    if ((load.force || load.torque) && !load.indenter && !load.grip)
      table_.error(
          "has a force or torque but no indenter and no grip; give its pose or motion, or leave the force blank");
  }

  // `gauge`: axis of the only column, if there is one.
  std::optional<Vec3d> components(const std::string& prefix, double unit, std::optional<Vec3d>& gauge) {
    const int axis = table_.only_axis(prefix);
    if (axis < 0) return table_.vector(prefix, unit);
    const std::optional<Vec3d> v = table_.vector(prefix, unit, MissingColumn::zero);
    if (v) gauge = along(axis);
    return v;
  }

  static Vec3d along(int axis) {
    Vec3d a{};
    a[axis] = 1;
    return a;
  }

  void take_force_of_series(LoadCase& load) {
    if (!scope_.forces) return;
    try {
      if (!time_) return table_.error("force and time are blank; the time selects the force in " + scope_.forces->file);
      const std::optional<SteadyForce> steady = force_at(*time_);
      if (!steady) return;
      const bool is_stated = norm(load.force_sigma) > 0;
      if (!is_stated) load.force_sigma = scope_.forces->is_axial ? along_all(steady->sigma[0]) : steady->sigma;
      if (scope_.forces->is_axial) {
        take_force_along_axis(load, steady->mean[0]);
      } else {
        load.force = steady->mean;
      }
    } catch (const InvalidInput& error) {
      table_.error(error.what());
    }
  }

  static Vec3d along_all(double sigma) { return {{sigma, sigma, sigma}}; }

  // Empty after adding an error: not steady.
  std::optional<SteadyForce> force_at(double time) {
    const Value* steady = settings_.find("steady");
    if (steady && steady->is_text()) {
      return SteadyForce{true, resampled(*scope_.forces, time), {}, "taken at its time"};
    }
    SteadyForce force =
        steady_force(*scope_.forces, time, steady ? steady->number() : default_duration(*scope_.forces));
    if (!force.is_steady) {
      table_.error(
          "time = " + number_text(time) + " s: " + force.reason +
          ". steady = SECONDS in capture.toml changes the duration, steady = \"off\" takes the force as it is");
      return std::nullopt;
    }
    if (++steady_notes_ <= kMaxListed)
      data_.notes.push_back(table_.where() + ": force of " + scope_.forces->file + " at " + number_text(time) +
                            " s: " + force.reason);
    return force;
  }

  void take_force_along_axis(LoadCase& load, double force) {
    if (!load.indenter && !load.grip) return;
    const Vec3d axis = load.indenter ? load.pose.axis : load.grip->displacement;
    if (norm(axis) == 0)
      return table_.error(
          "the column force is the component along the motion of the grip, which only rotates; give "
          "force_x, force_y, force_z");
    const Vec3d a = unit(axis);
    load.gauge = a;
    load.force = force * a;
  }

  // Standard deviation of a force or torque; zero: chosen later.
  Vec3d stated_sigma(const std::string& what, double in_si) {
    if (const int axis = table_.only_axis(what + "_"); axis >= 0) {
      const std::string own = what + "_sd_" + "xyz"[axis];
      if (!table_.is_blank(own)) return along_all(table_.positive(own, in_si).value_or(0));
    }
    return table_.sigma(what + "_sd", in_si).value_or(default_sigma(what, in_si));
  }

  Vec3d default_sigma(const std::string& what, double in_si) const {
    const Value* sd = settings_["deviation"].find(what);
    const double value = sd ? sd->number() * in_si : 0;  // 0: chosen after all rows are read
    return {{value, value, value}};
  }

  const CaptureSettings& settings_;
  const CaseScope& scope_;
  DataSet& data_;
  MeasuredTable table_;
  std::optional<double> time_;  // of the current row [s]
  size_t steady_notes_ = 0;
  std::map<std::string, int> line_of_;
  std::map<std::string, IndenterPose> touch_of_;  // touch of each group
};

template <class T>
std::vector<T> in_order(std::vector<T>& values, const std::vector<int>& order) {
  std::vector<T> sorted;
  for (const int i : order) sorted.push_back(std::move(values[i]));
  return sorted;
}

// Sorts groups by first appearance.
void sort_cases(DataSet& data) {
  std::vector<LoadCase>& cases = data.experiment.cases;
  std::map<std::string, int> rank;
  for (const LoadCase& load : cases) rank.try_emplace(load.group, static_cast<int>(rank.size()));
  std::vector<int> order(cases.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
    const int left = rank[cases[a].group], right = rank[cases[b].group];
    return left != right ? left < right : load_size(cases[a]) < load_size(cases[b]);
  });
  cases = in_order(cases, order);
  data.source.case_line = in_order(data.source.case_line, order);
  data.case_time = in_order(data.case_time, order);
}

}  // namespace

void read_cases(const CaptureSettings& settings, const CaseScope& scope, ErrorList& errors, DataSet& data) {
  CaseReader(settings, scope, errors, data).read();
  sort_cases(data);
}

double sigma_along(const LoadCase& load) {
  if (load.gauge) return gauge_sigma(load.gauge, load.force_sigma)[0];
  const double size = load.force ? norm(*load.force) : 0;
  if (!(size > 0)) return norm(load.force_sigma);
  const Vec3d d = (1 / size) * *load.force;
  return norm(Vec3d{{d[0] * load.force_sigma[0], d[1] * load.force_sigma[1], d[2] * load.force_sigma[2]}});
}

double load_size(const LoadCase& load) {
  if (load.indenter) return norm(load.pose.center - load.touch.center);
  if (load.grip) return norm(load.grip->displacement) + load.grip->radius * norm(load.grip->rotation);
  if (load.pressure != 0) return std::abs(load.pressure);
  return norm(load.gravity);
}

Vec3d turned_axis(const IndenterPose& touch, const Vec3d& turn) {
  const double angle = norm(turn);
  return angle == 0 ? touch.axis : rotation(turn, angle) * touch.axis;
}

}  // namespace aspic
