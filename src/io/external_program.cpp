#include "io/external_program.h"

#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <sstream>
#include <system_error>

#include "base/error.h"
#include "io/child_process.h"

namespace aspic {
namespace {

namespace fs = std::filesystem;

// Message of the failure, for use inside another message.
std::string complaint(const ChildProcess& process) {
  const std::string text = process.message();
  return text.starts_with("error: ") ? text.substr(7) : text;
}

}  // namespace

TemporaryFolder::TemporaryFolder() {
  std::error_code error;  // error of an unusable TMPDIR
  std::string name = (fs::temp_directory_path(error) / "aspic-XXXXXX").string();
  if (error || !::mkdtemp(name.data()))
    throw InvalidInput(name +
                       ": cannot be created: " + (error ? error.message() : std::generic_category().message(errno)) +
                       "; set TMPDIR to a folder with space");
  path_ = name;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code error;
  fs::remove_all(path_, error);
}

bool is_program(const fs::path& path) {
  std::error_code error;
  return fs::is_regular_file(path, error) && ::access(path.c_str(), X_OK) == 0;
}

fs::path program_folder() {
  std::error_code error;
  return fs::read_symlink("/proc/self/exe", error).parent_path();
}

fs::path find_program(const std::string& name, std::vector<fs::path> folders, const std::string& remedy) {
  const bool beside = !folders.empty();
  if (const char* path = ::getenv("PATH")) {
    std::istringstream list(path);
    for (std::string folder; std::getline(list, folder, ':');)
      if (!folder.empty()) folders.emplace_back(folder);
  }
  for (const fs::path& folder : folders)
    if (is_program(folder / name)) return folder / name;
  throw InvalidInput(name + ": not found " + (beside ? "beside this program or " : "") + "on the PATH, and " + remedy);
}

std::string run_program(const ExternalCommand& command) {
  ChildProcess process({.command = command.command, .output = command.output, .messages = command.messages},
                       command.when_unusable);
  const int status = process.wait();
  if (status == 0) return process.message();
  const std::string subject = command.about + ": " + command.name;
  if (WIFEXITED(status) && WEXITSTATUS(status) == command.out_of_time)
    throw TimeLimitPassed(subject + " ran out of time: " + complaint(process));
  std::string end = " failed: ";
  if (WIFSIGNALED(status))
    end = std::string(" was ended by the signal '") + ::strsignal(WTERMSIG(status)) + "' (" + command.after_signal +
          "): ";
  throw InvalidInput(subject + end + complaint(process));
}

}  // namespace aspic
