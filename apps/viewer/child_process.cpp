#include "viewer/child_process.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <system_error>

#include "base/error.h"
#include "io/atomic_file.h"

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

// In the child, where only what is safe in a signal handler may be called: runs the program on these files.
[[noreturn]] void become(char* const* argv, std::array<int, 3> files, pid_t parent) {
  ::setpgid(0, 0);                     // ctrl-C in the terminal is for the parent, which ends the whole group
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);  // however the parent ends
  bool is_ready = ::getppid() == parent;
  for (int i = 0; i < 3; ++i) is_ready = is_ready && ::dup2(files[i], i) >= 0;
  if (is_ready) ::execv(argv[0], argv);
  ::_exit(127);
}

}  // namespace

ChildProcess::ChildProcess(const std::vector<std::string>& command, const std::filesystem::path& messages, Input input)
    : messages_(messages) {
  std::array<int, 2> ends = {-1, -1};
  if (input == Input::pipe && ::pipe2(ends.data(), O_CLOEXEC) != 0)
    throw InvalidInput(command[0] + ": cannot be run: " + std::generic_category().message(errno));
  std::vector<char*> argv;
  for (const std::string& argument : command) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  const int in = input == Input::pipe ? ends[0] : ::open("/dev/null", O_RDONLY | O_CLOEXEC);
  const int out = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
  const int said = ::open(messages.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
  const pid_t parent = ::getpid();
  process_ = ::fork();
  if (process_ == 0) become(argv.data(), {in, out, said}, parent);
  const int error = errno;
  if (process_ > 0) ::setpgid(process_, process_);  // whoever of the two comes first
  for (const int end : {in, out, said})
    if (end >= 0) ::close(end);
  input_ = ends[1];
  if (process_ > 0) return;
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
