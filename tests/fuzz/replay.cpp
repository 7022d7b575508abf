// Feeds files to a target without a fuzzer, in any build: "replay gmsh FILE|FOLDER ...". "replay --list" prints the
// targets. "replay --mutants N gmsh FILE|FOLDER ..." feeds N damaged copies of each file, the same ones in every run.
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <iterator>
#include <string>
#include <vector>

#include "io/atomic_file.h"
#include "targets.h"

namespace aspic::fuzz {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> files_of(int count, char** arguments) {
  std::vector<fs::path> files;
  for (int i = 0; i < count; ++i)
    if (fs::is_directory(arguments[i]))
      for (const auto& entry : fs::directory_iterator(arguments[i])) files.push_back(entry.path());
    else
      files.emplace_back(arguments[i]);
  std::sort(files.begin(), files.end());
  return files;
}

// SplitMix64 [Steele 2014].
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}
  size_t below(size_t end) { return static_cast<size_t>(next() % end); }
  std::uint64_t next() {
    std::uint64_t z = state_ += 0x9e3779b97f4a7c15;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
    z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
    return z ^ (z >> 31);
  }

 private:
  std::uint64_t state_;
};

// Numbers at which programs fail: the limits of integers, and sizes.
std::uint64_t dangerous_number(Random& random) {
  constexpr std::uint64_t kNumbers[] = {0,
                                        1,
                                        2,
                                        3,
                                        4,
                                        0x7f,
                                        0xff,
                                        0x7fff,
                                        0xffff,
                                        0x7fffffff,
                                        0x80000000,
                                        0xffffffff,
                                        0x7ff0000000000000,
                                        0x7fffffffffffffff,
                                        0x8000000000000000,
                                        0xffffffffffffffff};
  return kNumbers[random.below(std::size(kNumbers))] - random.below(2);
}

void damage(Random& random, std::string& bytes) {
  const size_t at = random.below(bytes.size()), length = 1 + random.below(40);
  switch (random.below(6)) {
    case 0:
      bytes[at] = static_cast<char>(bytes[at] ^ (1 << random.below(8)));
      break;
    case 1:
    case 2: {
      const std::uint64_t number = dangerous_number(random);
      const size_t size = std::min(random.below(2) ? sizeof(number) : sizeof(std::uint32_t), bytes.size() - at);
      std::memcpy(bytes.data() + at, &number, size);
      break;
    }
    case 3:
      bytes.erase(at, length);
      break;
    case 4:
      bytes.insert(at, bytes, random.below(bytes.size()), length);
      break;
    default:
      bytes.resize(random.below(4) ? bytes.size() : at);
  }
}

// The copy with this number, with one to four damages.
std::string mutant(std::string bytes, std::uint64_t number) {
  Random random(number);
  for (size_t damages = 1 + random.below(4); damages > 0 && !bytes.empty(); --damages) damage(random, bytes);
  return bytes;
}

int feed_mutants(const Target& target, int count, const std::vector<fs::path>& files) {
  int fed = 0, read = 0;
  for (const fs::path& file : files) {
    const std::string bytes = read_file(file);
    for (int number = 0; number < count; ++number, ++fed) {
      std::fprintf(stderr, "\r%s, mutant %d", file.string().c_str(), number);  // the last one printed is the faulty one
      read += attempt(target.feed, mutant(bytes, static_cast<std::uint64_t>(number))).empty() ? 1 : 0;
    }
  }
  std::fprintf(stderr, "\n%d mutants, %d of them read\n", fed, read);
  return fed > 0 ? 0 : 1;
}

}  // namespace
}  // namespace aspic::fuzz

int main(int count, char** arguments) {
  using namespace aspic::fuzz;
  const std::string name = count > 1 ? arguments[1] : "";
  if (name == "--list") {
    for (const Target& target : targets()) std::printf("%s\n", std::string(target.name).c_str());
    return 0;
  }
  if (name == "--mutants" && count > 4) {
    const Target* target = target_named(arguments[3]);
    return target ? feed_mutants(*target, std::atoi(arguments[2]), files_of(count - 4, arguments + 4)) : 2;
  }
  const Target* target = target_named(name);
  if (count < 3 || !target) {
    std::fprintf(stderr, "usage: replay TARGET FILE|FOLDER ...; replay --list prints the targets\n");
    return 2;
  }
  const std::vector<fs::path> files = files_of(count - 2, arguments + 2);
  for (const fs::path& file : files) {
    std::fprintf(stderr, "%s: ", file.string().c_str());  // the last name printed is the faulty file
    const std::string refusal = attempt(target->feed, aspic::read_file(file));
    std::fprintf(stderr, "%s\n", refusal.empty() ? "read" : refusal.c_str());
  }
  return files.empty() ? 1 : 0;
}
