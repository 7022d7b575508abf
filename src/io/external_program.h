// Runs helper programs to completion without a shell and reports their errors.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "base/error.h"

namespace aspic {

// New temporary folder, removed with its contents at the end of its scope. Throws InvalidInput if it cannot be created.
class TemporaryFolder {
 public:
  TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  ~TemporaryFolder();
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

bool is_program(const std::filesystem::path& path);
std::filesystem::path program_folder();  // folder of the running program

// Returns the program of this name from one of `folders` or the PATH. Throws InvalidInput that ends with `remedy`.
std::filesystem::path find_program(const std::string& name, std::vector<std::filesystem::path> folders,
                                   const std::string& remedy);

struct ExternalCommand {
  std::string name;                  // name in messages
  std::vector<std::string> command;  // absolute path of the program, arguments
  std::string about;                 // subject of the work; messages begin with it
  std::filesystem::path messages;    // file for its stderr
  std::filesystem::path output{};    // file for its stdout; empty: discarded
  std::string after_signal;          // likely reason if a signal ends it
  std::string when_unusable;         // remedy if it cannot be started
  int out_of_time = -1;              // exit code for an exceeded time limit; -1: none
};

// The program ended because of its time limit. The message is the program's.
class TimeLimitPassed : public InvalidInput {
  using InvalidInput::InvalidInput;
};

// Runs the program to its end; it never outlives this process. Returns the end of its stderr, on one line. Throws
// InvalidInput if it cannot be started or fails.
std::string run_program(const ExternalCommand& command);

}  // namespace aspic
