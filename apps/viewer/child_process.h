// Another program that runs beside this one. It and what it started are ended with the object, at the latest, and by
// the system when this program is killed.
#pragma once
#include <sys/types.h>

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace aspic::viewer {

enum class Input { none, pipe };

class ChildProcess {
 public:
  // `command`: an absolute path and arguments. What it says on stderr goes to the file `messages`. Throws InvalidInput
  // when it cannot be started.
  ChildProcess(const std::vector<std::string>& command, const std::filesystem::path& messages, Input input);
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  bool write(std::string_view bytes);  // to its input; false: it reads no more
  void close_input();
  bool is_running();
  bool wait();               // for its end; true: exit code 0
  std::string said() const;  // the end of its messages, on one line

 private:
  void note_end(int status);

  std::filesystem::path messages_;
  pid_t process_ = 0;
  int input_ = -1;  // file descriptor
  bool has_ended_ = false, succeeded_ = false;
};

}  // namespace aspic::viewer
