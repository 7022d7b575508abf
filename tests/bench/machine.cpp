#include "bench/machine.h"

#include <cstdio>
#include <fstream>
#include <sstream>
#include <thread>

#include "base/formatted.h"
#include "build_facts.h"
#include "math/pack.h"

namespace aspic::bench {
namespace {

std::string line_of(const std::string& path) {
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  return line;
}

// Value of the first line "key : value" of a file in /proc; empty if there is none.
std::string value_in(const std::string& path, const std::string& key) {
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    const size_t colon = line.find(':');
    if (colon == std::string::npos || !line.starts_with(key)) continue;
    if (line.find_first_not_of(" \t", key.size()) != colon) continue;
    const size_t begin = line.find_first_not_of(" \t", colon + 1);
    return begin == std::string::npos ? "" : line.substr(begin);
  }
  return "";
}

std::string processor() {
  const std::string info = "/proc/cpuinfo", name = value_in(info, "model name");
  if (name.empty()) return "unknown";
  return name + ", family " + value_in(info, "cpu family") + " model " + value_in(info, "model");
}

std::string simd() {
  const std::string flags = " " + value_in("/proc/cpuinfo", "flags") + " ";
  std::string widest = "none known";
  for (const char* name : {"sse2", "avx", "avx2", "avx512f"})
    if (flags.find(std::string(" ") + name + " ") != std::string::npos) widest = name;
  return "processor " + widest + ", program " + std::to_string(kPackWidth) + " doubles";
}

std::string caches() {  // caches of the first core
  std::string text;
  for (int i = 0; i < 8; ++i) {
    const std::string folder = "/sys/devices/system/cpu/cpu0/cache/index" + std::to_string(i) + "/";
    const std::string size = line_of(folder + "size");
    if (size.empty() || line_of(folder + "type") == "Instruction") continue;
    text += text.empty() ? "L" : ", L";
    text += line_of(folder + "level");
    text += " ";
    text += size;
  }
  return text.empty() ? "unknown" : text;
}

std::string memory() {
  const std::string kib = value_in("/proc/meminfo", "MemTotal");
  if (kib.empty()) return "unknown";
  return formatted("%.1f GiB", std::stod(kib) / (1 << 20));
}

std::string frequency() {
  const std::string governor = line_of("/sys/devices/system/cpu/cpu0/cpufreq/scaling_governor");
  return "governor " + (governor.empty() ? "unknown" : governor);
}

double load() {  // runnable processes over the last minute; negative: unknown
  std::istringstream line(line_of("/proc/loadavg"));
  double one_minute = -1;
  line >> one_minute;
  return one_minute;
}

std::string load_text() {
  const double one_minute = load();
  return one_minute < 0 ? "unknown" : formatted("%.2f in the last minute", one_minute);
}

}  // namespace

std::vector<Fact> machine_facts() {
  using namespace build_facts;
  return {{"processor", processor()},
          {"cores", std::to_string(std::thread::hardware_concurrency())},
          {"simd", simd()},
          {"caches", caches()},
          {"memory", memory()},
          {"frequency", frequency()},
          {"load", load_text()},
          {"compiler", kCompiler},
          {"build", std::string(kBuildType) + ", " + kFlags},
          {"version", std::string(kVersion) + (*kCommit ? " " : "") + kCommit}};
}

void print_facts(const std::vector<Fact>& facts) {
  for (const Fact& fact : facts) std::printf("%-10s %s\n", fact.name.c_str(), fact.value.c_str());
  if (load() > 0.3 * std::thread::hardware_concurrency()) {
    std::printf(
        "note: other programs are running; wall times, in particular with several threads, will be longer than "
        "they are\n");
  }
}

double peak_memory() {
  const std::string kib = value_in("/proc/self/status", "VmHWM");
  return kib.empty() ? 0 : 1024 * std::stod(kib);
}

void forget_peak_memory() { std::ofstream("/proc/self/clear_refs") << "5\n"; }

}  // namespace aspic::bench
