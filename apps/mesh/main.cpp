// aspic-mesh: fills a closed surface, an implicit shape or a labeled image with tetrahedra.
#include <sys/resource.h>
#include <sys/time.h>
#include <unistd.h>
#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <map>
#include <new>
#include <string>

#include "base/error.h"
#include "base/formatted.h"
#include "base/free_memory.h"
#include "base/number_chars.h"
#include "base/printable.h"
#include "input.h"
#include "io/mesh_file.h"
#include "mesh/doctor.h"
#include "mesh/tet_mesh.h"
#include "mesh/tet_shape.h"
#include "mesher.h"

namespace aspic {
namespace {

constexpr int kOutOfTime = 4;  // exit code

struct Farewell {
  std::string message;
  int exit_code = 0;

  [[noreturn]] void print() const {
    [[maybe_unused]] const ssize_t written = ::write(STDERR_FILENO, message.data(), message.size());
    ::_exit(exit_code);
  }
};

Farewell out_of_time, fault;  // set before the signals can arrive

// After this many seconds of wall time the process prints `message` to stderr and exits with kOutOfTime. A second call
// replaces the first.
void limit_time(double seconds, const std::string& message) {
  out_of_time = {message, kOutOfTime};
  std::signal(SIGALRM, [](int) { out_of_time.print(); });
  constexpr double kLongest = 1e9;  // [s]
  const double bounded = std::clamp(seconds, 1e-3, kLongest);
  itimerval timer{};
  timer.it_value.tv_sec = static_cast<time_t>(bounded);
  timer.it_value.tv_usec = static_cast<suseconds_t>(1e6 * (bounded - std::floor(bounded)));
  ::setitimer(ITIMER_REAL, &timer, nullptr);
}

// If a fault signal such as SIGSEGV occurs, the process prints `message` to stderr and exits with this code.
// The handler has its own stack, because a fault may be the overflow of the other one.
void end_faults(int exit_code, const std::string& message) {
  static std::array<char, 1 << 16> handler_stack;
  fault = {message, exit_code};
  stack_t stack{};
  stack.ss_sp = handler_stack.data();
  stack.ss_size = handler_stack.size();
  ::sigaltstack(&stack, nullptr);
  struct sigaction action {};
  action.sa_handler = [](int) { fault.print(); };
  action.sa_flags = SA_ONSTACK;
  for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT}) ::sigaction(signal, &action, nullptr);
}

// Allocations beyond this many bytes throw std::bad_alloc.
void limit_memory(std::int64_t bytes) {
  rlimit limit{};
  if (::getrlimit(RLIMIT_DATA, &limit) != 0) return;
  const auto wanted = static_cast<rlim_t>(std::max<std::int64_t>(bytes, 0));
  limit.rlim_cur = limit.rlim_max == RLIM_INFINITY ? wanted : std::min(wanted, limit.rlim_max);
  ::setrlimit(RLIMIT_DATA, &limit);
}

template <class... Values>
std::string line(const char* format, Values... values) {
  return formatted(format, values...) + '\n';
}

// Mean over the tets of their smallest dihedral angle [degrees].
double average_smallest_dihedral(const TetMesh& mesh) {
  double sum = 0;
  for (int t = 0; t < mesh.tet_count(); ++t) sum += dihedral_range(corners(mesh, t))[0];
  return sum / mesh.tet_count();
}

double average_edge(const TetMesh& mesh) {
  double sum = 0;
  for (int t = 0; t < mesh.tet_count(); ++t) {
    const TetCorners X = corners(mesh, t);
    for (int a = 0; a < 4; ++a)
      for (int b = 0; b < a; ++b) sum += norm(X[a] - X[b]) / 6;
  }
  return sum / mesh.tet_count();
}

// Tets that are almost flat, which the optimizer could not remove; empty: there are none.
std::string slivers_of(const TetMesh& mesh) {
  constexpr double kSliver = 1;  // [degrees]
  int count = 0, worst = 0;
  double smallest = 180;
  for (int t = 0; t < mesh.tet_count(); ++t) {
    const auto [least, most] = dihedral_range(corners(mesh, t));
    const double angle = std::min(least, 180 - most);
    if (angle >= kSliver) continue;
    ++count;
    if (angle < smallest) smallest = angle, worst = t;
  }
  if (count == 0) return "";
  return line(
      "slivers         %d of %d tets have a dihedral angle within 1 degree of 0 or 180, the worst is tet %d with "
      "%.2g; try another --size",
      count, mesh.tet_count(), worst, smallest);
}

std::string quality_report(const TetMesh& mesh, double seconds) {
  const MeshQuality q = quality(mesh);
  std::string text = line("vertices        %d", mesh.vertex_count()) + line("tets            %d", mesh.tet_count());
  std::map<int, int> regions;
  for (int label : mesh.region) ++regions[label];
  for (const auto& [label, count] : regions) text += line("  region %-6d %d tets", label, count);
  text += line("volume          %.6g in %d component%s", q.total_volume, q.components, q.components == 1 ? "" : "s");
  text += line("edge length     %.4g on average", average_edge(mesh));
  text += line("dihedral angle  smallest %.1f, largest %.1f, average of the smallest per tet %.1f degrees",
               q.min_dihedral, q.max_dihedral, average_smallest_dihedral(mesh));
  text += line("mean ratio      smallest %.3f, average %.3f (1: regular tet)", q.min_mean_ratio, q.average_mean_ratio);
  return text + slivers_of(mesh) + line("time            %.2f s", seconds);
}

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
  limit_time(arguments.time_limit, "error: " + printable(subject) + ": meshing did not end within " +
                                       formatted("%g", arguments.time_limit) +
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
    std::vector<std::string> words;
    for (int i = argc - 1; i > 0; --i)  // the order that CLI11 expects
      words.push_back(argv[i][0] == '-' && argv[i][1] == '.' ? aspic::with_zeros_beside_points(argv[i]) : argv[i]);
    app.parse(std::move(words));
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
