#include "pipeline/case_figures.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "model/gauge.h"

namespace aspic {
namespace {

constexpr size_t kWorst = 200;  // readings with the largest residuals that are always shown

enum class LoadKind { rotation, displacement, pressure, gravity };
enum class Answer { force, torque, motion };

bool has_tool(const LoadCase& load) { return load.indenter || load.grip; }
Vec3d way_of(const LoadCase& load) {
  return load.grip ? load.grip->displacement : load.pose.center - load.touch.center;
}
Vec3d turn_of(const LoadCase& load) { return load.grip ? load.grip->rotation : load.pose.rotation; }
double radius_of(const LoadCase& load) { return load.grip ? load.grip->radius : load.indenter->radius; }

// Displacement of an indenter along its axis if it has none yet.
Vec3d direction_of(const LoadCase& load, Answer answer) {
  const Vec3d v = answer == Answer::torque ? turn_of(load) : way_of(load);
  if (norm(v) > 1e-12) return (1 / norm(v)) * v;
  return load.indenter ? (1 / norm(load.touch.axis)) * load.touch.axis : Vec3d{};
}

using Group = std::vector<const LoadCase*>;

// A tool that turns on the spot moves its rim by more than its center.
LoadKind kind_of(const Group& group) {
  double way = 0, rim = 0;
  bool has_pressure = false;
  for (const LoadCase* load : group) {
    has_pressure |= load->pressure != 0;
    if (!has_tool(*load)) continue;
    way = std::max(way, norm(way_of(*load)));
    rim = std::max(rim, radius_of(*load) * norm(turn_of(*load)));
  }
  if (rim > way) return LoadKind::rotation;
  if (way > 0 || std::all_of(group.begin(), group.end(), [](const LoadCase* load) { return has_tool(*load); }))
    return LoadKind::displacement;
  return has_pressure ? LoadKind::pressure : LoadKind::gravity;
}

Answer answer_of(const Group& group, LoadKind kind) {
  const auto has = [&](std::optional<Vec3d> LoadCase::*reading) {
    return std::any_of(group.begin(), group.end(), [&](const LoadCase* load) { return (load->*reading).has_value(); });
  };
  if (kind == LoadKind::rotation && has(&LoadCase::torque)) return Answer::torque;
  if (kind == LoadKind::displacement && has(&LoadCase::force)) return Answer::force;
  return Answer::motion;
}

Measure load_measure(LoadKind kind, const Group& group) {
  const bool is_depth = std::all_of(group.begin(), group.end(), [](const LoadCase* load) { return !!load->indenter; });
  switch (kind) {
    case LoadKind::rotation:
      return {"angle", "rad"};
    case LoadKind::displacement:
      return {is_depth ? "depth" : "displacement", "m"};
    case LoadKind::pressure:
      return {"pressure", "Pa"};
    case LoadKind::gravity:
      break;
  }
  return {"gravity", "m/s^2"};
}

double load_value(const LoadCase& load, LoadKind kind) {
  switch (kind) {
    case LoadKind::rotation:
      return has_tool(load) ? norm(turn_of(load)) : 0;
    case LoadKind::displacement:
      return has_tool(load) ? norm(way_of(load)) : 0;
    case LoadKind::pressure:
      return load.pressure;
    case LoadKind::gravity:
      break;
  }
  return norm(load.gravity);
}

Response wrench_response(const LoadCase& load, const CaseOutcome& outcome, Answer answer) {
  const bool is_torque = answer == Answer::torque;
  const std::optional<Vec3d>& measured = is_torque ? load.torque : load.force;
  const Vec3d way = direction_of(load, answer);
  if (!measured || norm(way) == 0) return {};
  const bool is_fitted = outcome.ok && !outcome.left_out;
  const Vec3d stated = is_torque ? load.torque_sigma : load.force_sigma,
              used = is_torque ? outcome.torque_sigma : outcome.force_sigma, sigma = is_fitted ? used : stated;
  const auto along = [&](const Wrench& wrench) { return dot(is_torque ? wrench.torque : wrench.force, way); };
  Response result{.measured = dot(*measured, way),
                  .sigma = norm(Vec3d{{way[0] * sigma[0], way[1] * sigma[1], way[2] * sigma[2]}})};
  if (is_fitted) result.fitted = along(outcome.wrench);
  if (outcome.ok) result.on_mesh = along(outcome.wrench_on_mesh);
  if (outcome.has_held_out) result.held_out = along(outcome.held_out_wrench);
  return result;
}

double mean_motion(const Experiment& experiment, const LoadCase& load, const std::vector<Vec3d>& markers) {
  double sum = 0;
  for (size_t i = 0; i < load.positions.size(); ++i)
    sum += norm(markers[i] - at_rest(experiment, experiment.markers[load.positions[i].marker]));
  return sum / static_cast<double>(load.positions.size());
}

Response motion_response(const Experiment& experiment, const LoadCase& load, const CaseOutcome& outcome) {
  if (load.positions.empty()) return {};
  Response result;
  std::vector<Vec3d> measured;
  double variance = 0;
  for (const MarkerReading& reading : load.positions) {
    measured.push_back(reading.position);
    variance += rms_sigma(reading.sigma) * rms_sigma(reading.sigma);
  }
  result.measured = mean_motion(experiment, load, measured);
  result.sigma = std::sqrt(variance) / static_cast<double>(load.positions.size());
  if (outcome.ok && !outcome.left_out) result.fitted = mean_motion(experiment, load, outcome.markers);
  if (outcome.ok) result.on_mesh = mean_motion(experiment, load, outcome.markers_on_mesh);
  if (outcome.has_held_out) result.held_out = mean_motion(experiment, load, outcome.held_out_markers);
  return result;
}

double squared_residual(const LoadCase& load, const CaseOutcome& outcome, size_t i) {
  const Vec3d error = outcome.markers[i] - load.positions[i].position;
  const Vec3d& sigma = outcome.marker_sigma.empty() ? load.positions[i].sigma : outcome.marker_sigma[i];
  double sum = 0;
  for (int k = 0; k < 3; ++k) sum += error[k] * error[k] / (sigma[k] * sigma[k]);
  return sum;
}

}  // namespace

void for_each_residual(const LoadCase& load, const CaseOutcome& outcome, const std::function<void(double)>& use) {
  if (!outcome.ok || outcome.left_out) return;
  const auto add = [&](const Vec3d& error, const Vec3d& sigma) {
    for (int k = 0; k < 3; ++k)
      if (is_measured(sigma, k)) use(error[k] / sigma[k]);
  };
  for (size_t i = 0; i < load.positions.size(); ++i)
    add(outcome.markers[i] - load.positions[i].position, outcome.marker_sigma[i]);
  if (load.force)
    add(to_gauge(load.gauge, outcome.wrench.force - *load.force), gauge_sigma(load.gauge, outcome.force_sigma));
  if (load.torque)
    add(to_gauge(load.torque_gauge, outcome.wrench.torque - *load.torque),
        gauge_sigma(load.torque_gauge, outcome.torque_sigma));
}

std::string stiffness_unit(const CaseFigures& figures) {
  if (figures.load.unit == "rad" && figures.response.unit == "N m") return "N m/rad";
  return figures.load.unit == "m" && figures.response.unit == "N" ? "N/m" : "";
}

std::vector<CaseFigures> case_figures(const DataSet& data, const FitOutcome& outcome) {
  const std::vector<LoadCase>& cases = data.experiment.cases;
  std::vector<CaseFigures> all(cases.size());
  for (size_t c = 0; c < cases.size(); ++c) {
    Group group;
    for (const LoadCase& load : cases)
      if (load.group == cases[c].group) group.push_back(&load);
    const LoadKind kind = kind_of(group);
    const Answer answer = answer_of(group, kind);
    CaseFigures& figures = all[c];
    figures.load = load_measure(kind, group);
    figures.load_value = load_value(cases[c], kind);
    figures.response = answer == Answer::force    ? Measure{"force", "N"}
                       : answer == Answer::torque ? Measure{"torque", "N m"}
                                                  : Measure{"mean motion", "m"};
    figures.values = answer == Answer::motion ? motion_response(data.experiment, cases[c], outcome.cases[c])
                                              : wrench_response(cases[c], outcome.cases[c], answer);
    double squares = 0;
    for_each_residual(cases[c], outcome.cases[c], [&](double r) { squares += r * r, ++figures.readings; });
    if (figures.readings > 0) figures.rms = std::sqrt(squares / figures.readings);
  }
  return all;
}

std::vector<int> shown_readings(const LoadCase& load, const CaseOutcome& outcome) {
  std::vector<int> order(load.positions.size());
  std::iota(order.begin(), order.end(), 0);
  if (order.size() <= kMaxShownReadings) return order;
  std::vector<char> is_shown(order.size(), 0);
  const size_t stride = (order.size() + kMaxShownReadings - kWorst - 1) / (kMaxShownReadings - kWorst);
  for (size_t i = 0; i < order.size(); i += stride) is_shown[i] = 1;
  if (outcome.ok) {
    std::vector<double> residual;
    for (size_t i = 0; i < order.size(); ++i) residual.push_back(squared_residual(load, outcome, i));
    std::nth_element(order.begin(), order.begin() + kWorst, order.end(),
                     [&](int a, int b) { return std::pair(residual[b], a) < std::pair(residual[a], b); });
    for (size_t k = 0; k < kWorst; ++k) is_shown[order[k]] = 1;
  }
  std::vector<int> shown;
  for (size_t i = 0; i < is_shown.size(); ++i)
    if (is_shown[i]) shown.push_back(static_cast<int>(i));
  return shown;
}

}  // namespace aspic
