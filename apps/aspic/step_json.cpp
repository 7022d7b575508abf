#include "aspic/step_json.h"

#include <nlohmann/json.hpp>

#include "base/hash.h"

namespace aspic::cli {
namespace {

template <class Name>
void add_resultants(const char* kind, const std::vector<Resultant>& sums, const Name& name_of,
                    nlohmann::ordered_json& line) {
  nlohmann::ordered_json all = nlohmann::json::object();
  for (size_t i = 0; i < sums.size(); ++i) {
    const auto& [f, m] = sums[i];
    all[name_of(i)] = {{"force", {f[0], f[1], f[2]}}, {"moment", {m[0], m[1], m[2]}}};
  }
  line[kind] = std::move(all);
}

}  // namespace

std::string step_json(const StepReport& report, const Explanation& why, const Simulation& simulation) {
  const std::vector<std::string> potential_names = simulation.potential_names();
  nlohmann::ordered_json potential = nlohmann::json::object();
  for (size_t i = 0; i < report.potential.size(); ++i) potential[potential_names.at(i)] = report.potential[i];
  const int worst = report.worst_vertex < 0 ? -1 : simulation.model().numbering.vertex.to_user(report.worst_vertex);
  nlohmann::ordered_json line = {
      {"step", report.step},
      {"time", report.time},
      {"status", to_string(report.status)},
      {"converged", is_success(report.status)},
      {"criterion", to_string(report.criterion)},
      {"iterations", report.iterations},
      {"trials", report.trials},
      {"values", report.values},
      {"gradients", report.gradients},
      {"hessians", report.hessians},
      {"projected_hessians", report.projected_hessians},
      {"elements", report.elements},
      {"factorizations", report.factorizations},
      {"linear_iterations", report.linear_iterations},
      {"products", report.products},
      {"cycles", report.cycles},
      {"initial_guess", to_string(report.initial_guess)},
      {"substeps", report.substeps},
      {"rejected", report.rejected},
      {"residual", report.residual},
      {"residual_threshold", report.residual_threshold},
      {"residual_round_off", report.residual_round_off},
      {"lost_accuracy", report.lost_accuracy},
      {"decrement", report.decrement},
      {"worst_vertex", worst},
      {"worst_residual", report.worst_residual},
      {"min_det_F", report.min_det_F},
      {"kinetic", report.kinetic},
      {"potential", potential},
      {"potential_total", report.potential_total},
      {"pin_work", report.pin_work},
      {"damping_loss", report.damping_loss},
      {"numerical_loss", report.numerical_loss},
      {"residual_work", report.residual_work},
      {"ledger_error", report.ledger_error},
      {"energy_bound", to_string(report.energy_bound)},
      {"energy_slack", report.energy_slack},
      {"state_hash", hex_digits(report.state_hash)},
      {"seconds", report.seconds},
  };
  const Model& model = simulation.model();
  const Resultants& sums = report.resultants;
  add_resultants(
      "reactions", sums.pins, [&](size_t i) { return model.pins[i].name; }, line);
  add_resultants(
      "loads", sums.loads, [&](size_t i) { return std::string(model.loads[i]->name()); }, line);
  add_resultants(
      "bodies", sums.bodies, [&](size_t i) { return model.bodies[i].name; }, line);
  if (!is_success(report.status))
    line["explanation"] = {{"cause", why.cause}, {"place", why.place}, {"remedy", why.remedy}};
  return line.dump();
}

}  // namespace aspic::cli
