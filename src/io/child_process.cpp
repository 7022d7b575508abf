#include "io/child_process.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <system_error>

#include "base/error.h"
#include "io/atomic_file.h"

namespace aspic {
namespace {

namespace fs = std::filesystem;

constexpr size_t kLongestMessage = 2000;

// Writing to a program that has ended fails instead of raising SIGPIPE.
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

// File descriptors that are closed at the end of the scope.
class Descriptors {
 public:
  Descriptors() = default;
  ~Descriptors() {
    for (const int file : files_) ::close(file);
  }
  Descriptors(const Descriptors&) = delete;
  Descriptors& operator=(const Descriptors&) = delete;
  int add(int file) {
    if (file >= 0)
      files_.push_back(file);
    else if (error_ == 0)
      error_ = errno;
    return file;
  }
  int error() const { return error_; }  // error of the first file that could not be opened
  int open(const fs::path& path, int flags) {
    return add(::open(path.empty() ? "/dev/null" : path.c_str(), flags | O_CLOEXEC, 0600));
  }

 private:
  std::vector<int> files_;
  int error_ = 0;
};

// Runs in the child, where only async-signal-safe functions are allowed: starts the program with these files, or writes
// the reason of a failure to the pipe `failure`.
[[noreturn]] void become(char* const* argv, std::array<int, 3> files, Lifetime lifetime, pid_t parent, int failure) {
  if (lifetime == Lifetime::own_group) ::setpgid(0, 0);
  if (lifetime == Lifetime::detached) ::setsid();
  if (lifetime != Lifetime::detached) ::prctl(PR_SET_PDEATHSIG, SIGKILL);  // even if the parent is killed
  bool is_ready = ::getppid() == parent;
  for (int i = 0; i < 3; ++i) is_ready = is_ready && ::dup2(files[i], i) >= 0;
  if (is_ready) ::execv(argv[0], argv);
  const int error = errno;
  [[maybe_unused]] const ssize_t written = ::write(failure, &error, sizeof error);
  ::_exit(127);
}

}  // namespace

ChildProcess::ChildProcess(const Launch& launch, const std::string& remedy)
    : messages_(launch.messages), lifetime_(launch.lifetime) {
  std::vector<char*> argv;
  for (const std::string& argument : launch.command) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  constexpr int kNew = O_WRONLY | O_CREAT | O_TRUNC;
  Descriptors files;
  std::array<int, 2> input = {-1, -1}, failure = {-1, -1};  // exec closes `failure`; otherwise it carries the reason
  if (::pipe2(failure.data(), O_CLOEXEC) != 0) files.add(-1);
  if (failure[0] >= 0) files.add(failure[0]);
  if (launch.has_input && ::pipe2(input.data(), O_CLOEXEC) != 0) files.add(-1);
  const std::array<int, 3> streams = {launch.has_input ? files.add(input[0]) : files.open({}, O_RDONLY),
                                      files.open(launch.output, kNew), files.open(launch.messages, kNew)};
  int error = files.error();
  const pid_t parent = ::getpid();
  if (!error) process_ = ::fork();
  if (!error && process_ == 0) become(argv.data(), streams, lifetime_, parent, failure[1]);
  if (process_ < 0) error = errno;
  if (failure[1] >= 0) ::close(failure[1]);
  input_ = input[1];
  if (process_ > 0 && lifetime_ == Lifetime::own_group)
    ::setpgid(process_, process_);  // in both processes, because their order is unknown
  while (process_ > 0 && ::read(failure[0], &error, sizeof error) < 0 && errno == EINTR) {
  }
  if (!error) return;
  close_input();
  if (process_ > 0) wait();
  throw InvalidInput(launch.command[0] + ": cannot be run: " + std::generic_category().message(error) +
                     (remedy.empty() ? "" : "; " + remedy));
}

ChildProcess::~ChildProcess() {
  close_input();
  if (lifetime_ == Lifetime::detached) return;
  if (lifetime_ == Lifetime::own_group) ::kill(-process_, SIGKILL);  // its own children may still run
  if (has_ended_) return;
  ::kill(process_, SIGKILL);
  wait();
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

bool ChildProcess::is_running() {
  if (!has_ended_) has_ended_ = ::waitpid(process_, &status_, WNOHANG) == process_;
  return !has_ended_;
}

void ChildProcess::terminate() {
  if (is_running()) ::kill(process_, SIGTERM);
}

int ChildProcess::wait() {
  while (!has_ended_) has_ended_ = ::waitpid(process_, &status_, 0) == process_ || errno != EINTR;
  return status_;
}

std::string ChildProcess::message() const {
  std::error_code error;
  std::string text = fs::exists(messages_, error) ? read_file(messages_) : "";
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back()))) text.pop_back();
  if (text.size() > kLongestMessage) text = "... " + text.substr(text.size() - kLongestMessage);
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text.empty() ? "it gave no reason" : text;
}

}  // namespace aspic
