#include "aspic/step_json.h"

#include <nlohmann/json.hpp>

#include "base/hash.h"

namespace aspic::cli {

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
      {"vertex_sweeps", report.vertex_sweeps},
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
  if (!is_success(report.status))
    line["explanation"] = {{"cause", why.cause}, {"place", why.place}, {"remedy", why.remedy}};
  return line.dump();
}

}  // namespace aspic::cli
