#include "viewer/step_rows.h"

#include <algorithm>

#include "dynamics/step_fields.h"

namespace aspic::viewer {
namespace {

size_t details_of(const StepRow& row) {
  size_t count = row.iterations.size();
  for (const IterationRow& iteration : row.iterations) count += iteration.tried.size();
  return count;
}

// An object from the name of each pin to its force [N] and moment [N m], 6 numbers.
Json reactions(const StepRow& row) {
  Json all = Json::object();
  const std::vector<Resultant>& sums = row.report.resultants.pins;
  for (size_t i = 0; i < std::min({sums.size(), row.pins.size(), StepRow::kMaxReactions}); ++i) {
    const auto& [f, m] = sums[i];
    all[row.pins[i]] = {f[0], f[1], f[2], m[0], m[1], m[2]};
  }
  return all;
}

}  // namespace

Json to_json(const std::vector<Trial>& tried) {
  Json list = Json::array();
  for (const Trial& trial : tried)
    list.push_back(
        {{"alpha", trial.alpha}, {"value", trial.value}, {"bound", trial.bound}, {"accepted", trial.accepted}});
  return list;
}

Json to_json(const IterationRow& row) {
  const Iteration& it = row.iteration;
  return {{"value", it.value},
          {"gradient_norm", it.gradient_norm},
          {"decrement", it.decrement},
          {"alpha", it.alpha},
          {"projected_elements", it.direction.projected_elements},
          {"linear_iterations", it.direction.linear_iterations},
          {"seconds",
           {{"hessian", it.direction.hessian_seconds},
            {"factorize", it.direction.factorize_seconds},
            {"solve", it.direction.solve_seconds},
            {"line_search", it.line_search_seconds},
            {"gradient", it.gradient_seconds}}},
          {"trials", to_json(row.tried)}};
}

Json to_json(const Explanation& why) {
  if (why.cause.empty()) return nullptr;
  return {{"cause", why.cause}, {"place", why.place}, {"remedy", why.remedy}};
}

std::vector<std::string> pin_names(const Model& model) {
  std::vector<std::string> names;
  for (const Pin& pin : model.pins) names.push_back(pin.name);
  return names;
}

Json to_json(const StepRow& row) {
  const StepReport& report = row.report;
  Json message;
  for (const StepField& field : step_fields()) {
    if (!field.is_in(StepOutput::viewer)) continue;
    Json& entry = message[std::string(field.name)];
    if (field.type == StepFieldType::potentials)
      entry = report.potential;
    else
      std::visit([&](const auto& value) { entry = value; }, field.get(report));
  }
  if (report.energy_bound == EnergyBound::none) message["energy_slack"] = nullptr;
  if (report.state_hash == 0) message["state_hash"] = nullptr;
  message["iterations"] = Json::array();
  for (const IterationRow& iteration : row.iterations) message["iterations"].push_back(to_json(iteration));
  message["mouse_work"] = row.mouse_work;
  message["tool_work"] = row.tool_work;
  message["pin_work"] = row.pin_work;  // without the work of mouse and tool
  message["load_work"] = row.load_work;
  message["reactions"] = reactions(row);
  message["explanation"] = to_json(row.why);
  return message;
}

void IterationRows::add(const LiveIteration& live) {
  size_ += 1 + live.tried.size();
  if (size_ <= kMax) rows_.push_back({static_cast<const Iteration&>(live), {live.tried.begin(), live.tried.end()}});
}

void StepRows::add(StepRow row) {
  details_ += details_of(row);
  rows_.push_back(std::move(row));
  for (size_t i = 0; details_ > kMaxDetails && i + 1 < rows_.size(); ++i) forget_details_of(rows_[i]);
  if (rows_.size() <= kMaxSteps) return;
  forget_details_of(rows_.front());
  rows_.pop_front();
}

void StepRows::forget_details_of(StepRow& row) {
  details_ -= details_of(row);
  std::vector<IterationRow>().swap(row.iterations);
}

void StepRows::drop_after(int step) {
  while (!rows_.empty() && rows_.back().report.step > step) {
    details_ -= details_of(rows_.back());
    rows_.pop_back();
  }
}

void StepRows::set_mesh_error(StepReport estimate) {
  StepReport& last = rows_.back().report;
  last.mesh_stiffness = estimate.mesh_stiffness;
  last.mesh_energy = estimate.mesh_energy;
  last.mesh_worst_tet = estimate.mesh_worst_tet;
  last.mesh_error = std::move(estimate.mesh_error);
  last.mesh_density = std::move(estimate.mesh_density);
}

const StepRow* StepRows::find(int step) const {
  if (rows_.empty()) return nullptr;
  const int first = rows_.front().report.step;
  return step < first || step > rows_.back().report.step ? nullptr : &rows_[step - first];
}

Json StepRows::after(int step) const {
  Json list = Json::array();
  if (rows_.empty()) return list;
  const int first = rows_.front().report.step;
  for (size_t i = step < first ? 0 : static_cast<size_t>(step - first + 1); i < rows_.size(); ++i)
    list.push_back(to_json(rows_[i]));
  return list;
}

}  // namespace aspic::viewer
