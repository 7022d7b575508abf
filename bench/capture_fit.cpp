// Fits a material field to synthetic indentations: time, work, and accuracy for a stiff ball.
#include <cmath>
#include <cstdio>

#include "base/parallel.h"
#include "bench/machine.h"
#include "bench/program.h"
#include "bench/results.h"
#include "bench/stopwatch.h"
#include "bench/virtual_capture.h"
#include "fit/fit.h"

namespace aspic::bench {
namespace {

struct Choices {
  VirtualCapture setup;
  FitOptions fit;
  RegularizerOptions prior;
  EquilibriumOptions equilibrium;
  std::string smoothness = "h1";
  double guess = 2;  // initial guess relative to the stiffness of the tissue
  bool quiet = false;
  std::string csv;
};

// Comparison of the fitted field with the truth over the body.
struct Recovery {
  double error = 0;     // relative RMS error of z = log E: |z - truth| / |truth - mean(truth)|
  double contrast = 0;  // ratio of the geometric means of E inside and outside
  double outside = 0;   // geometric mean of E outside relative to the tissue
};

Recovery recovery(const Captured& data, std::span<const double> z) {
  const size_t n = data.truth.size();
  double mean = 0, in = 0, out = 0, count = 0, truth_out = 0;
  for (size_t t = 0; t < n; ++t) {
    mean += data.truth[t] / static_cast<double>(n);
    data.inside[t] ? (in += z[t], ++count) : (out += z[t], truth_out = data.truth[t]);
  }
  double difference = 0, size = 0;
  for (size_t t = 0; t < n; ++t) {
    difference += (z[t] - data.truth[t]) * (z[t] - data.truth[t]);
    size += (data.truth[t] - mean) * (data.truth[t] - mean);
  }
  const double outside = out / (static_cast<double>(n) - count);
  return {std::sqrt(difference / size), std::exp(in / count - outside), std::exp(outside - truth_out)};
}

void print_iteration(const FitIteration& i, const Misfit& misfit, double seconds) {
  const Misfit::Counts c = misfit.counts();
  std::printf("%4d %10.3g %12.4g %10.4g %10.3g %8.3g %5d %6d | %5ld %6ld %6ld %7ld %8.1f\n", i.index, i.weight,
              2 * i.misfit / misfit.residual_count(), i.roughness, i.decrement, i.step, i.inner, i.trials, c.equilibria,
              c.newton_iterations, c.factorizations, c.solves, seconds);
  std::fflush(stdout);
}

void record(const Choices& choices, const Misfit& misfit, const FitReport& report, const Stopwatch& stopwatch,
            const Recovery& found) {
  const Misfit::Counts c = misfit.counts();
  Results results("capture_fit");
  results.begin(report.method + ", " + choices.smoothness + ", " + std::to_string(choices.setup.cells) + " cells",
                thread_count());
  results.add("wall", stopwatch.seconds(), "s");
  results.add("processor", stopwatch.cpu_seconds(), "s");
  results.add("iterations", report.iterations, "1");
  results.add("evaluations", report.evaluations, "1");
  results.add("products", static_cast<double>(report.products), "1");
  results.add("equilibria", static_cast<double>(c.equilibria), "1");
  results.add("newton_iterations", static_cast<double>(c.newton_iterations), "1");
  results.add("factorizations", static_cast<double>(c.factorizations), "1");
  results.add("solves", static_cast<double>(c.solves), "1");
  results.add("error_of_log_young", found.error, "1");
  results.add("contrast", found.contrast, "1");
  results.write(choices.csv);
}

int measure(Choices& choices) {
  if (!choices.quiet) print_facts(machine_facts());
  const Captured data = capture(choices.setup);
  const TetMesh& mesh = data.experiment.mesh;
  const ParameterMap map(mesh, "neo_hookean", known(choices.setup, mesh),
                         {{"young", Parameterization::tets, 0, choices.guess * choices.setup.young}});
  choices.prior.smoothness = choices.smoothness == "tv"   ? Smoothness::total_variation
                             : choices.smoothness == "h1" ? Smoothness::h1
                                                          : Smoothness::none;
  Stopwatch stopwatch;
  const auto prior = make_regularizer(mesh, map, choices.prior);
  Misfit misfit(data.experiment, map, choices.equilibrium);
  std::printf(
      "%d vertices, %d parameters, %zu cases, %d residuals, %d threads\n%4s %10s %12s %10s %10s %8s %5s %6s | %5s %6s "
      "%6s %7s %8s\n",
      mesh.vertex_count(), map.size(), data.experiment.cases.size(), misfit.residual_count(), thread_count(), "",
      "weight", "|r|^2 / m", "roughness", "decrement", "step", "inner", "trials", "equil", "newton", "factor", "solves",
      "seconds");
  const FitReport report =
      fit(misfit, *prior, map.guess(), choices.fit, [&](const FitIteration& i, std::span<const double>) {
        print_iteration(i, misfit, stopwatch.seconds());
        return true;
      });
  const Recovery found = recovery(data, report.p);
  std::printf(
      "%s: %s\n%.1f s of wall time, %.1f s of CPU time, %d iterations, %d evaluations, %d products with J or J'\n"
      "relative error of log E %.3f, contrast %.2f of %.2f, outside %.3f of the truth\n",
      report.method.c_str(), report.message.c_str(), stopwatch.seconds(), stopwatch.cpu_seconds(), report.iterations,
      report.evaluations, report.products, found.error, found.contrast, choices.setup.contrast, found.outside);
  record(choices, misfit, report, stopwatch, found);
  return is_success(report.status) ? 0 : 1;
}

}  // namespace
}  // namespace aspic::bench

int main(int argc, char** argv) {
  using namespace aspic::bench;
  Choices c;
  CLI::App app("Fits a stiffness field to synthetic pokes of a cube with a stiff ball inside.");
  app.add_option("--cells", c.setup.cells, "Cells along each edge of the fitted mesh")->capture_default_str();
  app.add_option("--data-cells", c.setup.data_cells, "Cells along each edge of the mesh of the data")
      ->capture_default_str();
  app.add_option("--pokes", c.setup.indentations, "Number of indentations, 1 to 9")
      ->capture_default_str()
      ->check(CLI::Range(1, 9));
  app.add_option("--markers", c.setup.markers)->capture_default_str();
  app.add_option("--noise", c.setup.noise, "Noise relative to the largest motion and force")->capture_default_str();
  app.add_option("--contrast", c.setup.contrast, "Stiffness of the ball relative to the tissue")->capture_default_str();
  app.add_option("--method", c.fit.method)->capture_default_str();
  app.add_option("--weight", c.fit.weight, "Weight of the regularizer; < 0: chosen by the rule")->capture_default_str();
  app.add_option("--weight-rule", c.fit.weight_rule)->capture_default_str();
  app.add_option("--tolerance", c.fit.tolerance)->capture_default_str();
  app.add_option("--enough", c.fit.enough)->capture_default_str();
  app.add_option("--iterations", c.fit.max_iterations)->capture_default_str();
  app.add_option("--smoothness", c.smoothness, "Smoothness of the field: h1, tv or none")->capture_default_str();
  app.add_option("--deviation", c.prior.prior_sigma, "Standard deviation of the prior of log E")->capture_default_str();
  app.add_option("--sharpness", c.prior.sharpness, "Sharpness of total variation")->capture_default_str();
  app.add_option("--linear", c.equilibrium.linear, "Linear solver of Newton steps")->capture_default_str();
  app.add_option("--adjoint", c.equilibrium.adjoint, "Linear solver of tangents and adjoints")->capture_default_str();
  app.add_option("--adjoint-tolerance", c.equilibrium.adjoint_tolerance)->capture_default_str();
  app.add_option("--equilibrium-tolerance", c.equilibrium.tolerance)->capture_default_str();
  app.add_option("--guess", c.guess, "Initial guess relative to the stiffness of the tissue")->capture_default_str();
  app.add_option("--csv", c.csv, "CSV file to write the results to");
  app.add_flag("--quiet", c.quiet, "Omit the description of the machine");
  return run_program(app, argc, argv, [&] { return measure(c); });
}
