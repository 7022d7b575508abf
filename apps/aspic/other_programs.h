// Commands that are programs of their own beside `aspic`: aspic-mesh, which is not linked because of CGAL's GPL, and
// aspic-fit, the package of inverse problems.
#pragma once
#include <string>
#include <vector>

namespace aspic::cli {

// Replaces this process by a program beside it or on the PATH. Throws InvalidInput with the remedy if that is
// impossible.
[[noreturn]] void become(const std::string& program, std::vector<std::string> arguments);

// Path of the program that has these commands of `aspic`; empty: it is not beside this one.
std::string program_with(const std::string& command);

}  // namespace aspic::cli
