// `aspic check --derivatives`: compares gradients and Hessians of all terms with differences.
#include "aspic/check_derivatives.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "aspic/commands.h"
#include "aspic/plot.h"
#include "dynamics/step_derivatives.h"

namespace aspic::cli {
namespace {

std::string order_text(const DerivativeCheck& check) {
  return std::isfinite(check.order) ? fmt::format("{:.2f}", check.order) : "-";
}

// "vertex 12, y", or for a Hessian "vertex 12, y; vertex 3, x (tet 57)", in the user's numbering.
std::string place(const DerivativeCheck& check, const Model& model) {
  if (check.row < 0) return "";
  const Renumbering &vertex = model.numbering.vertex, &tet = model.numbering.tet;
  const auto name = [&](int entry) { return entry_name(3 * vertex.to_user(entry / 3) + entry % 3); };
  std::string text = name(check.row);
  if (check.column >= 0 && check.column != check.row) text += "; " + name(check.column);
  const int with = tet_with(model.mesh, check.row / 3, (check.column >= 0 ? check.column : check.row) / 3);
  return with >= 0 ? fmt::format("{} (tet {})", text, tet.to_user(with)) : text;
}

void print_failure(const char* what, const DerivativeCheck& check, const TermDerivatives& of, const Model& model) {
  if (check.passed) return;
  if (check.row < 0)
    fmt::print("{} of {} ({}): not finite at any step\n", what, of.term, of.state);
  else
    fmt::print("{} of {} ({}) differs most at {}: formula {:.12g}, differences {:.12g}\n", what, of.term, of.state,
               place(check, model), check.found, check.expected);
}

nlohmann::ordered_json to_json(const DerivativeCheck& check, const Model& model) {
  return {{"passed", check.passed},
          {"smallest_error", check.smallest_error},
          {"order", check.order},  // null: only round-off error
          {"step", check.step},
          {"error", check.error},
          {"worst", {{"place", place(check, model)}, {"found", check.found}, {"expected", check.expected}}}};
}

void print_json(const std::vector<TermDerivatives>& results, const Model& model) {
  for (const TermDerivatives& of : results) {
    const nlohmann::ordered_json line = {{"term", of.term},
                                         {"state", of.state},
                                         {"passed", of.report.passed()},
                                         {"gradient", to_json(of.report.gradient, model)},
                                         {"hessian", to_json(of.report.hessian, model)}};
    fmt::print("{}\n", line.dump());
  }
}

void print_table(const std::vector<TermDerivatives>& results, const Model& model, double tolerance) {
  size_t width = 4;
  for (const TermDerivatives& of : results) width = std::max(width, of.term.size());
  fmt::print("{:<{}}  {:<8}  {:^18}  {:^18}\n", "", width, "", "gradient", "Hessian");
  fmt::print("{:<{}}  {:<8}  {:>6} {:>11}  {:>6} {:>11}\n", "term", width, "state", "order", "error", "order", "error");
  for (const TermDerivatives& of : results) {
    const DerivativeCheck &g = of.report.gradient, &H = of.report.hessian;
    fmt::print("{:<{}}  {:<8}  {:>6} {:>11.2e}  {:>6} {:>11.2e}  {}\n", of.term, width, of.state, order_text(g),
               g.smallest_error, order_text(H), H.smallest_error, of.report.passed() ? "passed" : "WRONG");
  }
  fmt::print(
      "\norder: convergence order of central differences; 2 is correct, - means only round-off\n"
      "error: smallest error for steps of 1e-1 to 1e-9 edges, relative to the derivative; tolerance {:g}\n",
      tolerance);
  for (const TermDerivatives& of : results) {
    print_failure("the gradient", of.report.gradient, of, model);
    print_failure("the Hessian", of.report.hessian, of, model);
  }
}

// Largest error over the states for each term and derivative.
Chart chart_of(const std::vector<TermDerivatives>& results, const std::string& scene) {
  Chart chart{.title = fmt::format("Derivatives of {}: differences and formulas", scene),
              .x = {"step / mean edge length", AxisScale::logarithmic},
              .y = {"relative error", AxisScale::logarithmic},
              .size = {780, 520}};
  std::map<std::string, size_t> known;
  int color = 0;
  const auto add = [&](const std::string& label, const DerivativeCheck& check, SeriesStyle style, int of_term) {
    if (std::all_of(check.error.begin(), check.error.end(), [](double e) { return e == 0; })) return;
    const auto [at, is_new] = known.emplace(label, chart.series.size());
    if (is_new) {
      chart.series.push_back({label, check.step, check.error, style, of_term});
      return;
    }
    std::vector<double>& error = chart.series[at->second].y;
    for (size_t i = 0; i < error.size(); ++i) error[i] = std::fmax(error[i], check.error[i]);
  };
  std::map<std::string, int> colors;
  for (const TermDerivatives& of : results) {
    const int of_term = colors.emplace(of.term, color).second ? color++ : colors[of.term];
    add(of.term + ": gradient", of.report.gradient, SeriesStyle::line_and_points, of_term);
    add(of.term + ": Hessian", of.report.hessian, SeriesStyle::dashed, of_term);
  }
  chart.series.push_back({"slope 2", {1e-1, 1e-5}, {1e-2, 1e-10}, SeriesStyle::line, 6});
  return chart;
}

}  // namespace

int check_derivatives(const Scene& scene, const CheckDerivativesOptions& options) {
  if (!options.plot.empty()) require_drawable(options.plot);
  const std::vector<TermDerivatives> results = check_step_derivatives(scene.simulation, options.tolerance);
  const Model& model = scene.simulation.model();
  if (options.json) {
    print_json(results, model);
  } else {
    fmt::print("{}: {} vertices, {} tets\n\n", scene.name, model.mesh.vertex_count(), model.mesh.tet_count());
    print_table(results, model, options.tolerance);
  }
  if (!options.plot.empty()) draw(options.plot, chart_of(results, scene.name));
  const bool passed = std::all_of(results.begin(), results.end(), [](const auto& of) { return of.report.passed(); });
  return passed ? exit_done : exit_unconverged;
}

}  // namespace aspic::cli
