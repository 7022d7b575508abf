#include "commands/law_table.h"

#include <fmt/format.h>

#include <cmath>

#include "commands/fit_summary.h"

namespace aspic::cli {
namespace {

using LawJson = nlohmann::ordered_json;

std::string error_text(double part) { return part < 0 ? "-" : fmt::format("{:.2g} %", 100 * part); }

std::string values_text(const LawTrial& trial) {
  std::string text;
  for (const LawValue& v : trial.values)
    text += fmt::format("{}{}{} {}", text.empty() ? "" : ", ", v.quantity,
                        v.where == "everywhere" ? "" : " (" + v.where + ")", value_text(v.value, v.unit));
  return text;
}

LawJson finite_number(double value) { return std::isfinite(value) ? LawJson(value) : LawJson(); }

LawJson json_of(const LawTrial& trial) {
  if (!trial.is_fitted()) return {{"law", trial.law}, {"ok", false}, {"verdict", trial.verdict}};
  LawJson values = LawJson::object();
  for (const LawValue& v : trial.values) {
    values[v.quantity][v.where] = {{"value", v.value}, {"unit", v.unit}};
    if (v.interval)
      values[v.quantity][v.where]["lower"] = v.interval->lower,
      values[v.quantity][v.where]["upper"] = v.interval->upper;
  }
  return {{"law", trial.law},
          {"ok", true},
          {"values", values},
          {"parameters", trial.parameters},
          {"squares_per_reading", trial.squares / trial.residuals},
          {"position_error", trial.position_error},
          {"force_error", trial.force_error},
          {"evidence_loss", finite_number(trial.evidence_loss)},
          {"held_out_loss", finite_number(trial.held_out_loss)},
          {"as_good", trial.is_as_good},
          {"verdict", trial.verdict}};
}

}  // namespace

void print_laws(std::FILE* stream, const LawChoice& choice) {
  constexpr const char* kRow = "{:<10} {:<22} {:>8} {:>9} {:>9} {:>9} {:>8}  {}\n";
  fmt::print(stream, kRow, "laws", "", "|r|^2 per", "log", "held out", "", "", "");
  fmt::print(stream, kRow, "", "", "reading", "evidence", "log prob.", "positions", "forces", "");
  for (const LawTrial& t : choice.trials) {
    if (t.is_fitted())
      fmt::print(stream, kRow, "", t.law, fmt::format("{:.3g}", t.squares / t.residuals),
                 fmt::format("{:.2f}", -t.evidence_loss), fmt::format("{:.2f}", -t.held_out_loss),
                 error_text(t.position_error), error_text(t.force_error), t.verdict + "; " + values_text(t));
    else
      fmt::print(stream, "           {:<22} {}\n", t.law, t.verdict);
  }
  fmt::print(stream, "           {}\n", choice.text);
}

LawJson json_of(const LawChoice& choice) {
  LawJson trials = LawJson::array();
  for (const LawTrial& trial : choice.trials) trials.push_back(json_of(trial));
  return {{"chosen", choice.chosen < 0 ? "" : choice.trials[static_cast<size_t>(choice.chosen)].law},
          {"text", choice.text},
          {"strain", choice.strain},
          {"noise_factor", choice.noise_factor},
          {"simplified", choice.simplified},
          {"trials", trials}};
}

}  // namespace aspic::cli
