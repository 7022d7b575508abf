// `aspic closed-loop`: work of repeatedly stretching a cube along x, then y, and releasing it along x, then y. It is
// zero with an energy, and nonzero per loop with moduli that are interpolated in strain space.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cmath>

#include "aspic/plot.h"
#include "base/error.h"
#include "commands/commands.h"
#include "dynamics/model_builder.h"
#include "fit/incremental_elasticity.h"
#include "mesh/generators.h"

namespace aspic::cli {
namespace {

constexpr double kSide = 0.1;                              // edge length [m]
constexpr std::array<double, 3> kYoung = {1e5, 4e5, 2e5};  // moduli of the examples: along x, along y, both [Pa]
constexpr double kPoisson = 0.3;

struct Request {
  double stretch = 0.2;  // stretch of the cube
  int loops = 4, increments = 100;
  bool reversed = false;
  std::filesystem::path picture;
};

// Values along the loop.
struct Course {
  std::vector<double> loops, work;  // [1], [J]
  double after_first = 0;           // work of the first loop [J]
  double stress = 0;                // residual stress at rest after the last loop [Pa]
};

std::vector<double> stretched(const TetMesh& mesh, double x, double y) {
  std::vector<double> q;
  for (const Vec3d& X : mesh.rest) q.insert(q.end(), {(1 + x) * X[0], (1 + y) * X[1], X[2]});
  return q;
}

std::array<double, 2> corner(int k, const Request& request) {
  const int at = request.reversed ? (4 - k % 4) % 4 : k % 4;
  return {at == 1 || at == 2 ? request.stretch : 0.0, at == 2 || at == 3 ? request.stretch : 0.0};
}

// Calls go(x) in all increments of all loops.
template <class Go>
void walk(const TetMesh& mesh, const Request& request, const Go& go) {
  for (int side = 0; side < 4 * request.loops; ++side) {
    const auto from = corner(side, request), to = corner(side + 1, request);
    for (int k = 1; k <= request.increments; ++k) {
      const double s = static_cast<double>(k) / request.increments;
      go(stretched(mesh, (1 - s) * from[0] + s * to[0], (1 - s) * from[1] + s * to[1]), (side + s) / 4);
    }
  }
}

Course interpolated(const TetMesh& mesh, const Request& request) {
  const double a = request.stretch;
  const std::array<std::array<double, 2>, 3> shapes = {{{a, 0}, {0, a}, {a, a}}};
  std::vector<StrainExample> examples;
  for (size_t i = 0; i < shapes.size(); ++i)
    examples.push_back({fmt::format("example {}", i + 1), std::vector<double>(mesh.tets.size(), kYoung[i]),
                        std::vector<double>(mesh.tets.size(), kPoisson), stretched(mesh, shapes[i][0], shapes[i][1])});
  const StrainSpaceModuli moduli(mesh, examples);
  IncrementalElasticity body(mesh, moduli);
  Course course{.loops = {0}, .work = {0}};
  walk(mesh, request, [&](const std::vector<double>& x, double loops) {
    body.accept(x);
    course.loops.push_back(loops);
    course.work.push_back(body.work());
    if (std::abs(loops - 1) < 1e-9) course.after_first = body.work();
  });
  for (const double s : body.stress(0).a) course.stress = std::fmax(course.stress, std::abs(s));
  return course;
}

Course of_energy(const TetMesh& mesh, const Request& request) {
  const Model model =
      ModelBuilder(mesh).material("corotated", {.young = kYoung[2], .poisson = kPoisson}).density(1000).build();
  const TetElasticity& energy = *model.elasticity[0];
  std::vector<double> x = stretched(mesh, 0, 0), g(x.size()), next(x.size());
  energy.add_gradient(x, 1, g);
  Course course{.loops = {0}, .work = {0}};
  walk(mesh, request, [&](const std::vector<double>& to, double loops) {
    std::fill(next.begin(), next.end(), 0.0);
    energy.add_gradient(to, 1, next);
    double work = course.work.back();
    for (size_t i = 0; i < x.size(); ++i) work += 0.5 * (g[i] + next[i]) * (to[i] - x[i]);
    x = to;
    std::swap(g, next);
    course.loops.push_back(loops);
    course.work.push_back(work);
    if (std::abs(loops - 1) < 1e-9) course.after_first = work;
  });
  return course;
}

int run(const Request& request) {
  if (!(request.stretch > 0 && request.stretch <= 1))
    throw InvalidInput(fmt::format("--stretch {}: must lie between 0 and 1 (try 0.2)", request.stretch));
  if (!request.picture.empty()) require_drawable(request.picture);
  const TetMesh mesh = make_box({{0, 0, 0}}, {{kSide, kSide, kSide}}, {1, 1, 1});
  const Course bickel = interpolated(mesh, request), energy = of_energy(mesh, request);
  const auto peak = [](const Course& c) { return *std::max_element(c.work.begin(), c.work.end()); };
  fmt::print("A cube of {} m, {} loops of {} increments per side, stretched by {}:\n", kSide, request.loops,
             request.increments, request.stretch);
  fmt::print("  {:<34} {:>16} {:>16} {:>18} {:>16}\n", "", "first loop [J]", "all loops [J]", "maximum [J]",
             "stress left [Pa]");
  const auto row = [&](const char* what, const Course& c) {
    fmt::print("  {:<34} {:>16.5f} {:>16.5f} {:>18.5f} {:>16.4g}\n", what, c.after_first, c.work.back(), peak(c),
               c.stress);
  };
  row("moduli interpolated in strain space", bickel);
  row("an energy (corotated)", energy);
  if (request.picture.empty()) return exit_done;
  Chart chart{.title = "Work done on a cube in closed loops of strain",
              .x = {.label = "loops"},
              .y = {.label = "work [J]"},
              .series = {}};
  for (const auto& [label, course] :
       {std::pair{"moduli interpolated in strain space", &bickel}, {"an energy", &energy}}) {
    Series series{.label = label, .x = course->loops, .y = {}};
    for (const double w : course->work) series.y.push_back(w);
    chart.series.push_back(std::move(series));
  }
  draw(request.picture, chart);
  return exit_done;
}

}  // namespace

void add_closed_loop(CLI::App& app, Action& action) {
  const auto request = std::make_shared<Request>();
  CLI::App* command = app.add_subcommand(
      "closed-loop", "Computes the work of closed strain loops: zero with an energy, nonzero with interpolated moduli");
  command->footer("\nExamples:\n  aspic closed-loop\n  aspic closed-loop --increments 1000 --plot loops.svg");
  command->add_option("--stretch", request->stretch, "Stretch of the cube")->capture_default_str();
  command->add_option("--loops", request->loops, "Number of loops")->check(CLI::Range(1, 1000))->capture_default_str();
  command->add_option("--increments", request->increments, "Number of increments per side of the loop")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  command->add_flag("--reversed", request->reversed, "Reverse the direction of the loop");
  command->add_option("--plot", request->picture, "Plot the work over the loops: FILE.svg or FILE.png");
  command->callback([request, &action] { action = [request] { return run(*request); }; });
}

}  // namespace aspic::cli
