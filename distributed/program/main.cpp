// The program `aspic-mpi`: parses the command line and runs the command on all ranks.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "base/parallel.h"
#include "program/run.h"
#include "ranks/guarded.h"
#include "ranks/mpi_ranks.h"
#include "scene/overrides.h"

namespace {

int run_command(int argc, char** argv) {
  CLI::App app("Simulates scenes on several MPI ranks: mpirun -n 4 aspic-mpi run SCENE");
  app.set_version_flag("--version", "aspic-mpi " ASPIC_VERSION);
  app.require_subcommand(1);
  aspic::mpi::RunArguments arguments;
  int threads = 1;
  CLI::App* command = app.add_subcommand("run", "Simulates a scene, or a mesh with defaults");
  command->footer(R"(
Exit codes: 0 done, 1 internal error, 2 bad input, 3 some step did not converge (unless --allow-unconverged),
4 stopped by SIGUSR1: all complete steps are written and --resume continues.)");
  command->add_option("INPUT", arguments.input, "Scene (.toml), mesh, or with --resume a run directory")->required();
  command->add_option("--set", arguments.overrides, "Override values: material.young=2e5; several may follow")
      ->allow_extra_args(false);
  command->add_option("--steps", arguments.steps, "Stop after this many steps of the run")
      ->check(CLI::Range(1, 1000000000));
  command->add_option("--out", arguments.out, "Directory for the results; out/NAME by default");
  command->add_option("--threads", threads, "Threads per rank; 1 by default")->check(CLI::Range(1, 1024));
  command->add_flag("--force", arguments.force, "Overwrite the results of an earlier run");
  command->add_flag("--resume", arguments.resume, "Continue a run, on any number of ranks");
  command->add_flag("--allow-unconverged", arguments.allow_unconverged, "Exit with 0 even if a step did not converge");
  command->add_flag("-q,--quiet", arguments.quiet, "Print only warnings and errors");
  try {
    std::vector<std::string> spread = aspic::spread_assignments({argv + 1, argv + argc});
    std::reverse(spread.begin(), spread.end());  // the order that CLI11 expects
    app.parse(std::move(spread));
  } catch (const CLI::ParseError& e) {
    const bool prints = aspic::distributed::rank_of_this_process() == 0;
    const int code = prints ? app.exit(e) : e.get_exit_code();
    return code == 0 ? 0 : 2;
  }
  aspic::set_thread_count(threads);
  return aspic::mpi::run(arguments);
}

}  // namespace

int main(int argc, char** argv) {
  return aspic::distributed::guarded([&] { return run_command(argc, argv); });
}
