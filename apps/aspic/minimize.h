// A minimization of a function of two variables, step by step: for the table and pictures of `aspic minimize`, and for
// comparisons of methods.
#pragma once
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "optimize/planar_function.h"
#include "optimize/solver.h"

namespace aspic::cli {

// The function that is minimized and what is known of it.
struct Problem {
  std::string name, formula;
  std::unique_ptr<PlanarFunction> function;
  Planar start{};
  std::optional<Planar> minimizer = {};
  std::optional<double> minimum = {};
  std::optional<std::pair<Planar, Planar>> region = {};  // worth looking at: lower and upper corner
};
Problem known_problem(const std::string& name);  // one of test_functions(). Throws InvalidInput.

struct IterationRecord {
  Iteration iteration;
  Planar x{}, direction{}, next{};
  std::vector<Trial> tried;
};

struct Minimization {
  std::string method;        // in words
  std::string definiteness;  // as it was asked for
  std::vector<IterationRecord> iterations;
  MinimizeReport report;
  Planar end{};
};

// From problem.start. Each iteration is shown as it is recorded. Throws InvalidInput for options that make no sense.
using ShowIteration = std::function<void(const IterationRecord&, const LiveIteration&)>;
Minimization minimize(const Problem& problem, const SolverOptions& options, const ShowIteration& show = {});

// A contour map with the paths and the rejected trials of several methods. Throws InvalidInput.
void draw_paths(const std::filesystem::path& path, const std::string& title, const Problem& problem,
                const std::vector<Minimization>& methods);
// The surface, and over it the quadratic model that an iteration minimized. Throws InvalidInput.
void draw_model(const std::filesystem::path& path, const Problem& problem, const Minimization& done, int iteration);

}  // namespace aspic::cli
