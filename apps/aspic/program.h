// A program of commands: parses the command line, runs one command, and converts errors to messages and exit codes.
#pragma once
#include <functional>

#include "aspic/commands.h"

namespace aspic::cli {

using CommandList = std::function<void(CLI::App& app, Action& action)>;  // adds commands

int main_program(int argc, char** argv, const CommandList& add_commands);  // returns the exit code

}  // namespace aspic::cli
