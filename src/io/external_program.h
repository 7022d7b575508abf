// Other programs that do part of the work: found, run to their end without a shell, their complaints passed on.
#pragma once
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"

namespace aspic {

// A new folder below the system's for temporary files, removed with its contents at the end of its scope. Throws
// InvalidInput when there is no place for it.
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
std::filesystem::path program_folder();  // of the program that runs

// The program of this name in one of `folders` or on the PATH. Throws InvalidInput that ends with `remedy`.
std::filesystem::path find_program(const std::string& name, std::vector<std::filesystem::path> folders,
                                   const std::string& remedy);

struct ExternalCommand {
  std::string name;                  // in messages
  std::vector<std::string> command;  // absolute path of the program, arguments
  std::string about;                 // what it works on; messages begin with it
  std::filesystem::path messages;    // the file that receives what it says on stderr
  std::filesystem::path output{};    // the file that receives its stdout; empty: nothing does
  std::string after_signal;          // the likely reason when a signal ended it
  std::string when_unusable;         // remedy when it cannot be started
  int out_of_time = -1;              // exit code that means so; -1: there is none
};

// A program ended because of the time limit that it was given. The message is the program's.
class TimeLimitPassed : public InvalidInput {
  using InvalidInput::InvalidInput;
};

// Runs the program to its end; it never outlives this process. Returns the end of what it said on stderr, on one line.
// Throws InvalidInput when it cannot be run or fails.
std::string run_program(const ExternalCommand& command);

}  // namespace aspic
