// Runs another program without a shell.
#pragma once
#include <sys/types.h>

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace aspic {

// Lifetime of the program, and whether ctrl-C in the terminal reaches it.
enum class Lifetime {
  shared,     // ends with its ChildProcess; ctrl-C reaches both programs
  own_group,  // the same, including all its children; ctrl-C reaches only this program
  detached,   // unlimited, in its own session
};

struct Launch {
  std::vector<std::string> command;     // absolute path of the program, arguments
  std::filesystem::path output = {};    // file for stdout; empty: discarded
  std::filesystem::path messages = {};  // file for stderr; empty: discarded
  bool has_input = false;               // stdin is a pipe from write(); otherwise empty
  Lifetime lifetime = Lifetime::shared;
};

class ChildProcess {
 public:
  // Throws InvalidInput if the program cannot be started; the message ends with `remedy`.
  explicit ChildProcess(const Launch& launch, const std::string& remedy = "");
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  bool write(std::string_view bytes);  // writes to stdin; false: the program reads no more
  void close_input();
  bool is_running();
  void terminate();             // sends SIGTERM
  int wait();                   // waits for the end; returns the status of waitpid(), 0 for success
  std::string message() const;  // end of its stderr, on one line

 private:
  std::filesystem::path messages_;
  Lifetime lifetime_;
  pid_t process_ = 0;
  int input_ = -1;  // file descriptor
  bool has_ended_ = false;
  int status_ = -1;  // status of waitpid(); -1: unknown
};

}  // namespace aspic
