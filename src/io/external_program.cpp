#include "io/external_program.h"

#include <fcntl.h>
#include <spawn.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <sstream>
#include <system_error>

#include "base/error.h"
#include "io/atomic_file.h"

extern char** environ;  // NOLINT(readability-redundant-declaration): POSIX leaves it to the program

namespace aspic {
namespace {

namespace fs = std::filesystem;

// Returns the wait status; what the program says on stderr goes to a file.
int wait_status(const ExternalCommand& command) {
  std::vector<char*> argv;
  for (const std::string& argument : command.command) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);

  posix_spawn_file_actions_t files;
  ::posix_spawn_file_actions_init(&files);
  ::posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  ::posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  ::posix_spawn_file_actions_addopen(&files, STDERR_FILENO, command.messages.c_str(), O_WRONLY | O_CREAT | O_TRUNC,
                                     0600);
  pid_t process = 0;
  const int error = ::posix_spawn(&process, argv[0], &files, nullptr, argv.data(), environ);
  ::posix_spawn_file_actions_destroy(&files);
  if (error)
    throw InvalidInput(command.command[0] + ": cannot be run: " + std::generic_category().message(error) + "; " +
                       command.when_unusable);
  int status = 0;
  while (::waitpid(process, &status, 0) < 0 && errno == EINTR) {
  }
  return status;
}

std::string said(const fs::path& messages) {
  constexpr size_t kLongest = 2000;
  std::error_code error;
  std::string text = fs::exists(messages, error) ? read_file(messages) : "";
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back()))) text.pop_back();
  if (text.size() > kLongest) text = "... " + text.substr(text.size() - kLongest);
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text.empty() ? "it gave no reason" : text;
}

}  // namespace

TemporaryFolder::TemporaryFolder() {
  std::error_code error;  // of an unusable TMPDIR
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
  const int status = wait_status(command);
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return said(command.messages);
  std::string end = " failed: ";
  if (WIFSIGNALED(status))
    end = std::string(" was ended by the signal '") + ::strsignal(WTERMSIG(status)) + "' (" + command.after_signal +
          "): ";
  throw InvalidInput(command.about + ": " + command.name + end + said(command.messages));
}

}  // namespace aspic
