#include "data/histories.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "base/error.h"
#include "base/formatted.h"
#include "data/case_table.h"
#include "model/limits.h"
#include "scene/scene_files.h"

namespace aspic {
namespace {

constexpr int kRampBins = 10;     // per ramp. Chosen: half and double move values by 0.004 standard deviations
constexpr double kGrowth = 1.15;  // of successive bins of a hold: 55 bins; an exponential decays by 5 % per bin at most
constexpr double kFirstBin =
    5e-4;                     // length of its first bin over its duration. Chosen: half and double move values by 0.04
constexpr double kEnd = 0.9;  // fraction of a hold after which the force counts as that of the last state. Chosen

// Cases of one history in the order of time.
using Waypoints = std::vector<size_t>;

std::map<std::string, Waypoints> waypoints_of(const DataSet& data) {
  std::map<std::string, Waypoints> groups;
  const std::vector<LoadCase>& cases = data.experiment.cases;
  for (size_t c = 0; c < cases.size(); ++c)
    if (data.case_time[c]) groups[cases[c].group].push_back(c);
  for (auto& [group, members] : groups)
    std::stable_sort(members.begin(), members.end(), [&](size_t a, size_t b) {
      const double left = *data.case_time[a], right = *data.case_time[b];
      return left != right ? left < right : data.source.case_line[a] < data.source.case_line[b];
    });
  return groups;
}

// Direction of a force of a single-axis gauge; zero: unknown.
Vec3d gauge_axis(const LoadCase& load) {
  const Vec3d axis = load.indenter ? load.pose.axis : load.grip ? load.grip->displacement : Vec3d{};
  return norm(axis) > 0 ? (1 / norm(axis)) * axis : Vec3d{};
}

struct Samples {
  size_t count = 0;
  double time = 0;  // means
  Vec3d value{};
};

Samples samples_between(const ForceSeries& series, double begin, double end) {
  Samples mean;
  const auto first = std::upper_bound(series.times.begin(), series.times.end(), begin);
  for (size_t i = static_cast<size_t>(first - series.times.begin()); i < series.times.size(); ++i) {
    if (series.times[i] > end) break;
    ++mean.count;
    mean.time += series.times[i];
    mean.value = mean.value + series.values[i];
  }
  if (mean.count == 0) return mean;
  mean.time /= static_cast<double>(mean.count);
  mean.value = (1 / static_cast<double>(mean.count)) * mean.value;
  return mean;
}

class HistoryReader {
 public:
  HistoryReader(const ForceSeries* series, ErrorList& errors, DataSet& data)
      : series_(series), errors_(errors), data_(data) {}

  LoadHistory history(const std::string& name, const Waypoints& members) {
    LoadHistory h{.name = name};
    for (const size_t c : members) {
      h.times.push_back(*data_.case_time[c]);
      h.waypoints.push_back(data_.experiment.cases[c]);
      check_kind(h, c);
    }
    if (!(h.times.back() > h.times.front())) {
      error(members.back(), "'" + name + "' has one time only; give the rows of its ramp and of its end");
      return h;
    }
    add_given_forces(h);
    if (series_) add_series(h, members);
    const bool has_markers =
        std::any_of(h.waypoints.begin(), h.waypoints.end(), [](const LoadCase& c) { return !c.positions.empty(); });
    if (h.forces.empty() && !has_markers)
      error(members.back(), "'" + name + "' has no force and no positions between " + three_digits(h.times.front()) +
                                " s and " + three_digits(h.times.back()) + " s" +
                                (has_torques(h) ? kNoTorques + "give its forces or positions" : ""));
    else if (has_torques(h))
      data_.notes.push_back("torques of '" + name + "'" + kNoTorques + "its forces and positions are fitted");
    return h;
  }

 private:
  static inline const std::string kNoTorques =
      ": torques of loads that vary in time (steady = \"history\") are not fitted; ";
  static bool has_torques(const LoadHistory& h) {
    return std::any_of(h.waypoints.begin(), h.waypoints.end(), [](const LoadCase& c) { return c.torque.has_value(); });
  }

  void error(size_t c, const std::string& text) {
    errors_.add(data_.source.load_case(static_cast<int>(c)) + ": " + text);
  }

  void check_kind(const LoadHistory& h, size_t c) {
    const LoadCase &first = h.waypoints.front(), &load = h.waypoints.back();
    const bool is_same = first.indenter.has_value() == load.indenter.has_value() &&
                         first.grip.has_value() == load.grip.has_value() &&
                         (!first.grip || first.grip->vertices == load.grip->vertices);
    if (!is_same)
      error(c,
            "all rows of '" + h.name +
                "' need the same indenter or grip, with its pose; where it does not move the body, give the depth or "
                "the displacement 0");
  }

  static void add_given_forces(LoadHistory& h) {
    for (size_t k = 0; k < h.waypoints.size(); ++k) {
      const LoadCase& load = h.waypoints[k];
      if (!load.force) continue;
      const double size = norm(*load.force);
      Vec3d axis = size > 0 ? (1 / size) * *load.force : gauge_axis(load);
      if (const Vec3d gauge = gauge_axis(load); std::abs(dot(axis, gauge)) > 1 - 1e-9) axis = gauge;
      if (norm(axis) > 0) h.forces.push_back({h.times[k], axis, dot(*load.force, axis), sigma_along(load)});
    }
  }

  // Means of the samples over bins that are short where the force changes fast.
  void add_series(LoadHistory& h, const Waypoints& members) {
    h.forces.clear();
    const Vec3d gauge = strongest_axis(h);
    if (series_->is_axial && norm(gauge) == 0)
      return error(members.back(), "the direction of the column force of " + series_->file +
                                       " is unknown; give force_x, force_y, force_z");
    for (size_t k = 0; k + 1 < h.times.size(); ++k) add_bins(h, k, gauge);
  }

  static Vec3d strongest_axis(const LoadHistory& h) {
    Vec3d axis{};
    for (const LoadCase& load : h.waypoints)
      if (norm(axis) == 0) axis = gauge_axis(load);
    return axis;
  }

  void add_bins(LoadHistory& h, size_t k, const Vec3d& gauge) {
    const double begin = h.times[k], end = h.times[k + 1], length = end - begin;
    if (!(length > 0)) return;
    std::vector<double> edges;
    if (is_same_load(h.waypoints[k], h.waypoints[k + 1]))
      for (double d = kFirstBin * length; d < length / kGrowth; d *= kGrowth) edges.push_back(begin + d);
    else
      for (int i = 1; i < kRampBins; ++i) edges.push_back(begin + length * i / kRampBins);
    edges.push_back(end);
    double last = begin;
    for (const double edge : edges) {
      const Samples mean = samples_between(*series_, last, edge);
      if (mean.count > 0) add_reading(h, mean, gauge);
      last = edge;
    }
  }

  void add_reading(LoadHistory& h, const Samples& mean, const Vec3d& gauge) {
    const double sigma = sample_sigma(h) / std::sqrt(static_cast<double>(mean.count));
    if (series_->is_axial) {
      h.forces.push_back({mean.time, gauge, mean.value[0], sigma});
      return;
    }
    for (int axis = 0; axis < 3; ++axis) {
      Vec3d unit{};
      unit[axis] = 1;
      h.forces.push_back({mean.time, unit, mean.value[axis], sigma});
    }
  }

  // The stated standard deviation, or the noise of the series.
  double sample_sigma(const LoadHistory& h) const {
    const Vec3d& stated = h.waypoints.back().force_sigma;
    const double floor = kExactError * largest_force(*series_);
    if (series_->has_stated_sigma && norm(stated) > 0) return std::max(sigma_along(h.waypoints.back()), floor);
    return std::max(noise_of(*series_), floor);
  }

  const ForceSeries* series_;
  ErrorList& errors_;
  DataSet& data_;
};

// Samples whose mean counts as the force of the last state.
Samples end_samples(const ForceSeries& series, const Waypoints& members, const DataSet& data) {
  const double last = *data.case_time[members.back()],
               before = members.size() > 1 ? *data.case_time[members[members.size() - 2]] : last;
  return samples_between(series, before + kEnd * (last - before), last);
}

// Replaces the time of the last state by the mean time of the samples of its force, if it is their mean.
void use_time_of_force(const ForceSeries& series, const Waypoints& members, DataSet& data) {
  const LoadCase& end = data.experiment.cases[members.back()];
  const Samples mean = end_samples(series, members, data);
  if (!end.force || mean.count == 0) return;
  const Vec3d force = series.is_axial ? mean.value[0] * gauge_axis(end) : mean.value;
  if (norm(force - *end.force) <= 1e-12 * norm(force)) data.case_time[members.back()] = mean.time;
}

void keep_cases(DataSet& data, const std::vector<bool>& is_kept) {
  const auto prune = [&](auto& list) {
    if (list.size() != is_kept.size()) return;
    size_t to = 0;
    for (size_t c = 0; c < is_kept.size(); ++c)
      if (is_kept[c]) {
        if (to != c) list[to] = std::move(list[c]);
        ++to;
      }
    list.resize(to);
  };
  prune(data.experiment.cases);
  prune(data.source.case_line);
  prune(data.source.position_line);
  prune(data.case_time);
}

}  // namespace

bool has_histories(const CaptureSettings& settings) {
  const Value* steady = settings.find("steady");
  return steady && steady->is_text() && steady->text() == "history";
}

void add_end_forces(const ForceSeries* series, DataSet& data) {
  if (!series) return;
  for (const auto& [group, members] : waypoints_of(data)) {
    LoadCase& end = data.experiment.cases[members.back()];
    if (end.force) continue;
    const Samples mean = end_samples(*series, members, data);
    const Vec3d gauge = gauge_axis(end);
    if (mean.count == 0 || (series->is_axial && norm(gauge) == 0)) continue;
    end.force = series->is_axial ? mean.value[0] * gauge : mean.value;
    const double sigma =
        std::max(noise_of(*series), kExactError * largest_force(*series)) / std::sqrt(static_cast<double>(mean.count));
    if (series->is_axial) end.gauge = gauge;
    if (!(norm(end.force_sigma) > 0)) end.force_sigma = {{sigma, sigma, sigma}};
  }
}

void take_histories(const ForceSeries* series, ErrorList& errors, DataSet& data) {
  HistoryReader reader(series, errors, data);
  const size_t count = data.experiment.cases.size();
  std::vector<bool> is_waypoint(count, false), is_end(count, false);
  for (const auto& [group, members] : waypoints_of(data)) {
    data.histories.push_back(reader.history(group, members));
    for (const size_t c : members) is_waypoint[c] = true;
    is_end[members.back()] = true;
    if (series) use_time_of_force(*series, members, data);
  }
  if (data.histories.empty()) throw InvalidInput(data.source.cases + ": steady = \"history\" needs cases with a time");
  const bool has_static = std::find(is_waypoint.begin(), is_waypoint.end(), false) != is_waypoint.end();
  std::vector<bool> is_kept(count);
  for (size_t c = 0; c < count; ++c) {
    const LoadCase& load = data.experiment.cases[c];
    is_kept[c] = has_static ? !is_waypoint[c] : is_end[c] && (load.force || !load.positions.empty());
  }
  if (std::none_of(is_kept.begin(), is_kept.end(), [](bool kept) { return kept; }) && errors.is_empty())
    throw InvalidInput(data.source.cases + ": no last state of a history has a force or positions");
  keep_cases(data, is_kept);
  data.histories_end_static = !has_static;
  if (!has_static)
    data.notes.push_back(
        "the last state of each history counts as steady for the first fit; the fit of relaxation times "
        "corrects the stiffness");
}

std::string fingerprint_of(const std::vector<LoadHistory>& histories) {
  if (histories.empty()) return "";
  Fingerprint hash;
  const auto add = [&](const void* data, size_t size) { hash.add(data, size); };
  for (const LoadHistory& h : histories) {
    add(h.times.data(), h.times.size() * sizeof(double));
    for (const ForceReading& r : h.forces) {
      const double values[] = {r.time, r.axis[0], r.axis[1], r.axis[2], r.value, r.sigma};
      add(values, sizeof values);
    }
    for (const LoadCase& c : h.waypoints) {
      const double values[] = {c.gravity[0],     c.gravity[1],     c.gravity[2],    c.pressure,
                               c.pose.center[0], c.pose.center[1], c.pose.center[2]};
      add(values, sizeof values);
      if (c.grip)
        for (const Vec3d* v : {&c.grip->displacement, &c.grip->rotation}) add(v, sizeof *v);
      for (const MarkerReading& r : c.positions) add(&r.position, sizeof r.position), add(&r.sigma, sizeof r.sigma);
    }
  }
  return hash.text();
}

}  // namespace aspic
