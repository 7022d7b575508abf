#include "aspic/streams.h"

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <system_error>

namespace aspic::cli {
namespace {

struct Stream {
  int descriptor;
  std::atomic<int> error = 0;  // errno of the first failed write
};

Stream output{STDOUT_FILENO}, messages{STDERR_FILENO};

// Returns false when the bytes cannot be written.
bool write_all(int descriptor, const char* bytes, size_t size) {
  while (size > 0) {
    const ssize_t written = ::write(descriptor, bytes, size);
    if (written < 0 && errno == EINTR) continue;
    if (written < 0 && errno == EAGAIN) {  // a pipe that another program made non-blocking
      pollfd ready{.fd = descriptor, .events = POLLOUT, .revents = 0};
      ::poll(&ready, 1, -1);
      continue;
    }
    if (written < 0) return false;
    bytes += written;
    size -= static_cast<size_t>(written);
  }
  return true;
}

// Always reports success, because the C library would buffer the data and fail repeatedly.
ssize_t write_or_note(void* cookie, const char* bytes, size_t size) {
  Stream& stream = *static_cast<Stream*>(cookie);
  if (stream.error == 0 && !write_all(stream.descriptor, bytes, size)) stream.error = errno;
  return static_cast<ssize_t>(size);
}

std::FILE* guarded(Stream& stream, int buffering) {
  std::FILE* file =
      ::fopencookie(&stream, "w", {.read = nullptr, .write = write_or_note, .seek = nullptr, .close = nullptr});
  if (file) std::setvbuf(file, nullptr, buffering, BUFSIZ);
  return file;
}

// Writing to a reserved descriptor fails like writing to a closed one.
void reserve_closed_descriptors() {
  for (int i = STDIN_FILENO; i <= STDERR_FILENO; ++i) {
    if (::fcntl(i, F_GETFD) >= 0 || errno != EBADF) continue;
    [[maybe_unused]] const int lowest_free = ::open("/dev/null", O_RDONLY);
  }
}

}  // namespace

void guard_standard_streams() {
  reserve_closed_descriptors();
  if (std::FILE* file = guarded(output, ::isatty(STDOUT_FILENO) ? _IOLBF : _IOFBF)) stdout = file;
  if (std::FILE* file = guarded(messages, _IONBF)) stderr = file;
}

int descriptor(std::FILE* stream) { return stream == stderr ? STDERR_FILENO : STDOUT_FILENO; }

std::string lost_output() {
  std::fflush(stdout);
  return output.error == 0 ? "" : std::generic_category().message(output.error);
}

}  // namespace aspic::cli
