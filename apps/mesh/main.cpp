// aspic-mesh: fills a closed surface, an implicit shape or a labeled image with tetrahedra.
#include <CLI/CLI.hpp>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <new>

#include "base/error.h"
#include "base/free_memory.h"
#include "base/printable.h"
#include "budget.h"
#include "input.h"
#include "io/mesh_file.h"
#include "mesher.h"
#include "report.h"

namespace aspic {
namespace {

enum ExitCode { kDone = 0, kFailed = 1, kBadInput = 2 };

constexpr const char* kLicense =
    "aspic-mesh links CGAL's packages under the GNU General Public License, version 3 or later; as a whole it is\n"
    "distributed under that license. It comes without any warranty. Meshes made with it are yours.";

constexpr const char* kExamples =
    "Examples:\n"
    "  aspic-mesh bunny.obj -o bunny.msh\n"
    "  aspic-mesh part.stl -o part.msh --size 2 --fill-holes\n"
    "  aspic-mesh --implicit \"(sqrt(x^2+y^2)-1)^2+z^2-0.16\" --bounds -2 -2 -1 2 2 1 -o torus.mesh\n"
    "  aspic-mesh liver.inr.gz -o liver.msh --size 8 --region-size 2=4\n"
    "  aspic-mesh scan.ply -o scan.msh --rebuild\n"
    "Exit codes: 0 done, 2 bad input, or a result that differs from the shape, 4 time limit, 1 internal error.\n\n";

struct Arguments {
  std::string input, output, expression;
  std::vector<double> bounds;
  double size = 0;
  std::vector<std::string> region_sizes;
  double most_tets = MesherOptions().most_tets, time_limit = 600;
  bool fill_holes = false, rebuild = false, quiet = false;
};

void declare(CLI::App& app, Arguments& arguments) {
  app.set_version_flag("--version",
                       std::string("aspic-mesh ") + ASPIC_VERSION + " (CGAL " + CGAL_VERSION_TEXT + ")\n" + kLicense);
  app.footer(std::string(kExamples) + kLicense);
  app.add_option("input", arguments.input, "Closed surface (.obj .stl .ply .off ...) or labeled image (.inr .inr.gz)");
  app.add_option("--implicit", arguments.expression, "Formula of x, y, z that is negative inside, instead of a file");
  app.add_option("--bounds", arguments.bounds, "x0 y0 z0 x1 y1 z1: bounding box of the implicit shape")->expected(6);
  app.add_option("-o,--output", arguments.output, "Output file; the extension selects the format")->required();
  app.add_option("--size", arguments.size,
                 "Target edge length in units of the input; 0: diagonal of the bounding box / 25");
  app.add_option("--region-size", arguments.region_sizes, "LABEL=SIZE: target edge length in this region of an image")
      ->allow_extra_args(false);
  app.add_flag("--fill-holes", arguments.fill_holes,
               "Close holes whose border is shorter than the diagonal of the surface");
  app.add_flag("--rebuild", arguments.rebuild,
               "Wrap a defective surface (holes, overlaps, inner walls) in a closed one and fill it");
  app.add_option("--max-tets", arguments.most_tets,
                 "Maximum tets with two across thin parts; beyond it one across, or an error")
      ->capture_default_str()
      ->check(CLI::Range(1e3, 1e8));
  app.add_option("--time-limit", arguments.time_limit, "Time limit of meshing in seconds of wall time (exit code 4)")
      ->capture_default_str()
      ->check(CLI::Range(1e-3, 1e9));
  app.add_flag("--quiet", arguments.quiet, "Print no report");
}

MesherOptions mesher_options(const Arguments& arguments) {
  if (!(arguments.size >= 0) || !std::isfinite(arguments.size))
    throw InvalidInput("--size " + std::to_string(arguments.size) + ": give a positive length, or 0 for the default");
  MesherOptions options{.size = arguments.size,
                        .region_size = {},
                        .most_tets = arguments.most_tets,
                        .has_sharp_edges = !arguments.rebuild};
  for (const std::string& text : arguments.region_sizes) options.region_size.insert(parsed_region_size(text));
  return options;
}

void check_combination(const Arguments& arguments) {
  if (arguments.input.empty() == arguments.expression.empty())
    throw InvalidInput("give either an input file or --implicit; see aspic-mesh --help");
  if (!arguments.expression.empty() && arguments.bounds.empty())
    throw InvalidInput("--implicit needs --bounds x0 y0 z0 x1 y1 z1, its bounding box");
  if (arguments.expression.empty() && !arguments.bounds.empty())
    throw InvalidInput("--bounds requires --implicit; omit it for a file");
  if (!arguments.region_sizes.empty() && !is_image(arguments.input))
    throw InvalidInput("--region-size needs a labeled image (.inr, .inr.gz); use --size");
  if (arguments.fill_holes && (arguments.input.empty() || is_image(arguments.input)))
    throw InvalidInput("--fill-holes needs a surface");
  if (arguments.rebuild && (arguments.input.empty() || is_image(arguments.input)))
    throw InvalidInput("--rebuild needs a surface");
  if (arguments.rebuild && arguments.fill_holes) throw InvalidInput("--rebuild also closes holes; omit --fill-holes");
}

Defects defects(const Arguments& arguments) {
  if (arguments.rebuild) return Defects::rebuild;
  return arguments.fill_holes ? Defects::fill_small_holes : Defects::refuse;
}

void print(const Arguments& arguments, const std::vector<std::string>& lines) {
  if (arguments.quiet) return;
  for (const std::string& line : lines) std::printf("%s: %s\n", arguments.input.c_str(), line.c_str());
}

TetMesh mesh(const Arguments& arguments) {
  const MesherOptions options = mesher_options(arguments);
  if (!arguments.expression.empty()) {
    const auto& b = arguments.bounds;
    return mesh_implicit({arguments.expression, {{b[0], b[1], b[2]}}, {{b[3], b[4], b[5]}}}, options);
  }
  if (is_image(arguments.input)) return mesh_image(arguments.input, options);
  const CheckedSurface surface = checked_surface(arguments.input, defects(arguments));
  print(arguments, surface.actions);
  FilledSurface filled = mesh_surface(arguments.input, surface.mesh, options);
  print(arguments, filled.notes);
  return std::move(filled.tets);
}

void set_budget(const Arguments& arguments) {
  const std::string subject = arguments.input.empty() ? "--implicit" : arguments.input;
  char seconds[32];
  std::snprintf(seconds, sizeof seconds, "%g", arguments.time_limit);
  limit_time(arguments.time_limit, "error: " + printable(subject) + ": meshing did not end within " + seconds +
                                       " s; give a larger --size, or more with --time-limit\n");
  end_faults(kFailed, "error: " + printable(subject) +
                          ": meshing failed in CGAL; give another --size, or rebuild the surface with --rebuild\n");
  limit_memory(free_memory());
}

void run(const Arguments& arguments) {
  const auto start = std::chrono::steady_clock::now();
  check_combination(arguments);
  check_output(arguments.output);
  set_budget(arguments);
  const TetMesh tets = mesh(arguments);
  write_mesh(arguments.output, tets);
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  if (!arguments.quiet) std::fputs(quality_report(tets, seconds.count()).c_str(), stdout);
}

}  // namespace
}  // namespace aspic

int main(int argc, char** argv) {
  CLI::App app("Fills a closed surface, an implicit shape or a labeled image with tetrahedra.", "aspic-mesh");
  aspic::Arguments arguments;
  aspic::declare(app, arguments);
  try {
    app.parse(argc, argv);
    aspic::run(arguments);
    return aspic::kDone;
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? aspic::kDone : aspic::kBadInput;
  } catch (const aspic::InvalidInput& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return aspic::kBadInput;
  } catch (const std::bad_alloc&) {
    std::fputs("error: meshing needs more than the free memory; give a larger --size\n", stderr);
    return aspic::kFailed;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "error: meshing failed: %s\n", error.what());
    return aspic::kFailed;
  }
}
