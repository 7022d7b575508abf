#include "commands/fit_curves.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>
#include <sstream>

#include "aspic/plot.h"
#include "base/error.h"
#include "base/printable.h"
#include "capture/test_curves.h"
#include "commands/commands.h"
#include "io/csv_reader.h"
#include "io/text_scanner.h"

namespace aspic::cli {
namespace {

constexpr int kDrawnPoints = 200;  // points per fitted curve

struct Fitted {
  std::string data;  // name of the table
  std::vector<TestCurve> curves;
  CurveFit fit;
};

std::vector<TestCurve> chosen(const std::filesystem::path& file, const std::vector<std::string>& tests) {
  std::vector<TestCurve> curves = read_test_curves(file);
  if (tests.empty()) return curves;
  std::vector<std::string> known;
  for (const TestCurve& curve : curves) known.push_back(curve.name);
  for (const std::string& test : tests)
    if (std::find(known.begin(), known.end(), test) == known.end())
      throw InvalidInput(file.string() + ": has no test '" + test + "'" + suggestion(test, known));
  std::erase_if(curves,
                [&](const TestCurve& c) { return std::find(tests.begin(), tests.end(), c.name) == tests.end(); });
  return curves;
}

std::string sigma_text(const FittedParameter& f) {
  if (f.is_held) return "held";
  if (f.at_bound) return "at the end of its range";
  if (std::isinf(f.sigma)) return "not determined by these curves";
  return fmt::format("+- {:.2g}", f.sigma);
}

void print(const Fitted& fitted) {
  const CurveFit& fit = fitted.fit;
  fmt::print("{}, {}\n", fitted.data, fit.material);
  for (const FittedParameter& f : fit.fitted)
    fmt::print("  {:<14} {:>12.6g} {:<4} {}\n", f.name, f.value, f.unit, sigma_text(f));
  fmt::print("  {:<14} {:>10} {:>10} {:>10} {:>14}\n", "test", "relative", "largest", "R^2", "rms [Pa]");
  for (const CurveErrors& c : fit.curves)
    fmt::print("  {:<14} {:>9.2f}% {:>9.2f}% {:>10.5f} {:>14.5g}\n", c.name, 100 * c.relative, 100 * c.largest,
               c.r_squared, c.rms);
  fmt::print("  {:<14} {:>9.2f}% {:>10} {:>10.5f}\n", "all", 100 * fit.relative, "", fit.r_squared);
  const auto best = *std::min_element(fit.starts.begin(), fit.starts.end());
  const auto same =
      std::count_if(fit.starts.begin(), fit.starts.end(), [&](double s) { return s <= best * (1 + 1e-6) + 1e-300; });
  if (fit.starts.size() > 1) fmt::print("  {} of {} initial guesses end here\n", same, fit.starts.size());
  if (!fit.is_converged) fmt::print("  did not converge in {} iterations\n", fit.iterations);
  fmt::print("  {}\n\n", scene_line(fit));
}

void print_table(const std::vector<Fitted>& all) {
  fmt::print("| data | material | parameters | uniaxial | equibiaxial | planar | all | R^2 |\n");
  fmt::print("|---|---|---:|---:|---:|---:|---:|---:|\n");
  for (const Fitted& fitted : all) {
    const auto error = [&](const char* test) -> std::string {
      for (const CurveErrors& c : fitted.fit.curves)
        if (c.name == test) return fmt::format("{:.1f} %", 100 * c.relative);
      return "";
    };
    const auto free = std::count_if(fitted.fit.fitted.begin(), fitted.fit.fitted.end(),
                                    [](const FittedParameter& f) { return !f.is_held && !f.at_bound; });
    fmt::print("| {} | {} | {} | {} | {} | {} | {:.1f} % | {:.5f} |\n", fitted.data, fitted.fit.material, free,
               error("uniaxial"), error("equibiaxial"), error("planar"), 100 * fitted.fit.relative,
               fitted.fit.r_squared);
  }
}

nlohmann::ordered_json to_json(const Fitted& fitted) {
  nlohmann::ordered_json parameters = nlohmann::json::array(), curves = nlohmann::json::array();
  for (const FittedParameter& f : fitted.fit.fitted) {
    nlohmann::ordered_json p = {{"name", f.name}, {"unit", f.unit}, {"value", f.value}};
    p["deviation"] = std::isfinite(f.sigma) ? nlohmann::ordered_json(f.sigma) : nullptr;
    p["at_bound"] = f.at_bound;
    p["held"] = f.is_held;
    parameters.push_back(std::move(p));
  }
  for (const CurveErrors& c : fitted.fit.curves)
    curves.push_back({{"test", c.name},
                      {"relative", c.relative},
                      {"largest", c.largest},
                      {"r_squared", c.r_squared},
                      {"rms", c.rms},
                      {"predicted", c.predicted}});
  return {{"data", fitted.data},
          {"material", fitted.fit.material},
          {"converged", fitted.fit.is_converged},
          {"parameters", parameters},
          {"curves", curves},
          {"relative", fitted.fit.relative},
          {"r_squared", fitted.fit.r_squared},
          {"scene", scene_line(fitted.fit)}};
}

void draw_fits(const CurveFitRequest& request, const std::vector<Fitted>& all) {
  double largest = 0;
  for (const TestCurve& curve : all.front().curves)
    for (const double s : curve.stress) largest = std::fmax(largest, std::abs(s));
  const double unit = largest >= 1e5 ? 1e6 : largest >= 1e2 ? 1e3 : 1;
  Chart chart{.title = all.front().data,
              .x = {.label = "stretch, or amount of shear"},
              .y = {.label = unit == 1e6   ? "nominal stress [MPa]"
                             : unit == 1e3 ? "nominal stress [kPa]"
                                           : "nominal stress [Pa]"},
              .series = {}};
  for (size_t c = 0; c < all.front().curves.size(); ++c) {
    const TestCurve& curve = all.front().curves[c];
    Series measured{
        .label = curve.name, .x = curve.stretch, .y = {}, .style = SeriesStyle::points, .color = static_cast<int>(c)};
    for (const double s : curve.stress) measured.y.push_back(s / unit);
    chart.series.push_back(std::move(measured));
    const auto [from, to] = std::minmax_element(curve.stretch.begin(), curve.stretch.end());
    for (size_t a = 0; a < all.size(); ++a) {
      const CurveFit& fit = all[a].fit;
      Series line{.label = c == 0 ? fit.material : "",
                  .x = {},
                  .y = {},
                  .style = a == 0 ? SeriesStyle::line : SeriesStyle::dashed,
                  .color = static_cast<int>(c)};
      for (int i = 0; i <= kDrawnPoints; ++i) {
        const double l = *from + i * (*to - *from) / kDrawnPoints;
        const HomogeneousState s =
            homogeneous_state(fit.material, fit.parameters, curve.deformation, l, request.options.volume);
        line.x.push_back(l);
        line.y.push_back(s.is_found ? s.stress / unit : std::nan(""));
      }
      chart.series.push_back(std::move(line));
    }
  }
  draw(request.picture, chart);
}

// Removes points outside the range; `largest` has one value per curve in order, or is empty.
void cut(std::vector<TestCurve>& curves, double least, const std::vector<double>& largest) {
  for (size_t k = 0; k < curves.size(); ++k) {
    TestCurve& curve = curves[k];
    const double most = k < largest.size() ? largest[k] : std::numeric_limits<double>::infinity();
    TestCurve kept{curve.name, curve.deformation, {}, {}};
    for (size_t i = 0; i < curve.stretch.size(); ++i)
      if (curve.stretch[i] >= least && curve.stretch[i] <= most) {
        kept.stretch.push_back(curve.stretch[i]);
        kept.stress.push_back(curve.stress[i]);
      }
    curve = std::move(kept);
  }
}

std::vector<std::string> words(const std::string& text) {
  std::istringstream in(text);
  return {std::istream_iterator<std::string>(in), {}};
}

std::vector<double> numbers(const CsvReader& csv, size_t column) {
  std::vector<double> numbers;
  for (const std::string& word : words(csv.text(column))) {
    const std::optional<double> number = parse_number(word);
    if (!number)
      throw InvalidInput(csv.where() + ": '" + word + "' is no stretch; give one number per test, or leave it empty");
    numbers.push_back(*number);
  }
  return numbers;
}

double rms(const CurveFit& fit) {
  double sum = 0, count = 0;
  for (const CurveErrors& c : fit.curves) {
    const auto n = static_cast<double>(c.predicted.size());
    sum += n * c.rms * c.rms;
    count += n;
  }
  return std::sqrt(sum / count);
}

// Prints a Markdown table of the published error and the error of our fit to the same points.
int compare_with_published(const CurveFitRequest& request) {
  CsvReader csv(request.published);
  const size_t data = csv.column("data"), tests = csv.column("tests"), least = csv.column("least_stretch"),
               largest = csv.column("largest_stretch"), model = csv.column("model"), measure = csv.column("measure"),
               value = csv.column("value");
  bool converged = true;
  fmt::print("| data | tests | measure | published | of | {} |\n|---|---|---|---:|---|---:|\n",
             fmt::join(request.materials, " | "));
  while (csv.next()) {
    std::string row = fmt::format("| {} | {} | {} | {:.5g} | {} |", csv.text(data), csv.text(tests), csv.text(measure),
                                  csv.number(value), csv.text(model));
    std::vector<TestCurve> curves =
        chosen(request.published.parent_path() / (csv.text(data) + ".csv"), words(csv.text(tests)));
    cut(curves, csv.number(least), numbers(csv, largest));
    for (const std::string& material : request.materials) {
      CurveFitOptions options = request.options;
      options.material = material;
      const CurveFit fit = aspic::fit_curves(curves, options);
      converged &= fit.is_converged;
      const std::string& unit = csv.text(measure);
      row += fmt::format(" {:.5g} |", unit == "rms_MPa"   ? 1e-6 * rms(fit)
                                      : unit == "rms_kPa" ? 1e-3 * rms(fit)
                                                          : fit.r_squared);
    }
    fmt::print("{}\n", row);
  }
  return converged ? exit_done : exit_unconverged;
}

}  // namespace

int fit_curves(const CurveFitRequest& request) {
  if (!request.published.empty()) return compare_with_published(request);
  if (request.files.empty()) throw InvalidInput("give at least one FILE with curves, or --published TABLE");
  if (!request.picture.empty()) {
    require_drawable(request.picture);
    if (request.files.size() > 1) throw InvalidInput("--plot draws one table; give one FILE");
  }
  for (const std::filesystem::path& file : request.files)
    if (std::error_code error; std::filesystem::is_directory(file, error))
      throw InvalidInput(file.string() + ": is a folder; to fit a data set: aspic fit " + file.string());
  std::vector<Fitted> all;
  for (const std::filesystem::path& file : request.files)
    for (const std::string& material : request.materials) {
      Fitted fitted{.data = printable(file.stem().string()), .curves = chosen(file, request.tests), .fit = {}};
      CurveFitOptions options = request.options;
      options.material = material;
      fitted.fit = aspic::fit_curves(fitted.curves, options);
      all.push_back(std::move(fitted));
    }
  if (request.json) {
    nlohmann::ordered_json list = nlohmann::json::array();
    for (const Fitted& fitted : all) list.push_back(to_json(fitted));
    fmt::print("{}\n", list.dump(2));
  } else if (request.table) {
    print_table(all);
  } else {
    for (const Fitted& fitted : all) print(fitted);
  }
  if (!request.picture.empty()) draw_fits(request, all);
  const bool converged = std::all_of(all.begin(), all.end(), [](const Fitted& f) { return f.fit.is_converged; });
  return converged ? exit_done : exit_unconverged;
}

void add_fit_curves(CLI::App& app, Action& action) {
  const auto request = std::make_shared<CurveFitRequest>();
  const auto compressible = std::make_shared<bool>(false);
  request->materials = {"spline"};
  CLI::App* command =
      app.add_subcommand("fit-curves", "Fits materials to curves of uniaxial, equibiaxial, planar and shear tests");
  command->footer(
      "\nA table has the columns test (uniaxial, equibiaxial, planar, simple_shear), stretch (or amount of shear)\n"
      "and stress_Pa, stress_kPa or stress_MPa: force per area at rest.\n\n"
      "Examples:\n"
      "  aspic fit-curves data/rubber/treloar_1944.csv\n"
      "  aspic fit-curves data/rubber/treloar_1944.csv --material fung spline --plot treloar.svg\n"
      "  aspic fit-curves data/rubber/*.csv --material mooney_rivlin spline --table");
  command->add_option("FILE", request->files, "Tables of curves to fit");
  command->add_option("--material", request->materials, "Materials to fit, each separately")->capture_default_str();
  command->add_option("--test", request->tests, "Tests of the tables to use; all by default");
  command->add_option("--hold", request->options.held, "Material parameters to keep at their defaults");
  const std::map<std::string, Weighting> weightings = {
      {"absolute", Weighting::absolute}, {"balanced", Weighting::balanced}, {"relative", Weighting::relative}};
  command
      ->add_option("--weighting", request->options.weighting,
                   "Equal weight for each stress (absolute), curve (balanced) or relative error (relative)")
      ->transform(CLI::CheckedTransformer(weightings).description("{absolute,balanced,relative}"))
      ->default_str("balanced");
  command->add_option("--poisson", request->options.poisson, "Poisson's ratio of the material for scenes")
      ->capture_default_str();
  command->add_flag("--compressible", *compressible,
                    "Assume a body with this Poisson's ratio instead of an incompressible one");
  command->add_option("--starts", request->options.starts, "Number of initial guesses")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  command->add_option("--plot", request->picture, "Plot measured and fitted curves: FILE.svg or FILE.png");
  command->add_flag("--table", request->table, "Print a Markdown table of relative errors");
  command->add_option("--published", request->published,
                      "Compare with the published errors in this table, for the tables beside it");
  command->add_flag("--json", request->json, "Print JSON");
  command->callback([request, compressible, &action] {
    request->options.volume = *compressible ? Volume::compressible : Volume::incompressible;
    action = [request] { return fit_curves(*request); };
  });
}

}  // namespace aspic::cli
