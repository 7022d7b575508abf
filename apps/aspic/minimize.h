// Minimizes a function of two variables and records the iterations, for tables and pictures of `aspic minimize` and for
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

// Function to minimize, and its known properties.
struct Problem {
  std::string name, formula;
  std::unique_ptr<PlanarFunction> function;
  Planar start{};
  std::optional<Planar> minimizer = {};
  std::optional<double> minimum = {};
  std::optional<std::pair<Planar, Planar>> region = {};  // region to draw: lower and upper corner
};
Problem known_problem(const std::string& name);  // a function of test_functions(); throws InvalidInput

struct IterationRecord {
  Iteration iteration;
  Planar x{}, direction{}, next{};
  std::vector<Trial> tried;
};

struct Minimization {
  std::string method;  // NAME[:OPTION...]
  NewtonDefiniteness definiteness = {};
  std::vector<IterationRecord> iterations;
  MinimizeReport report;
  Planar end{};
};

// Minimizes from problem.start and calls ShowIteration after each iteration. Throws InvalidInput for invalid options.
using ShowIteration = std::function<void(const IterationRecord&, const LiveIteration&)>;
Minimization minimize(const Problem& problem, const SolverOptions& options, const ShowIteration& show = {});

// Draws a contour map with the paths and rejected trials of several methods. Throws InvalidInput.
void draw_paths(const std::filesystem::path& path, const std::string& title, const Problem& problem,
                const std::vector<Minimization>& methods);
// Draws the surface with the quadratic model of an iteration. Throws InvalidInput.
void draw_model(const std::filesystem::path& path, const Problem& problem, const Minimization& done, int iteration);

}  // namespace aspic::cli
