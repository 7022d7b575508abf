#include "viewer/child_process.h"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <system_error>

#include "base/error.h"
#include "io/atomic_file.h"

extern char** environ;  // NOLINT(readability-redundant-declaration): POSIX leaves it to the program

namespace aspic::viewer {
namespace {

constexpr size_t kLongestMessage = 600;

// A write to a program that has ended is an error of that write, not the end of this program.
class NoBrokenPipe {
 public:
  NoBrokenPipe() {
    struct sigaction ignore {};
    ignore.sa_handler = SIG_IGN;
    ::sigaction(SIGPIPE, &ignore, &before_);
  }
  ~NoBrokenPipe() { ::sigaction(SIGPIPE, &before_, nullptr); }
  NoBrokenPipe(const NoBrokenPipe&) = delete;
  NoBrokenPipe& operator=(const NoBrokenPipe&) = delete;

 private:
  struct sigaction before_ {};
};

}  // namespace

ChildProcess::ChildProcess(const std::vector<std::string>& command, const std::filesystem::path& messages, Input input)
    : messages_(messages) {
  std::array<int, 2> ends = {-1, -1};
  if (input == Input::pipe && ::pipe2(ends.data(), O_CLOEXEC) != 0)
    throw InvalidInput(command[0] + ": cannot be run: " + std::generic_category().message(errno));
  std::vector<char*> argv;
  for (const std::string& argument : command) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  posix_spawn_file_actions_t files;
  ::posix_spawn_file_actions_init(&files);
  if (input == Input::pipe) {
    ::posix_spawn_file_actions_adddup2(&files, ends[0], STDIN_FILENO);
  } else {
    ::posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  }
  ::posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  ::posix_spawn_file_actions_addopen(&files, STDERR_FILENO, messages.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  // A group of its own: ctrl-C in the terminal is for this program, which ends the whole group.
  posix_spawnattr_t attributes;
  ::posix_spawnattr_init(&attributes);
  ::posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
  ::posix_spawnattr_setpgroup(&attributes, 0);
  const int error = ::posix_spawn(&process_, argv[0], &files, &attributes, argv.data(), environ);
  ::posix_spawnattr_destroy(&attributes);
  ::posix_spawn_file_actions_destroy(&files);
  if (ends[0] >= 0) ::close(ends[0]);
  input_ = ends[1];
  if (!error) return;
  close_input();
  throw InvalidInput(command[0] + ": cannot be run: " + std::generic_category().message(error));
}

ChildProcess::~ChildProcess() {
  close_input();
  ::kill(-process_, SIGKILL);
  if (!has_ended_) wait();
}

bool ChildProcess::write(std::string_view bytes) {
  const NoBrokenPipe guard;
  while (!bytes.empty()) {
    const ssize_t written = ::write(input_, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return false;
    bytes.remove_prefix(static_cast<size_t>(written));
  }
  return true;
}

void ChildProcess::close_input() {
  if (input_ >= 0) ::close(input_);
  input_ = -1;
}

void ChildProcess::note_end(int status) {
  has_ended_ = true;
  succeeded_ = WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

bool ChildProcess::is_running() {
  int status = 0;
  if (!has_ended_ && ::waitpid(process_, &status, WNOHANG) == process_) note_end(status);
  return !has_ended_;
}

bool ChildProcess::wait() {
  int status = 0;
  while (!has_ended_) {
    if (::waitpid(process_, &status, 0) == process_) {
      note_end(status);
    } else if (errno != EINTR) {
      has_ended_ = true;
    }
  }
  return succeeded_;
}

std::string ChildProcess::said() const {
  std::error_code error;
  std::string text = std::filesystem::exists(messages_, error) ? read_file(messages_) : "";
  while (!text.empty() && text.back() == '\n') text.pop_back();
  if (text.size() > kLongestMessage) text = "... " + text.substr(text.size() - kLongestMessage);
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text.empty() ? "it gave no reason" : text;
}

}  // namespace aspic::viewer
