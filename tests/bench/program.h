// Common main function of the benchmark programs: options, work, error messages.
#pragma once
#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>

namespace aspic::bench {

// Parses the command line and calls `run`. Exit code 2 for bad input, otherwise the result of `run`.
template <class Run>
int run_program(CLI::App& app, int argc, char** argv, const Run& run) {
  try {
    app.parse(argc, argv);
    return run();
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 2;
  }
}

}  // namespace aspic::bench
