#include "io/external_program.h"

#include <fcntl.h>
#include <stdlib.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <sstream>
#include <system_error>

#include "base/error.h"
#include "io/atomic_file.h"

extern char** environ;  // NOLINT(readability-redundant-declaration): POSIX leaves it to the program

namespace aspic {
namespace {

namespace fs = std::filesystem;

struct Redirections {
  std::string output, messages;
};

[[noreturn]] void become(char* const* argv, const Redirections& to, pid_t parent, int failure) {
  // Calls between fork and exec must be safe beside other threads.
  constexpr int kNew = O_WRONLY | O_CREAT | O_TRUNC;
  const auto redirect = [](const char* path, int flags, int stream) {
    const int file = ::open(path, flags, 0600);
    return file >= 0 && ::dup2(file, stream) >= 0;
  };
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() == parent && redirect("/dev/null", O_RDONLY, STDIN_FILENO) &&
      redirect(to.output.c_str(), kNew, STDOUT_FILENO) && redirect(to.messages.c_str(), kNew, STDERR_FILENO))
    ::execve(argv[0], argv, environ);
  const int error = errno;
  [[maybe_unused]] const ssize_t written = ::write(failure, &error, sizeof error);
  ::_exit(127);
}

// Returns the wait status; what the program prints goes to files. The program is killed when the thread that
// started it ends, however that happens.
int wait_status(const ExternalCommand& command) {
  std::vector<char*> argv;
  for (const std::string& argument : command.command) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  const Redirections to{command.output.empty() ? "/dev/null" : command.output.string(), command.messages.string()};
  const pid_t self = ::getpid();
  int failure[2];  // a pipe that exec closes; otherwise it brings the reason
  int error = 0, status = 0;
  if (::pipe2(failure, O_CLOEXEC) != 0) {
    error = errno;
  } else {
    const pid_t process = ::fork();
    if (process == 0) become(argv.data(), to, self, failure[1]);
    if (process < 0) error = errno;
    ::close(failure[1]);
    while (process > 0 && ::read(failure[0], &error, sizeof error) < 0 && errno == EINTR) {
    }
    ::close(failure[0]);
    while (process > 0 && ::waitpid(process, &status, 0) < 0 && errno == EINTR) {
    }
  }
  if (error)
    throw InvalidInput(command.command[0] + ": cannot be run: " + std::generic_category().message(error) + "; " +
                       command.when_unusable);
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

// What it said of its failure, within a message of ours.
std::string complaint(const fs::path& messages) {
  const std::string text = said(messages);
  return text.starts_with("error: ") ? text.substr(7) : text;
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
  const std::string subject = command.about + ": " + command.name;
  if (WIFEXITED(status) && WEXITSTATUS(status) == command.out_of_time)
    throw TimeLimitPassed(subject + " ran out of time: " + complaint(command.messages));
  std::string end = " failed: ";
  if (WIFSIGNALED(status))
    end = std::string(" was ended by the signal '") + ::strsignal(WTERMSIG(status)) + "' (" + command.after_signal +
          "): ";
  throw InvalidInput(subject + end + complaint(command.messages));
}

}  // namespace aspic
