#include "io/tetrahedralise.h"

#include <fcntl.h>
#include <spawn.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <sstream>
#include <system_error>

#include "base/error.h"
#include "io/atomic_file.h"
#include "io/mesh_file.h"
#include "io/number_text.h"

extern char** environ;  // NOLINT(readability-redundant-declaration): POSIX leaves it to the program

namespace aspic {
namespace {

namespace fs = std::filesystem;

constexpr const char* kProgram = "aspic-mesh";

bool is_program(const fs::path& path) {
  std::error_code error;
  return fs::is_regular_file(path, error) && ::access(path.c_str(), X_OK) == 0;
}

// Beside this program, where an installation has it; at its place in the build folder; on the PATH.
fs::path find_program() {
  std::error_code error;
  const fs::path here = fs::read_symlink("/proc/self/exe", error).parent_path();
  std::vector<fs::path> folders = {here, here / ".." / "mesh", here / ".." / "apps" / "mesh", here / "apps" / "mesh"};
  if (const char* path = ::getenv("PATH")) {
    std::istringstream list(path);
    for (std::string folder; std::getline(list, folder, ':');)
      if (!folder.empty()) folders.emplace_back(folder);
  }
  for (const fs::path& folder : folders)
    if (is_program(folder / kProgram)) return folder / kProgram;
  throw InvalidInput(std::string(kProgram) +
                     ": not found beside this program or on the PATH, and filling a surface with tets needs it; build "
                     "Aspic with -DASPIC_MESHER=ON (Debian package libcgal-dev), or give a mesh of tets");
}

// A new folder, removed with its contents at the end of its scope.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::error_code error;  // of an unusable TMPDIR
    std::string name = (fs::temp_directory_path(error) / "aspic-XXXXXX").string();
    if (error || !::mkdtemp(name.data()))
      throw InvalidInput(name +
                         ": cannot be created: " + (error ? error.message() : std::generic_category().message(errno)) +
                         "; set TMPDIR to a folder with space");
    path_ = name;
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  ~TemporaryFolder() {
    std::error_code error;
    fs::remove_all(path_, error);
  }
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

// Runs a program to its end, without a shell. Returns its wait status; what it says on stderr goes to a file.
int run(const std::vector<std::string>& arguments, const fs::path& messages) {
  std::vector<char*> argv;
  for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);

  posix_spawn_file_actions_t files;
  ::posix_spawn_file_actions_init(&files);
  ::posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  ::posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  ::posix_spawn_file_actions_addopen(&files, STDERR_FILENO, messages.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  pid_t process = 0;
  const int error = ::posix_spawn(&process, argv[0], &files, nullptr, argv.data(), environ);
  ::posix_spawn_file_actions_destroy(&files);
  if (error)
    throw InvalidInput(arguments[0] + ": cannot be run: " + std::generic_category().message(error) +
                       "; build it again with -DASPIC_MESHER=ON");
  int status = 0;
  while (::waitpid(process, &status, 0) < 0 && errno == EINTR) {
  }
  return status;
}

// The end of what the program said, on one line.
std::string said(const fs::path& messages) {
  constexpr size_t kLongest = 2000;
  std::error_code error;
  std::string text = fs::exists(messages, error) ? read_file(messages) : "";
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back()))) text.pop_back();
  if (text.size() > kLongest) text = "... " + text.substr(text.size() - kLongest);
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text.empty() ? "it gave no reason" : text;
}

void check_status(int status, const fs::path& surface, const fs::path& messages) {
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return;
  std::string end = " failed: ";
  if (WIFSIGNALED(status))
    end = std::string(" was ended by the signal '") + ::strsignal(WTERMSIG(status)) +
          "' (out of memory? try a larger size): ";
  throw InvalidInput(surface.string() + ": " + kProgram + end + said(messages));
}

// The diagonal of the surface's bounding box / 25.
double default_size(const fs::path& surface) {
  const TriMesh mesh = read_tri_mesh(surface);
  Vec3d lower = mesh.vertices.at(0), upper = lower;
  for (const Vec3d& vertex : mesh.vertices)
    for (int i = 0; i < 3; ++i) {
      lower[i] = std::min(lower[i], vertex[i]);
      upper[i] = std::max(upper[i], vertex[i]);
    }
  const double diagonal = std::hypot(upper[0] - lower[0], upper[1] - lower[1], upper[2] - lower[2]);
  if (!(diagonal > 0)) throw InvalidInput(surface.string() + ": all vertices are in one place; use a closed surface");
  return diagonal / 25;
}

}  // namespace

TetMesh tetrahedralise(const fs::path& surface, const TetrahedraliseOptions& options) {
  if (!(options.size >= 0) || !std::isfinite(options.size))
    throw InvalidInput(surface.string() + ": the target edge length is " + std::to_string(options.size) +
                       "; it must be positive, or 0 for a default");
  if (!options.program.empty() && !is_program(options.program))
    throw InvalidInput(options.program.string() + ": is not a program; give the path of " + kProgram);
  const fs::path program = options.program.empty() ? find_program() : options.program;
  std::string size;
  append_number(size, options.size > 0 ? options.size : default_size(surface));

  const TemporaryFolder folder;
  const fs::path result = folder.path() / "tets.mesh", messages = folder.path() / "messages";
  const int status =
      run({fs::absolute(program).string(), fs::absolute(surface).string(), "-o", result.string(), "--size", size},
          messages);
  check_status(status, surface, messages);
  std::error_code error;
  if (!fs::exists(result, error))
    throw InvalidInput(surface.string() + ": " + kProgram + " wrote no mesh: " + said(messages));
  return read_tet_mesh(result);
}

}  // namespace aspic
