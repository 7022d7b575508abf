// random_scenes [--seed FIRST] [--count N]: runs N random scenes, each in its own process, so that a crash or hang does
// not end the others. Prints the scenes that violate a requirement of judge.h. --print SEED prints a scene; --run SEED
// runs it in this process, for a debugger; --file FILE runs a printed scene, because a new material changes the scene
// of a seed.
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>

#include "base/error.h"
#include "base/parallel.h"
#include "random_scenes/judge.h"
#include "random_scenes/scene_text.h"

namespace aspic {
namespace {

constexpr rlim_t kMaxSeconds = 200;  // CPU time limit; scenes take at most one second, thirty with sanitizers

struct Arguments {
  uint64_t seed = 1, count = 1000;
  bool prints = false, runs = false, verbose = false;
  std::filesystem::path file;  // replaces the seed
};

Judgment run_file(const std::filesystem::path& file, const std::string& text) {
  try {
    Scene scene = load_scene(file);
    return judge(scene, text);
  } catch (const InvalidInput& refusal) {
    return {"refused", refusal.what(), ""};
  } catch (const std::exception& e) {
    return {"exception", "", std::string("exception: ") + e.what()};
  }
}

Judgment run_scene(uint64_t seed, const std::filesystem::path& folder) {
  const std::string text = random_scene(seed);
  const std::filesystem::path file = folder / "scene.toml";
  std::ofstream(file, std::ios::binary) << text;
  return run_file(file, text);
}

Judgment run_file(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw InvalidInput(file.string() + ": cannot be read");
  return run_file(file, {std::istreambuf_iterator<char>(in), {}});
}

// Reads "ending\ndetail\nfault" from a pipe; without output, how the process ended.
Judgment run_apart(uint64_t seed, const std::filesystem::path& folder) {
  int ends[2];
  if (pipe(ends) != 0) throw InvalidInput("no pipe");
  std::fflush(stdout);
  const pid_t child = fork();
  if (child == 0) {
    close(ends[0]);
    const rlimit seconds{kMaxSeconds, kMaxSeconds};
    setrlimit(RLIMIT_CPU, &seconds);
    const rlimit no_core{0, 0};
    setrlimit(RLIMIT_CORE, &no_core);
    set_thread_count(1);
    const Judgment judgment = run_scene(seed, folder);
    std::string text;
    for (const std::string* part : {&judgment.ending, &judgment.detail, &judgment.fault}) {
      for (const char c : *part) text += c == '\n' ? ' ' : c;
      text += '\n';
    }
    const bool is_written = write(ends[1], text.data(), text.size()) == static_cast<ssize_t>(text.size());
    _exit(is_written ? 0 : 1);
  }
  close(ends[1]);
  std::string text;
  char buffer[4096];
  for (ssize_t got = 0; (got = read(ends[0], buffer, sizeof buffer)) > 0;) text.append(buffer, got);
  close(ends[0]);
  int status = 0;
  waitpid(child, &status, 0);
  if (WIFSIGNALED(status)) {
    const bool is_slow = WTERMSIG(status) == SIGXCPU || WTERMSIG(status) == SIGKILL;
    return {is_slow ? "hang" : "crash", "", is_slow ? "did not end" : strsignal(WTERMSIG(status))};
  }
  const size_t first = text.find('\n'), second = text.find('\n', first + 1);
  if (second == std::string::npos) return {"crash", "", "ended without output"};
  return {text.substr(0, first), text.substr(first + 1, second - first - 1),
          text.substr(second + 1, text.size() - second - 2)};
}

int hunt(const Arguments& arguments, const std::filesystem::path& folder) {
  std::map<std::string, int> endings;
  int faults = 0;
  for (uint64_t seed = arguments.seed; seed < arguments.seed + arguments.count; ++seed) {
    const Judgment judgment = run_apart(seed, folder);
    ++endings[judgment.ending];
    if (arguments.verbose)
      std::printf("%llu %s: %s\n", static_cast<unsigned long long>(seed), judgment.ending.c_str(),
                  judgment.detail.c_str());
    if (judgment.fault.empty()) continue;
    ++faults;
    std::printf("---- seed %llu: %s\n%s", static_cast<unsigned long long>(seed), judgment.fault.c_str(),
                random_scene(seed).c_str());
    std::fflush(stdout);
  }
  std::printf("---- %llu scenes from seed %llu, %d at fault:", static_cast<unsigned long long>(arguments.count),
              static_cast<unsigned long long>(arguments.seed), faults);
  for (const auto& [ending, count] : endings) std::printf(" %d %s", count, ending.c_str());
  std::printf("\n");
  const bool are_too_many_refused = 4 * static_cast<uint64_t>(endings["refused"]) > arguments.count;
  if (are_too_many_refused) std::printf("more than a quarter of the scenes was refused, so the test is void\n");
  return faults > 0 || (are_too_many_refused && arguments.count >= 100) ? 1 : 0;
}

Arguments read(int argc, char** argv) {
  Arguments arguments;
  for (int i = 1; i < argc; ++i) {
    const std::string option = argv[i];
    if (option == "--verbose") {
      arguments.verbose = true;
      continue;
    }
    if (option == "--file" && i + 1 < argc) {
      arguments.file = argv[++i];
      continue;
    }
    const bool takes_number = option == "--seed" || option == "--count" || option == "--print" || option == "--run";
    if (!takes_number || i + 1 == argc)
      throw InvalidInput(
          "usage: random_scenes [--seed FIRST] [--count N] [--verbose] | --print SEED | --run SEED | --file FILE");
    const uint64_t number = std::strtoull(argv[++i], nullptr, 10);
    (option == "--count" ? arguments.count : arguments.seed) = number;
    arguments.prints |= option == "--print";
    arguments.runs |= option == "--run";
  }
  return arguments;
}

int run(const Arguments& arguments) {
  if (arguments.prints) return std::printf("%s", random_scene(arguments.seed).c_str()) < 0;
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / ("aspic_random_scenes_" + std::to_string(getpid()));
  std::filesystem::create_directories(folder);
  int code = 0;
  if (arguments.runs || !arguments.file.empty()) {
    const Judgment judgment = arguments.file.empty() ? run_scene(arguments.seed, folder) : run_file(arguments.file);
    std::printf("%s\n%s\n%s\n", judgment.ending.c_str(), judgment.detail.c_str(), judgment.fault.c_str());
    code = judgment.fault.empty() ? 0 : 1;
  } else {
    code = hunt(arguments, folder);
  }
  std::filesystem::remove_all(folder);
  return code;
}

}  // namespace
}  // namespace aspic

int main(int argc, char** argv) {
  try {
    return aspic::run(aspic::read(argc, argv));
  } catch (const std::exception& e) {
    std::fprintf(stderr, "%s\n", e.what());
    return 2;
  }
}
