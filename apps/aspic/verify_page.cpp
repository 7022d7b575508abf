// Results of checks as a page and as JSON.
#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "aspic/commands.h"
#include "aspic/formulas.h"
#include "aspic/plot.h"
#include "aspic/report_page.h"
#include "aspic/verify.h"
#include "base/error.h"
#include "dynamics/integrator.h"
#include "dynamics/simulation.h"
#include "io/atomic_file.h"
#include "io/external_program.h"
#include "material/registry.h"

namespace aspic::cli {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

// Both enumerations have the same order.
static_assert(static_cast<int>(SeriesStyle::line_and_points) == static_cast<int>(verify::CurveStyle::line_and_points));

Chart chart_of(const verify::Plot& plot) {
  const AxisScale scale = plot.scales == verify::Scales::logarithmic ? AxisScale::logarithmic : AxisScale::linear;
  Chart chart{plot.title, {.label = plot.x_label, .scale = scale}, {.label = plot.y_label, .scale = scale}, {}};
  for (const verify::Curve& curve : plot.curves)
    chart.series.push_back({curve.label, curve.x, curve.y, static_cast<SeriesStyle>(curve.style), curve.color});
  return chart;
}

// Values that could not be computed are null, because JSON has no NaN.
Json number_json(double value) { return std::isfinite(value) ? Json(value) : Json(); }

Json to_json(const Verification& result) {
  const verify::Check& check = *result.check;
  Json json = {{"check", check.key()},
               {"title", check.title},
               {"problem", check.problem},
               {"reference", check.reference},
               {"formulas", check.formulas},
               {"source", check.source},
               {"passes", result.findings.passes()},
               {"seconds", result.seconds},
               {"rows", Json::array()}};
  for (const verify::Row& row : result.findings.rows)
    json["rows"].push_back({{"quantity", row.quantity},
                            {"measured", number_json(row.measured)},
                            {"reference", number_json(row.reference)},
                            {"tolerance", number_json(row.tolerance)},
                            {"unit", row.unit},
                            {"reason", row.reason},
                            {"passes", row.passes()}});
  return json;
}

std::string sources_text(const verify::Check& check) {
  std::string text = "Reference: " + check.reference;
  for (const std::string& key : check.source) text += " [" + key + "]";
  return text + ".";
}

Cell verdict_cell(bool passes) { return {passes ? "pass" : "fail", passes ? Verdict::pass : Verdict::fail}; }

void add_overview(ReportPage& page, const std::vector<Verification>& results) {
  page.heading("All checks");
  page.paragraph(count_text(results));
  std::vector<std::vector<Cell>> rows;
  for (const Verification& result : results)
    rows.push_back({verdict_cell(result.findings.passes()),
                    {result.check->title},
                    {std::to_string(result.findings.rows.size())},
                    {result.check->key()}});
  page.table({"", "check", "rows", "name"}, rows);
}

// Formulas as MathML, or as TeX if the program was built without the viewer.
void add_formulas(ReportPage& page, const std::vector<std::string>& tex) {
  for (const std::string& formula : tex) {
    const std::vector<std::string> rendered = formulas_of(formula);
    rendered.empty() ? page.code(formula) : page.formula(rendered.front());
  }
}

void add_densities(ReportPage& page) {
  page.heading("Strain energy densities");
  page.paragraph("I1 = tr F'F, J = det F; mu and lambda are the Lame constants of E and nu.");
  for (const MaterialInfo& info : materials()) {
    page.paragraph(info.name);
    add_formulas(page, info.tex);
  }
}

void add_update_rules(ReportPage& page) {
  page.heading("Update rules of the integrators");
  page.paragraph("h: time step, v: velocity, a: acceleration, M a = -dV/dq - C v with the damping C.");
  for (const std::string& name : integrator_names()) {
    page.paragraph(name);
    add_formulas(page, {std::string(make_integrator(name)->facts().tex)});
  }
}

void add_judged(ReportPage& page, const Verification& result, const std::vector<Figure>& figures) {
  page.heading(result.check->title);
  page.verdict(result.findings.passes() ? Verdict::pass : Verdict::fail, result.findings.passes() ? "pass" : "fail",
               fmt::format("{:.1f} s", result.seconds));
  page.paragraph(result.check->problem);
  page.paragraph(sources_text(*result.check));
  add_formulas(page, result.check->formulas);
  page.code("aspic verify --only " + result.check->key());
  std::vector<std::vector<Cell>> rows;
  std::string reason;  // printed once for consecutive rows with the same reason
  for (const verify::Row& row : result.findings.rows) {
    rows.push_back({verdict_cell(row.passes()),
                    {row.quantity},
                    {value_text(row.measured, row)},
                    {value_text(row.reference, row)},
                    {tolerance_text(row)},
                    {row.reason == reason ? "" : row.reason}});
    reason = row.reason;
  }
  page.table({"", "quantity", "measured", "reference", "tolerance", "reason of the tolerance"}, rows);
  if (!figures.empty()) page.figures(figures);
}

std::vector<Figure> drawn(const Verification& result, const fs::path& folder) {
  std::vector<Figure> figures;
  for (const verify::Plot& plot : result.findings.plots) {
    const fs::path path = folder / fmt::format("{}.svg", figures.size());
    draw(path, chart_of(plot));
    figures.push_back({path, plot.title});
  }
  return figures;
}

}  // namespace

void write_verification(const fs::path& folder, const std::vector<Verification>& results, const std::string& how) {
  const TemporaryFolder pictures;
  ReportPage page("What is verified", how);
  for (const std::string& style : formulas_of("style")) page.formula(style);
  page.code(version_text());
  add_overview(page, results);
  bool draws = true;
  std::string family;
  for (const Verification& result : results) {
    if (result.check->family != std::exchange(family, result.check->family)) {
      if (family == "materials") add_densities(page);
      if (family == "integrators") add_update_rules(page);
    }
    std::vector<Figure> figures;
    try {
      if (draws) figures = drawn(result, pictures.path());
    } catch (const InvalidInput& error) {
      draws = false;
      fmt::print(stderr, "note: no plots in the page: {}\n", error.what());
    }
    add_judged(page, result, figures);
  }
  page.write(folder / "index.html");
  Json json = {{"what", how}, {"checks", Json::array()}};
  for (const Verification& result : results) json["checks"].push_back(to_json(result));
  write_file(folder / "verify.json", json.dump(2) + "\n");
}

}  // namespace aspic::cli
