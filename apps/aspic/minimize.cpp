// `aspic minimize`: applies the minimizers of the simulation to functions of two variables.
#include "aspic/minimize.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "aspic/commands.h"
#include "aspic/interrupt.h"
#include "aspic/method_text.h"
#include "aspic/plot.h"
#include "base/error.h"
#include "base/number_chars.h"
#include "optimize/hessian_policy.h"
#include "optimize/solver.h"
#include "optimize/test_functions.h"
#include "results/trace.h"
#include "scene/expression_function.h"

namespace aspic::cli {
namespace {

namespace fs = std::filesystem;

struct MinimizeArguments {
  std::string function, expression, start;
  std::vector<std::string> methods = {"newton"};
  std::string definiteness, criterion = "scale", test = "textbook";
  SolverOptions solver;
  fs::path trace, plot, model;
  int iteration = 0;
  bool list = false, json = false;
};

Planar parse_start(const std::string& text) {
  Planar p{};
  const char* at = text.data();
  const char* const end = at + text.size();
  for (size_t i = 0; i < 2; ++i) {
    const auto [rest, error] = from_chars(at, end, p[i]);
    const bool closed = i == 0 ? rest != end && *rest == ',' : rest == end;
    if (error != std::errc() || !closed || !std::isfinite(p[i]))
      throw InvalidInput(fmt::format("--start {}: give two finite numbers x,y, such as -0.8,0.6", text));
    at = rest + (i == 0 ? 1 : 0);
  }
  return p;
}

Problem problem_of(const MinimizeArguments& arguments) {
  if (arguments.function.empty() == arguments.expression.empty())
    throw InvalidInput("give one function (see aspic minimize --list) or --expression \"...\"");
  Problem problem;
  if (!arguments.expression.empty()) {
    problem = {.name = "expression",
               .formula = arguments.expression,
               .function = std::make_unique<ExpressionFunction>(arguments.expression)};
    if (arguments.start.empty()) throw InvalidInput("--expression needs --start x,y");
  } else {
    problem = known_problem(arguments.function);
  }
  if (!arguments.start.empty()) problem.start = parse_start(arguments.start);
  if (!std::isfinite(problem.function->at(problem.start)))
    throw InvalidInput(fmt::format("the function is not finite at the start ({:g}, {:g}); choose another --start",
                                   problem.start[0], problem.start[1]));
  return problem;
}

void print_header() {
  fmt::print("{:>4} {:>13} {:>13} {:>15} {:>10} {:>10} {:>6}\n", "", "x", "y", "f", "|g|", "alpha", "trials");
}

void print_row(const IterationRecord& record) {
  const Iteration& it = record.iteration;
  fmt::print("{:>4} {:>13.6g} {:>13.6g} {:>15.8g} {:>10.3g} {:>10.4g} {:>6}{}\n", it.index, record.x[0], record.x[1],
             it.value, it.gradient_norm, it.alpha, it.trials, it.direction.projected ? "  projected" : "");
}

std::string json_row(const std::string& method, const IterationRecord& record) {
  nlohmann::ordered_json trials = nlohmann::json::array();
  for (const Trial& trial : record.tried)
    trials.push_back(
        {{"alpha", trial.alpha}, {"value", trial.value}, {"bound", trial.bound}, {"accepted", trial.accepted}});
  const Iteration& it = record.iteration;
  const nlohmann::ordered_json line = {{"method", method},
                                       {"iteration", it.index},
                                       {"x", record.x},
                                       {"value", it.value},
                                       {"gradient_norm", it.gradient_norm},
                                       {"direction", record.direction},
                                       {"decrement", it.decrement},
                                       {"alpha", it.alpha},
                                       {"trials", trials},
                                       {"projected", it.direction.projected}};
  return line.dump();
}

SolverOptions solver_of(const std::string& method, const MinimizeArguments& arguments) {
  SolverOptions solver = method_named(method, arguments.solver);
  if (!arguments.definiteness.empty()) solver.definiteness = arguments.definiteness;
  solver.minimize.criterion = criterion_named(arguments.criterion);
  solver.minimize.line_search.test = decrease_test_named(arguments.test);
  return solver;
}

Minimization minimize(const Problem& problem, const std::string& method, const MinimizeArguments& arguments) {
  const SolverOptions solver = solver_of(method, arguments);
  std::optional<Trace> trace;
  if (!arguments.trace.empty())
    trace.emplace(arguments.trace,
                  TraceOptions{{}, /*sufficient_decrease=*/solver.minimize.line_search.sufficient_decrease});
  if (!arguments.json) {
    fmt::print("{}: f = {}\n{}, from ({:g}, {:g})\n", problem.name, problem.formula,
               make_search_direction(solver)->description(), problem.start[0], problem.start[1]);
    print_header();
  }
  Minimization done = minimize(problem, solver, [&](const IterationRecord& record, const LiveIteration& live) {
    if (trace) trace->on_iteration(1, live);
    if (arguments.json)
      fmt::print("{}\n", json_row(method, record));
    else
      print_row(record);
  });
  if (trace) trace->close();
  done.method = method;
  return done;
}

double distance(const Planar& a, const Planar& b) { return std::hypot(a[0] - b[0], a[1] - b[1]); }

// Explains the status, with a remedy.
std::string describe(const Minimization& done) {
  const MinimizeReport& report = done.report;
  switch (report.status) {
    case Status::converged:
      return fmt::format("converged after {} iterations", report.iterations);
    case Status::round_off:
      return fmt::format("at the limit of precision after {} iterations", report.iterations);
    case Status::budget:  // only for time steps
    case Status::iteration_limit:
      return fmt::format(
          "not converged within {} iterations; increase --max-iterations, or the "
          "function has no minimum in this direction",
          report.iterations);
    case Status::stuck:
      return fmt::format(
          "stuck after {} iterations: no trial along the direction decreases f enough; reduce --decrease "
          "or --alpha-min",
          report.iterations);
    case Status::no_descent:
      return fmt::format(
          "no descent direction after {} iterations: {}", report.iterations,
          done.definiteness == NewtonDefiniteness::exact
              ? "the Hessian is not positive definite; try --definiteness on_demand"
              : "the quadratic model has no minimum here, and f may have none; try --method gradient_descent");
    case Status::undefined:
      return fmt::format(
          "f or its gradient is not finite after {} iterations: f has no lower bound, or is not "
          "defined there",
          report.iterations);
    case Status::interrupted:
    case Status::unstable:  // only for time steps
    case Status::inaccurate:
    case Status::inverted:
      break;
  }
  return fmt::format("interrupted after {} iterations", report.iterations);
}

// abs removes the sign of NaN.
void print_minimum(const Problem& problem, const Minimization& done) {
  const MinimizeReport& report = done.report;
  fmt::print("{:>4} {:>13.6g} {:>13.6g} {:>15.8g} {:>10.3g}\n\n", report.iterations, done.end[0], done.end[1],
             report.value, std::abs(report.gradient_norm));
  fmt::print("{}\n", describe(done));
  fmt::print("f = {:.12g} at ({:.10g}, {:.10g}); |g| = {:.3g}; residual {:.3g}, tolerance {:.3g}\n", report.value,
             done.end[0], done.end[1], std::abs(report.gradient_norm), std::abs(report.reached), report.threshold);
  fmt::print("evaluations: {} of f, {} of its gradient, {} of its Hessian ({} projected)\n", report.values,
             report.gradients, report.hessians, report.projected_hessians);
  if (!problem.minimizer) return;
  const double error = distance(done.end, *problem.minimizer);
  fmt::print("distance to the minimum at ({:.10g}, {:.10g}), where f = {:.12g}: {:.3g}\n", (*problem.minimizer)[0],
             (*problem.minimizer)[1], *problem.minimum, error);
  if (is_success(report.status) && error > 0.1)
    fmt::print("note: |g| is also small here, but this is not the minimum; try another --start or --tolerance\n");
}

void print_json_summary(const Problem& problem, const Minimization& done) {
  const MinimizeReport& report = done.report;
  nlohmann::ordered_json line = {{"method", done.method},
                                 {"status", to_string(report.status)},
                                 {"converged", is_success(report.status)},
                                 {"iterations", report.iterations},
                                 {"x", done.end},
                                 {"value", report.value},
                                 {"gradient_norm", report.gradient_norm},
                                 {"reached", report.reached},
                                 {"threshold", report.threshold},
                                 {"values", report.values},
                                 {"gradients", report.gradients},
                                 {"hessians", report.hessians},
                                 {"projected_hessians", report.projected_hessians}};
  if (problem.minimizer) line["distance"] = distance(done.end, *problem.minimizer);
  fmt::print("{}\n", line.dump());
}

int list() {
  for (const TestFunction& f : test_functions())
    fmt::print("{}\n  f = {}\n  {}\n  minimum {:.10g} at ({:.10g}, {:.10g}); default start ({:g}, {:g})\n\n", f.name,
               f.formula, f.remarks, f.minimum, f.minimizer[0], f.minimizer[1], f.start[0], f.start[1]);
  fmt::print("methods: {}\n", fmt::join(minimizer_names(), ", "));
  return exit_done;
}

// Throws InvalidInput, before any work.
void check(const MinimizeArguments& arguments) {
  if (arguments.methods.size() > 1 && !(arguments.trace.empty() && arguments.model.empty()))
    throw InvalidInput("--trace and --plot-model show a single method; give one --method");
  for (const fs::path& picture : {arguments.plot, arguments.model})
    if (!picture.empty()) require_drawable(picture);
  for (const std::string& method : arguments.methods) make_search_direction(solver_of(method, arguments));
}

int run(const MinimizeArguments& arguments) {
  if (arguments.list) return list();
  check(arguments);
  const Problem problem = problem_of(arguments);
  catch_interrupts();
  int code = exit_done;
  std::vector<Minimization> all;
  for (const std::string& method : arguments.methods) {
    const Minimization& done = all.emplace_back(minimize(problem, method, arguments));
    if (arguments.json)
      print_json_summary(problem, done);
    else
      print_minimum(problem, done);
    if (done.report.status == Status::interrupted) return exit_signal + interrupt_signal();
    if (!is_success(done.report.status)) code = exit_unconverged;
  }
  if (!arguments.model.empty()) draw_model(arguments.model, problem, all.front(), arguments.iteration);
  if (!arguments.plot.empty()) draw_paths(arguments.plot, "f = " + problem.formula, problem, all);
  return code;
}

void add_solver_options(CLI::App* command, MinimizeArguments& arguments) {
  MinimizeOptions& minimize = arguments.solver.minimize;
  minimize.max_iterations = 200;
  command
      ->add_option("--method", arguments.methods,
                   "Methods NAME[:OPTION...], separated by commas; newton by default; --list prints all")
      ->delimiter(',')
      ->allow_extra_args(false);
  command->add_option("--definiteness", arguments.definiteness,
                      fmt::format("Definiteness of Newton's Hessian: {}", fmt::join(definiteness_names(), ", ")));
  command->add_option("--criterion", arguments.criterion,
                      fmt::format("Convergence test: {}", fmt::join(criterion_names(), ", ")));
  command->add_option("--tolerance", minimize.tolerance, "Tolerance of the test, 1e-6 by default");
  command->add_option("--max-iterations", minimize.max_iterations, "Maximum iterations, 200 by default")
      ->check(CLI::Range(0, 1000000000));
  LineSearchOptions& search = minimize.line_search;
  command->add_option("--test", arguments.test,
                      fmt::format("Condition of the line search: {}", fmt::join(decrease_test_names(), ", ")));
  command->add_option("--alpha-max", search.alpha_max, "First trial of the line search, 1 by default");
  command->add_option("--decrease", search.sufficient_decrease, "Sufficient decrease c, 1e-4 by default");
  command->add_option("--shrink", search.shrink, "Factor p between trials, 0.5 by default");
  command->add_option("--alpha-min", search.tolerance, "Smallest trial tol, 1e-10 by default");
}

}  // namespace

void add_minimize(CLI::App& app, Action& action) {
  const auto arguments = std::make_shared<MinimizeArguments>();
  CLI::App* command =
      app.add_subcommand("minimize", "Minimizes a function of two variables with the methods of the simulation");
  command->footer(R"(
Examples:
  aspic minimize rosenbrock
  aspic minimize quadratic --method gradient_descent,newton --max-iterations 1000 --plot zigzag.svg
  aspic minimize rosenbrock --test none                 Newton's method overshoots
  aspic minimize rosenbrock --plot-model model.png --iteration 1
  aspic minimize --expression "cosh(x) + (y - x)^2" --start 2,-1
  aspic minimize --list

Exit codes: 0 done, 2 bad input, 3 not converged, 130 interrupted by Ctrl-C, 143 by kill.)");
  command->add_option("FUNCTION", arguments->function, "Function from --list");
  command->add_option("--expression", arguments->expression, "Formula of x and y, instead of a function");
  command->add_option("--start", arguments->start, "Initial guess x,y");
  add_solver_options(command, *arguments);
  command->add_option("--trace", arguments->trace, "Directory for a trace of every trial of every iteration");
  command->add_option("--plot", arguments->plot, "Draw a contour map with paths and rejected trials (.svg or .png)");
  command->add_option("--plot-model", arguments->model, "Draw surface and quadratic model of --iteration (.png)");
  command->add_option("--iteration", arguments->iteration, "Iteration of the model to draw, 0 by default")
      ->check(CLI::NonNegativeNumber);
  command->add_flag("--list", arguments->list, "List functions and methods");
  command->add_flag("--json", arguments->json, "Print a line of JSON per iteration, and one at the end of a method");
  command->callback([arguments, &action] { action = [arguments] { return run(*arguments); }; });
}

}  // namespace aspic::cli
