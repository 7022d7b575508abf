// `aspic check`: examines a mesh, every mesh of a scene, or a data set.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <variant>

#include "aspic/commands.h"
#include "aspic/other_programs.h"
#include "aspic/plot.h"
#include "base/error.h"
#include "base/printable.h"
#include "dynamics/mesh_error_text.h"
#include "dynamics/step_derivatives.h"
#include "io/mesh_file.h"
#include "mesh/box.h"
#include "mesh/doctor.h"
#include "mesh/elements.h"
#include "mesh/surface_orientation.h"
#include "mesh/tet_nodes.h"
#include "scene/scene.h"

namespace aspic::cli {
namespace {

namespace fs = std::filesystem;

struct CheckDerivativesOptions {
  std::filesystem::path plot;  // empty: no plot
  double tolerance = 1e-6;
  bool json = false;
};

std::string order_text(const DerivativeCheck& check) {
  return std::isfinite(check.order) ? fmt::format("{:.2f}", check.order) : "-";
}

// "vertex 12, y", or for a Hessian "vertex 12, y; vertex 3, x (tet 57)", in the user's numbering.
std::string place(const DerivativeCheck& check, const Model& model) {
  if (check.row < 0) return "";
  const Renumbering &vertex = model.numbering.vertex, &tet = model.numbering.tet;
  const auto name = [&](int entry) { return entry_name(3 * vertex.to_user(entry / 3) + entry % 3); };
  std::string text = name(check.row);
  if (check.column >= 0 && check.column != check.row) text += "; " + name(check.column);
  const int with = tet_with(model.mesh, check.row / 3, (check.column >= 0 ? check.column : check.row) / 3);
  return with >= 0 ? fmt::format("{} (tet {})", text, tet.to_user(with)) : text;
}

void print_failure(const char* what, const DerivativeCheck& check, const TermDerivatives& of, const Model& model) {
  if (check.passed) return;
  if (check.row < 0)
    fmt::print("{} of {} ({}): not finite at any step\n", what, of.term, of.state);
  else
    fmt::print("{} of {} ({}) differs most at {}: formula {:.12g}, differences {:.12g}\n", what, of.term, of.state,
               place(check, model), check.found, check.expected);
}

nlohmann::ordered_json to_json(const DerivativeCheck& check, const Model& model) {
  return {{"passed", check.passed},
          {"smallest_error", check.smallest_error},
          {"order", check.order},  // null: only round-off error
          {"step", check.step},
          {"error", check.error},
          {"worst", {{"place", place(check, model)}, {"found", check.found}, {"expected", check.expected}}}};
}

void print_json(const std::vector<TermDerivatives>& results, const Model& model) {
  for (const TermDerivatives& of : results) {
    if (!of.unchecked.empty()) {
      fmt::print("{}\n",
                 nlohmann::ordered_json{
                     {"term", of.term}, {"state", of.state}, {"passed", nullptr}, {"unchecked", of.unchecked}}
                     .dump());
      continue;
    }
    const nlohmann::ordered_json line = {{"term", of.term},
                                         {"state", of.state},
                                         {"passed", of.report.passed()},
                                         {"gradient", to_json(of.report.gradient, model)},
                                         {"hessian", to_json(of.report.hessian, model)}};
    fmt::print("{}\n", line.dump());
  }
}

void print_table(const std::vector<TermDerivatives>& results, const Model& model, double tolerance) {
  size_t width = 4;
  for (const TermDerivatives& of : results) width = std::max(width, of.term.size());
  fmt::print("{:<{}}  {:<8}  {:^18}  {:^18}\n", "", width, "", "gradient", "Hessian");
  fmt::print("{:<{}}  {:<8}  {:>6} {:>11}  {:>6} {:>11}\n", "term", width, "state", "order", "error", "order", "error");
  for (const TermDerivatives& of : results) {
    if (!of.unchecked.empty()) {
      fmt::print("{:<{}}  {:<8}  not checked: outside of the domain: {}\n", of.term, width, of.state, of.unchecked);
      continue;
    }
    const DerivativeCheck &g = of.report.gradient, &H = of.report.hessian;
    fmt::print("{:<{}}  {:<8}  {:>6} {:>11.2e}  {:>6} {:>11.2e}  {}\n", of.term, width, of.state, order_text(g),
               g.smallest_error, order_text(H), H.smallest_error, of.report.passed() ? "passed" : "WRONG");
  }
  fmt::print(
      "\norder: convergence order of central differences; 2 is correct, - means only round-off\n"
      "error: smallest error for steps of 1e-1 to 1e-9 edges, relative to the derivative; tolerance {:g}\n",
      tolerance);
  for (const TermDerivatives& of : results) {
    if (!of.is_wrong()) continue;
    print_failure("the gradient", of.report.gradient, of, model);
    print_failure("the Hessian", of.report.hessian, of, model);
  }
}

// Largest error over the states for each term and derivative.
Chart chart_of(const std::vector<TermDerivatives>& results, const std::string& scene) {
  Chart chart{.title = fmt::format("Derivatives of {}: differences and formulas", scene),
              .x = {"step / mean edge length", AxisScale::logarithmic},
              .y = {"relative error", AxisScale::logarithmic},
              .size = {780, 520}};
  std::map<std::string, size_t> known;
  int color = 0;
  const auto add = [&](const std::string& label, const DerivativeCheck& check, SeriesStyle style, int of_term) {
    if (std::all_of(check.error.begin(), check.error.end(), [](double e) { return e == 0; })) return;
    const auto [at, is_new] = known.emplace(label, chart.series.size());
    if (is_new) {
      chart.series.push_back({label, check.step, check.error, style, of_term});
      return;
    }
    std::vector<double>& error = chart.series[at->second].y;
    for (size_t i = 0; i < error.size(); ++i) error[i] = std::fmax(error[i], check.error[i]);
  };
  std::map<std::string, int> colors;
  for (const TermDerivatives& of : results) {
    const int of_term = colors.emplace(of.term, color).second ? color++ : colors[of.term];
    add(of.term + ": gradient", of.report.gradient, SeriesStyle::line_and_points, of_term);
    add(of.term + ": Hessian", of.report.hessian, SeriesStyle::dashed, of_term);
  }
  chart.series.push_back({"slope 2", {1e-1, 1e-5}, {1e-2, 1e-10}, SeriesStyle::line, 6});
  return chart;
}

// Compares derivatives of every term of the scene's next step with differences. Prints, and returns the exit code.
int check_derivatives(const Scene& scene, const CheckDerivativesOptions& options) {
  if (!options.plot.empty()) require_drawable(options.plot);
  const std::vector<TermDerivatives> results = check_step_derivatives(scene.simulation, options.tolerance);
  const Model& model = scene.simulation.model();
  if (options.json) {
    print_json(results, model);
  } else {
    fmt::print("{}: {}\n\n", scene.name, size_text(model.mesh));
    print_table(results, model, options.tolerance);
  }
  if (!options.plot.empty()) draw(options.plot, chart_of(results, scene.name));
  const bool passed = std::none_of(results.begin(), results.end(), [](const auto& of) { return of.is_wrong(); });
  return passed ? exit_done : exit_unconverged;
}

struct CheckArguments {
  fs::path input, output, plot;
  std::vector<std::string> overrides;
  std::string registers;    // registration of a data set; empty: none
  double tolerance = 1e-6;  // tolerance of derivatives
  bool repair = false, derivatives = false, json = false, mesh_error = false;
};

constexpr size_t kIndicesShown = 8;

const char* to_string(Severity severity) {
  constexpr const char* kNames[] = {"error", "warning", "note"};
  return kNames[static_cast<size_t>(severity)];
}

void print(const Finding& finding) {
  fmt::print("{}: {}: {}\n", to_string(finding.severity), finding.name, finding.message);
  if (!finding.indices.empty()) {
    const size_t shown = std::min(finding.indices.size(), kIndicesShown);
    const auto end = finding.indices.begin() + static_cast<std::ptrdiff_t>(shown);
    fmt::print("  indices: {}{}\n", fmt::join(finding.indices.begin(), end, ", "),
               shown < finding.indices.size() ? fmt::format(", and {} more", finding.indices.size() - shown) : "");
  }
  if (!finding.remedy.empty()) fmt::print("  remedy: {}\n", finding.remedy);
}

void print_quality(const TetMesh& mesh) {
  const MeshQuality q = quality(mesh);
  fmt::print("box: [{:g}, {:g}] x [{:g}, {:g}] x [{:g}, {:g}] m\n", q.lower[0], q.upper[0], q.lower[1], q.upper[1],
             q.lower[2], q.upper[2]);
  fmt::print("volume: {:.6g} m^3, of a tet {:.3g} to {:.3g}; {} component{}\n", q.total_volume, q.min_volume,
             q.max_volume, q.components, q.components == 1 ? "" : "s");
  fmt::print("dihedral angles: {:.1f} to {:.1f} degrees; mean ratio: smallest {:.3f}, average {:.3f}\n", q.min_dihedral,
             q.max_dihedral, q.min_mean_ratio, q.average_mean_ratio);
  const auto& bins = q.mean_ratio_histogram;
  const int most = bins.empty() ? 0 : *std::max_element(bins.begin(), bins.end());
  fmt::print("mean ratio (1: regular, 0: flat)\n");
  for (size_t i = 0; i < bins.size(); ++i) {
    const auto width = most > 0 ? static_cast<size_t>(std::lround(40.0 * bins[i] / most)) : 0;
    fmt::print("  {:.1f} to {:.1f} {:>9}  {}\n", 0.1 * static_cast<double>(i), 0.1 * static_cast<double>(i + 1),
               bins[i], std::string(width, '#'));
  }
}
void print_quality(const TriMesh& mesh) {
  Box box;
  double area = 0;
  for (const Vec3d& x : mesh.vertices) box.add(x);
  for (const auto& [a, b, c] : mesh.triangles)
    area += norm(cross(mesh.vertices[b] - mesh.vertices[a], mesh.vertices[c] - mesh.vertices[a])) / 2;
  fmt::print("box: [{:g}, {:g}] x [{:g}, {:g}] x [{:g}, {:g}] m\n", box.lower[0], box.upper[0], box.lower[1],
             box.upper[1], box.lower[2], box.upper[2]);
  fmt::print("area: {:.6g} m^2", area);
  if (!is_sheet(mesh)) fmt::print("; volume: {:.6g} m^3", enclosed_volume(mesh));
  fmt::print("\n");
}

std::vector<Finding> findings_of(const TetMesh& mesh) { return diagnose(mesh); }
// What is an error of the surface of a solid may be none of a sheet.
std::vector<Finding> findings_of(const TriMesh& mesh) {
  std::vector<Finding> findings = diagnose(mesh);
  if (!is_sheet(mesh)) return findings;
  for (Finding& f : findings)
    for (const char* name : {"planar_mesh", "sheet", "non_manifold_edges", "inconsistent_orientation"})
      if (f.name == name) f.severity = Severity::note;
  return findings;
}

template <class Mesh>
std::vector<Finding> examine(const Mesh& mesh) {
  print_quality(mesh);
  std::vector<Finding> findings = findings_of(mesh);
  for (const Finding& finding : findings) print(finding);
  if (findings.empty()) fmt::print("no errors found\n");
  return findings;
}

std::string counts(const TetMesh& mesh) { return size_text(mesh); }
std::string counts(const TriMesh& mesh) {
  return fmt::format("{} vertices, {} triangles", mesh.vertex_count(), mesh.triangle_count());
}

// Names that scenes can use: surface = "outlet", regions = { inside = 1e5 }.
void print_groups(const TetMesh& mesh, const MeshGroups& groups) {
  std::map<int, int> tets;
  for (const int label : mesh.region) ++tets[label];
  const auto print = [](const char* kind, int label, const std::string& name, const std::string& count) {
    fmt::print("{} {}{}: {}\n", kind, label, name.empty() ? "" : fmt::format(" \"{}\"", name), count);
  };
  for (const auto& [label, count] : tets) {
    const auto name = groups.region_names.find(label);
    print("region", label, name == groups.region_names.end() ? "" : name->second, fmt::format("{} tets", count));
  }
  for (const SurfaceGroup& group : groups.surfaces)
    print("surface", group.label, group.name, fmt::format("{} triangles", group.triangles.size()));
}
void print_groups(const TriMesh&, const MeshGroups&) {}

template <class Mesh>
int check_mesh(const CheckArguments& arguments, Mesh mesh, const MeshGroups& groups) {
  fmt::print("{}: {}\n", printable(arguments.input.string()), counts(mesh));
  print_groups(mesh, groups);
  std::vector<Finding> findings = examine(mesh);
  if (arguments.repair) {
    const std::vector<std::string> actions = repair(mesh);
    fmt::print("\nrepair: {}\n",
               actions.empty() ? "no repair was possible" : fmt::format("{}", fmt::join(actions, "\n  ")));
    write_mesh(arguments.output, mesh);
    fmt::print("{}: {}\n", printable(arguments.output.string()), counts(mesh));
    findings = examine(mesh);
  }
  return has_errors(findings) ? exit_bad_input : exit_done;
}

// Returns one body as a separate mesh of linear tets. `all` is the whole mesh in the user's numbering.
TetMesh body_mesh(const TetMesh& all, const BodyRange& body) {
  const auto in_body = [&](auto& nodes) {
    for (int& v : nodes) v = v < 0 ? v : v - body.first_vertex;
  };
  TetMesh mesh;
  mesh.rest.assign(all.rest.begin() + body.first_vertex, all.rest.begin() + body.first_vertex + body.vertex_count);
  mesh.tets.assign(all.tets.begin() + body.first_tet, all.tets.begin() + body.first_tet + body.tet_count);
  std::for_each(mesh.tets.begin(), mesh.tets.end(), in_body);
  if (all.mids.empty()) return mesh;
  mesh.mids.assign(all.mids.begin() + body.first_tet, all.mids.begin() + body.first_tet + body.tet_count);
  std::for_each(mesh.mids.begin(), mesh.mids.end(), in_body);
  return lower_order(std::move(mesh));
}

int check_scene(const CheckArguments& arguments) {
  if (arguments.repair) {
    throw InvalidInput(
        fmt::format("{}: --repair needs a mesh file; give the mesh of the scene", arguments.input.string()));
  }
  const Scene scene = load_scene(arguments.input, {.overrides = arguments.overrides, .mesher = {}});
  const Model& model = scene.simulation.model();
  fmt::print("{}: {} steps, {} bodies, {}\n", printable(arguments.input.string()), scene.steps, model.bodies.size(),
             counts(model.mesh));
  for (const std::string& note : scene.notes) fmt::print("note: {}\n", note);
  bool wrong = false;
  const TetMesh all = to_user(model.numbering, model.mesh);
  for (const BodyRange& body : model.bodies) {
    if (body.is_rod()) {
      fmt::print("\n{}: {} vertices, {} segments\n", body.name, body.vertex_count, body.segment_count);
      continue;
    }
    if (body.is_sheet()) {
      fmt::print("\n{}: {} vertices, {} triangles\n", body.name, body.vertex_count, body.triangle_count);
      continue;
    }
    const TetMesh mesh = body_mesh(all, body);
    fmt::print("\n{}: {}\n", body.name, counts(mesh));
    wrong = has_errors(examine(mesh)) || wrong;
  }
  return wrong ? exit_bad_input : exit_done;
}

// Estimates the error of the mesh in static equilibrium under the loads and pins at the end of the scene, which the
// steps approach. Prints, and returns the exit code.
int check_mesh_error(const CheckArguments& arguments) {
  constexpr int kSteps = 10;
  std::vector<std::string> overrides = arguments.overrides;
  overrides.emplace_back("time.integrator=quasi_static");
  Scene scene = load_scene(arguments.input, {.overrides = overrides, .mesher = {}});
  if (!scene.simulation.model().mesh.sheet.empty())
    throw InvalidInput(
        fmt::format("{}: there is no estimate for sheets; compare two meshes", arguments.input.string()));
  const double step = scene.simulation.options().h * std::max(1, scene.steps) / kSteps;
  overrides.push_back(fmt::format("time.step={}", step));
  scene = load_scene(arguments.input, {.overrides = overrides, .mesher = {}});
  StepReport report;
  for (int i = 0; i < kSteps; ++i) report = scene.simulation.step();
  if (!is_success(report.status))
    throw InvalidInput(
        fmt::format("{}: no static equilibrium was found ({}); pin the body, or estimate in motion: "
                    "aspic run SCENE",
                    printable(arguments.input.string()), to_string(report.status)));
  add_mesh_error(scene.simulation, {}, report);
  const bool has_estimate = report.mesh_stiffness > 0;
  fmt::print("{}: {}{}\n", scene.name, has_estimate ? "in static equilibrium, the mesh " : "",
             printable(report.mesh_error));
  return exit_done;
}

bool is_data_set(const fs::path& input) {
  std::error_code error;
  return fs::is_directory(input, error) || input.filename() == "capture.toml";
}

[[noreturn]] void check_measurements(const CheckArguments& arguments) {
  if (arguments.repair || arguments.derivatives || !arguments.overrides.empty())
    throw InvalidInput(arguments.input.string() + ": --repair, --derivatives and --set do not apply to a data set");
  std::vector<std::string> passed = {"check", arguments.input.string()};
  if (!arguments.registers.empty()) passed.insert(passed.end(), {"--register", arguments.registers});
  if (arguments.json) passed.emplace_back("--json");
  become("aspic-fit", passed);
}

int check(const CheckArguments& arguments) {
  if (is_data_set(arguments.input)) check_measurements(arguments);
  if (!arguments.registers.empty())
    throw InvalidInput("--register needs a data set; give the folder that contains capture.toml");
  if (arguments.mesh_error && (arguments.derivatives || arguments.json))
    throw InvalidInput("--mesh-error cannot be combined with --derivatives or --json");
  if (arguments.derivatives) {
    if (arguments.repair) throw InvalidInput("--repair and --derivatives cannot be combined");
    const Scene scene = load_scene(arguments.input, {.overrides = arguments.overrides, .mesher = {}});
    return check_derivatives(scene, {.plot = arguments.plot, .tolerance = arguments.tolerance, .json = arguments.json});
  }
  if (!arguments.plot.empty() || arguments.json) throw InvalidInput("--plot and --json require --derivatives");
  if (arguments.mesh_error) {
    if (arguments.repair) throw InvalidInput("--repair and --mesh-error cannot be combined");
    return check_mesh_error(arguments);
  }
  if (arguments.input.extension() == ".toml") return check_scene(arguments);
  if (!arguments.overrides.empty()) throw InvalidInput("--set needs a scene; a mesh has no values to override");
  std::vector<std::string> notes;
  MeshGroups groups;
  auto mesh = read_mesh(arguments.input, &notes, &groups);
  for (const std::string& note : notes) fmt::print("note: {}\n", printable(note));
  return std::visit([&](auto m) { return check_mesh(arguments, std::move(m), groups); }, std::move(mesh));
}

}  // namespace

void add_check(CLI::App& app, Action& action) {
  const auto arguments = std::make_shared<CheckArguments>();
  CLI::App* command =
      app.add_subcommand("check", "Reports errors and suspicious values of a scene, a mesh or a data set");
  command->footer(
      "\nExamples:\n  aspic check bunny.mesh\n  aspic check scenes/bunny.toml\n"
      "  aspic check pillow                           a data set of measurements\n"
      "  aspic check broken.mesh --repair -o mended.mesh\n"
      "  aspic check scenes/bunny.toml --derivatives --plot errors.svg\n"
      "  aspic check scenes/cantilever.toml --mesh-error\n"
      "Exit code 2 if there are errors (after a repair, if requested), 3 if a derivative is wrong.");
  command->add_option("INPUT", arguments->input, "Scene (.toml), mesh, or folder of a data set")->required();
  command
      ->add_option("--set", arguments->overrides,
                   "Override values of the scene: material.young=2e5; several may follow")
      ->allow_extra_args(false);
  CLI::Option* output = command->add_option("-o,--output", arguments->output, "Repaired mesh to write");
  CLI::Option* repair = command->add_flag("--repair", arguments->repair,
                                          "Flip inverted tets, remove zero-volume ones, merge duplicate vertices, "
                                          "remove unreferenced ones");
  repair->needs(output);
  output->needs(repair);
  command->add_flag("--derivatives", arguments->derivatives,
                    "Compare gradient and Hessian of every term of the next step with central differences");
  command->add_flag("--mesh-error", arguments->mesh_error,
                    "Estimate by how much the mesh is too stiff, in static equilibrium at the end of the scene");
  command->add_option("--tolerance", arguments->tolerance, "With --derivatives: relative tolerance; 1e-6 by default")
      ->check(CLI::PositiveNumber);
  command->add_option("--plot", arguments->plot, "With --derivatives: plot error over step (.svg or .png)");
  command->add_option("--register", arguments->registers, "Align markers or scan of a data set: rigid or similarity")
      ->check(CLI::IsMember({"rigid", "similarity"}));
  command->add_flag("--json", arguments->json,
                    "Print JSON: findings of a data set, or with --derivatives one line per term and state");
  command->callback([arguments, &action] { action = [arguments] { return check(*arguments); }; });
}

}  // namespace aspic::cli
