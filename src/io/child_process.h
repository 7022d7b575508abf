// Another program, started without a shell.
#pragma once
#include <sys/types.h>

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace aspic {

// How long the program lives, and which ctrl-C in the terminal ends it.
enum class Lifetime {
  shared,     // at most as long as its ChildProcess; ctrl-C reaches both programs
  own_group,  // the same, with all that it starts; ctrl-C reaches this program alone
  detached,   // as long as it likes, in a session of its own
};

struct Launch {
  std::vector<std::string> command;     // absolute path of the program, arguments
  std::filesystem::path output = {};    // file that receives its stdout; empty: discarded
  std::filesystem::path messages = {};  // file that receives its stderr; empty: discarded
  bool has_input = false;               // its stdin is a pipe from write(); else empty
  Lifetime lifetime = Lifetime::shared;
};

class ChildProcess {
 public:
  // Throws InvalidInput when the program cannot be started, with `remedy` at the end of the message.
  explicit ChildProcess(const Launch& launch, const std::string& remedy = "");
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  bool write(std::string_view bytes);  // to its stdin; false: it reads no more
  void close_input();
  bool is_running();
  int wait();                   // for its end; returns its status as waitpid() does, 0 for success
  std::string message() const;  // the end of what it wrote to stderr, on one line

 private:
  std::filesystem::path messages_;
  Lifetime lifetime_;
  pid_t process_ = 0;
  int input_ = -1;  // file descriptor
  bool has_ended_ = false;
  int status_ = -1;  // as of waitpid(); -1: not known
};

}  // namespace aspic
