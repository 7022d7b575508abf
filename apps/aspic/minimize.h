// What `aspic minimize` found out, for its table and its pictures.
#pragma once
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "optimize/minimize.h"
#include "optimize/planar_function.h"

namespace aspic::cli {

// The function that is minimised and what is known of it.
struct Problem {
  std::string name, formula;
  std::unique_ptr<PlanarFunction> function;
  Planar start{};
  std::optional<Planar> minimizer = {};
  std::optional<double> minimum = {};
  std::optional<std::pair<Planar, Planar>> region = {};  // worth looking at
};

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

// A contour map with the path and the rejected trials. Throws InvalidInput.
void draw_path(const std::filesystem::path& path, const Problem& problem, const Minimization& done);
// The surface, and over it the quadratic model that an iteration minimised. Throws InvalidInput.
void draw_model(const std::filesystem::path& path, const Problem& problem, const Minimization& done, int iteration);

}  // namespace aspic::cli
