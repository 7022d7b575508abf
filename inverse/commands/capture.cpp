// `aspic capture`: synthetic measurements of a body by simulation.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <filesystem>

#include "aspic/interrupt.h"
#include "base/error.h"
#include "base/parallel.h"
#include "commands/commands.h"
#include "data/synthesis.h"
#include "io/mesh_file.h"
#include "scene/scene.h"
#include "scene/toml_reader.h"

namespace aspic::cli {
namespace {

namespace fs = std::filesystem;

struct CaptureArguments {
  fs::path input, out, mesh;
  std::vector<std::string> overrides, gravity;
  std::string indenter = "sphere", contact = "bonded";
  SynthesisOptions bench;
  int threads = 0;
  bool force = false, no_force = false, quiet = false;
};

// Parses "sphere" or "disc:0.01".
void read_indenter(const std::string& text, SynthesisOptions& bench) {
  const size_t colon = text.find(':');
  const std::string shape = text.substr(0, colon);
  if (shape != "sphere" && shape != "disc")
    throw InvalidInput(fmt::format("--tip {}: the shape must be sphere or disc, such as sphere:0.01", text));
  bench.shape = shape == "disc" ? IndenterShape::disc : IndenterShape::sphere;
  if (colon == std::string::npos) return;
  const Value radius = read_toml_value(text.substr(colon + 1), "--tip " + text);
  if (!radius.is_number() || !(radius.number() > 0) || !std::isfinite(radius.number()))
    throw InvalidInput(fmt::format("--tip {}: the radius in meters must be > 0, such as sphere:0.01", text));
  bench.indenter_radius = radius.number();
}

// Parses "0,0,-1".
Vec3d direction(const std::string& text) {
  const Value list = read_toml_value("[" + text + "]", "--gravity " + text);
  if (list.array().size() != 3 ||
      !std::all_of(list.array().begin(), list.array().end(), [](const Value& v) { return v.is_number(); }))
    throw InvalidInput(fmt::format("--gravity {}: give three numbers separated by commas, such as 0,0,-1", text));
  return list.vector();
}

SynthesisOptions bench_options(const CaptureArguments& arguments) {
  SynthesisOptions bench = arguments.bench;
  read_indenter(arguments.indenter, bench);
  if (arguments.contact != "bonded" && arguments.contact != "sliding")
    throw InvalidInput(fmt::format("--contact {}: must be bonded or sliding", arguments.contact));
  bench.contact = arguments.contact == "sliding" ? IndenterContact::sliding : IndenterContact::bonded;
  for (const std::string& text : arguments.gravity) bench.gravity.push_back(direction(text));
  bench.forces = !arguments.no_force;
  bench.torques &= bench.forces;
  if (!arguments.mesh.empty()) bench.mesh = read_tet_mesh(arguments.mesh);
  return bench;
}

fs::path folder_of(const CaptureArguments& arguments, const std::string& name) {
  const fs::path folder = arguments.out.empty() ? fs::path("out") / (name + "_data") : arguments.out;
  std::error_code error;
  if (!arguments.force && fs::exists(folder / "capture.toml", error))
    throw InvalidInput(
        fmt::format("{}: already contains a data set; choose another folder, or give --force", folder.string()));
  return folder;
}

void show(const SynthesisStep& step) {
  const Vec3d& f = step.wrench.force;
  fmt::print("{:>4} of {}: {}: {}\n", step.done, step.of, step.name,
             step.failure.empty() ? fmt::format("{:.4g} N, {} iterations", norm(f), step.iterations) : step.failure);
  std::fflush(stdout);
}

int capture(const CaptureArguments& arguments) {
  if (arguments.threads > 0) set_thread_count(arguments.threads);
  SynthesisOptions bench = bench_options(arguments);
  const Scene scene = load_scene(arguments.input, {.overrides = arguments.overrides});
  const fs::path folder = folder_of(arguments, scene.name);
  catch_interrupts();  // from here on there are results to keep
  bench.stop = StopToken([] { return interrupt_signal() != 0; });
  const Synthesis made = synthesize(scene, bench, [&](const SynthesisStep& step) {
    if (!arguments.quiet) show(step);
  });
  for (const std::string& note : made.notes) fmt::print("note: {}\n", note);
  if (made.interrupted && made.data.experiment.cases.empty()) {
    fmt::print(stderr, "interrupted before the first case: nothing was written\n");
    return exit_signal + interrupt_signal();
  }
  if (made.data.experiment.cases.empty()) {
    fmt::print(stderr, "error: no case has an equilibrium; reduce --depth or use a larger --tip\n");
    return exit_unconverged;
  }
  write_data_set(folder, made.data, [&](const fs::path& place) { write_material(place / "truth.vtu", made.truth); });
  const Experiment& e = made.data.experiment;
  fmt::print("{}: {} cases, {} markers, mesh of {} tets (truth: {}); {} contains the truth\n", folder.string(),
             e.cases.size(), e.markers.size(), e.mesh.tet_count(), made.truth.mesh.tet_count(),
             (folder / "truth.vtu").string());
  if (made.interrupted) {
    fmt::print(stderr, "interrupted: the data set contains the finished cases; --force replaces it\n");
    return exit_signal + interrupt_signal();
  }
  return made.failed > 0 ? exit_unconverged : exit_done;
}

}  // namespace

void add_capture(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand("capture", "Makes synthetic measurements of a body, for fits with known truth");
  command->footer(R"(
Examples:
  aspic capture scenes/capture/pillow.toml                     into out/pillow_data
  aspic capture scenes/capture/pillow.toml -o pillow --pokes 12 --tip disc:0.01
  aspic capture scenes/capture/pillow.toml -o hung --pokes 0 --gravity 0,0,-1 --gravity 1,0,0
then: aspic check out/pillow_data, and aspic fit out/pillow_data

Exit codes: 0 done, 2 bad input, 3 some case has no equilibrium and was omitted, 130 interrupted by Ctrl-C,
143 by kill: finished cases are written.)");
  auto a = std::make_shared<CaptureArguments>();
  SynthesisOptions& b = a->bench;
  command->add_option("scene", a->input, "Scene or mesh to measure")->required();
  command->add_option("-o,--out", a->out, "Folder of the data set; default: out/NAME_data");
  command->add_option("--set", a->overrides, "KEY=VALUE: override a value of the scene")->allow_extra_args(false);
  command->add_option("--pokes", b.indentations, "Number of poke sites")->capture_default_str();
  command->add_option("--depths", b.depths, "Number of depths per site")->capture_default_str();
  command->add_option("--depth", b.deepest, "Largest depth, relative to the size of the body")->capture_default_str();
  command->add_option("--tip", a->indenter,
                      "Indenter: sphere[:RADIUS] or disc[:RADIUS] in m; default: 8 % of the body size");
  command
      ->add_option("--contact", a->contact,
                   "Contact: bonded, or sliding without friction (that of the scene is ignored)")
      ->capture_default_str();
  command->add_option("--markers", b.markers, "Number of markers on the surface")->capture_default_str();
  command->add_option("--noise", b.noise, "Noise of positions, relative to the largest motion")->capture_default_str();
  command->add_option("--force-noise", b.force_noise, "Relative noise of forces")->capture_default_str();
  command->add_flag("--no-force", a->no_force, "Omit forces");
  command->add_flag("--torque", b.torques, "Also measure torques");
  command->add_flag("--regions", b.regions,
                    "Label the tets by parts of constant stiffness, for --unknown young=regions");
  command->add_option("--gravity", a->gravity, "X,Y,Z: add a load case with gravity in this direction")
      ->allow_extra_args(false);
  command->add_option("--mesh", a->mesh, "Mesh of the data set; default: a coarser one of the same body");
  command->add_option("--seed", b.seed, "Seed of the noise and the markers")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command->add_option("--threads", a->threads, "Number of threads; default: all cores")->check(CLI::Range(1, 1024));
  command->add_flag("--force", a->force, "Replace an earlier data set");
  command->add_flag("-q,--quiet", a->quiet, "Print no progress");
  command->callback([a, &action] { action = [a] { return capture(*a); }; });
}

}  // namespace aspic::cli
