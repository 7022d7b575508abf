#include "commands/fit_summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "mesh/tet_nodes.h"
#include "model/limits.h"
#include "pipeline/fitted_values.h"

namespace aspic::cli {
namespace {

std::string two_digit_percent(double part) { return fmt::format("{:.2g} %", 100 * part); }

std::string interval_text(const ValueRow& row, const std::string& unit) {
  if (!row.interval) return "";
  return fmt::format("95 %: {} to {}", value_text(row.interval->lower, unit), value_text(row.interval->upper, unit));
}

void print_values(std::FILE* stream, const FitOutcome& outcome) {
  for (const FittedQuantity& q : outcome.quantities) {
    std::string head = q.name;
    for (const ValueRow& row : q.rows) {
      fmt::print(stream, "{:<10} {:<13} {:<10} {}\n", head, row.where, value_text(row.value, q.unit),
                 interval_text(row, q.unit));
      head.clear();
    }
  }
  for (const auto& [quantity, value] : outcome.plan.known)
    fmt::print(stream, "{:<10} {:<13} {} (given)\n", quantity, "everywhere", value_text(value, ""));
}

// |r|^2 per reading; 1 is expected from the standard deviations.
std::string closeness(double misfit, int residuals) { return fmt::format("{:.3g}", 2 * misfit / residuals); }

void print_misfit(std::FILE* stream, const FitOutcome& outcome) {
  fmt::print(stream, "misfit     |r|^2 = {} per reading (1: as expected from the standard deviations)",
             closeness(outcome.report.misfit, outcome.residuals));
  if (outcome.uniform)
    fmt::print(stream, "; {} with one value for all", closeness(outcome.uniform->misfit, outcome.residuals));
  fmt::print(stream, "\n");
}

void print_fibres(std::FILE* stream, const FitOutcome& outcome) {
  std::string head = "fibres";
  for (const FoundFibres& f : outcome.fibres) {
    fmt::print(stream, "{:<10} {:<13} {}\n", head, f.where, fibre_text(f));
    head.clear();
  }
}

void print_parts(std::FILE* stream, const FitOutcome& outcome) {
  if (!outcome.parts) return;
  const FoundParts& found = *outcome.parts;
  if (!found.are_kept) {
    fmt::print(stream, "parts      none: they fit the data worse than the field ({} per reading)\n",
               closeness(found.squares / 2, outcome.residuals));
    return;
  }
  for (size_t k = 0; k < found.values.size(); ++k)
    fmt::print(stream, "{:<10} {:<13} {} of the body\n", k == 0 ? "parts" : "", "part " + std::to_string(k + 1),
               two_digit_percent(found.volume[k]));
  const ValueRow contrast{"contrast", found.values.back() / found.values.front(), found.contrast};
  fmt::print(stream, "{:<10} {:<13} {:<10} {}\n", "", contrast.where, value_text(contrast.value, ""),
             interval_text(contrast, ""));
}

void print_held_out(std::FILE* stream, const DataSet& data, const FitOutcome& outcome) {
  const std::vector<PredictionErrors> groups = beyond_noise(data, predicted_groups(data, outcome));
  const std::string text = errors_text(held_out_errors(data, outcome), 1);
  if (text.empty()) return;
  fmt::print(stream, "held out   each group predicted from the others: {}, beyond the noise\n", text);
  const auto excess = [](const PredictionErrors& e) { return e.*e.worst().beyond_noise / e.worst().limit; };
  const auto worst = std::max_element(groups.begin(), groups.end(),
                                      [&](const auto& a, const auto& b) { return excess(a) < excess(b); });
  if (groups.size() > 1) fmt::print(stream, "           worst: '{}', {}\n", worst->group, errors_text(*worst, kSingle));
}

std::string coefficient_text(const EstimatedError& e) {
  const std::string value = value_text(e.coefficient(), e.unit);
  if (e.sigma < 0) return value + ", interval unknown";
  const auto bound = [&](double sigmas) { return fmt::format("{:.4g}", e.coefficient(sigmas)); };
  return value + " (" + bound(-kSigmas95) + " to " + bound(kSigmas95) + " with 95 %)";
}

void print_errors(std::FILE* stream, const FitOutcome& outcome) {
  std::string head = "errors";
  for (const EstimatedError& e : outcome.errors) {
    const std::string value =
        e.stated ? coefficient_text(e)
                 : value_text(e.value, e.unit) + " +- " + (e.sigma < 0 ? "unknown" : value_text(e.sigma, e.unit));
    fmt::print(stream, "{:<10} {:<28} {}, {}\n", head, e.name, value,
               e.is_from_data() ? "determined by the data" : "determined by its prior");
    head.clear();
  }
}

void print_outliers(std::FILE* stream, const FitOutcome& outcome) {
  for (size_t i = 0; i < std::min(outcome.outliers.size(), kMaxListed); ++i)
    fmt::print(stream, "{:<10} {} in '{}' counts {:.2g}\n", i == 0 ? "outliers" : "", outcome.outliers[i].reading,
               outcome.outliers[i].load_case, outcome.outliers[i].weight);
  if (outcome.outliers.size() > kMaxListed)
    fmt::print(stream, "           and {} more, see figures.json\n", outcome.outliers.size() - kMaxListed);
}

}  // namespace

std::string mesh_text(const TetMesh& mesh) {
  return fmt::format("{} vertices, {} {}tets", lower_order(mesh).vertex_count(), mesh.tet_count(),
                     mesh.mids.empty() ? "" : "quadratic ");
}

std::string value_text(double value, const std::string& unit) {
  if (unit != "Pa" || value == 0 || !std::isfinite(value))
    return fmt::format("{:.4g}{}{}", value, unit.empty() ? "" : " ", unit);
  for (const auto& [factor, letter] : {std::pair{1e9, "G"}, {1e6, "M"}, {1e3, "k"}})
    if (std::abs(value) >= factor) return fmt::format("{:.4g} {}Pa", value / factor, letter);
  return fmt::format("{:.4g} Pa", value);
}

std::string errors_text(const PredictionErrors& errors, double limits) {
  std::vector<std::string> texts;
  for (const ReadingKind& kind : kReadingKinds) {
    if (errors.*kind.beyond_noise < 0) continue;
    const std::string limit = limits > 0 ? fmt::format(" (limit {:.3g} %)", 100 * limits * kind.limit) : "";
    texts.push_back(fmt::format("{}s within {:.3g} % of the largest {}{}", kind.name, 100 * errors.*kind.beyond_noise,
                                kind.peak, limit));
  }
  return fmt::format("{}", fmt::join(texts, ", "));
}

void print_fit(std::FILE* stream, const DataSet& data, const FitOutcome& outcome) {
  const FitReport& report = outcome.report;
  fmt::print(stream, "fit        {}: {} iterations, {} equilibria of {} cases; {}, weight {:.3g}\n", report.message,
             report.iterations, outcome.counts.equilibria, data.experiment.cases.size(), report.method, report.weight);
  fmt::print(stream, "mesh       {}\n", describe_mesh(outcome));
  print_misfit(stream, outcome);
  print_values(stream, outcome);
  print_fibres(stream, outcome);
  print_parts(stream, outcome);
  print_errors(stream, outcome);
  print_outliers(stream, outcome);
  if (outcome.posterior && outcome.posterior->ok)
    fmt::print(stream, "informed   the data determine {:.1f} of {} directions of the material\n",
               outcome.posterior->informed, outcome.parameter_count);
  print_held_out(stream, data, outcome);
  for (const std::string& warning : outcome.warnings) fmt::print(stream, "warning: {}\n", warning);
}

}  // namespace aspic::cli
