// Numbers of a study: grids, random draws and Latin hypercubes. They use only operations that IEEE 754 rounds exactly,
// so all machines compute the same bits.
#pragma once
#include <cstdint>
#include <string_view>
#include <vector>

namespace aspic {

// SplitMix64 [Steele 2014]. The stream of each name is independent of the other names.
class Draws {
 public:
  Draws(std::uint64_t seed, std::string_view name);  // the initial state is seed + FNV-1a(name)
  std::uint64_t next();
  double uniform();  // in [0, 1): the upper 53 bits

 private:
  std::uint64_t state_;
};

// `count` independent numbers in [0, 1). More draws keep the earlier ones.
std::vector<double> random_sample(Draws draws, int count);
// One number in each of `count` equal strata of [0, 1), in random order [McKay 1979].
std::vector<double> latin_hypercube(Draws draws, int count);

enum class StudyScale { linear, logarithmic };

struct StudyRange {
  double from = 0, to = 1;  // from < to; logarithmic: from > 0
  StudyScale scale = StudyScale::linear;

  double at(double share) const;          // share 0: from, 1: to
  std::vector<double> grid(int n) const;  // n > 1 equidistant values with 12 significant digits; both ends are exact
};

}  // namespace aspic
