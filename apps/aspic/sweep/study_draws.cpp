#include "aspic/sweep/study_draws.h"

#include <cmath>
#include <numeric>
#include <utility>

#include "base/formatted.h"
#include "base/hash.h"
#include "base/number_chars.h"

namespace aspic {
namespace {

constexpr int kMantissaBits = 53;

std::uint64_t hash_of(std::string_view name) {
  Fnv1a hash;
  hash.add(name.data(), name.size());
  return hash.value();
}

// Returns ratio^share as a product of square roots. std::pow differs between libraries in the last bit.
double power(double ratio, double share) {
  double result = 1, root = ratio;
  for (int bit = 0; bit < kMantissaBits && share > 0; ++bit) {
    root = std::sqrt(root);
    share *= 2;
    if (share < 1) continue;
    share -= 1;
    result *= root;
  }
  return result;
}

double rounded(double value) {
  const std::string text = formatted("%.12g", value);
  from_chars(text.data(), text.data() + text.size(), value);
  return value;
}

}  // namespace

Draws::Draws(std::uint64_t seed, std::string_view name) : state_(seed + hash_of(name)) {}

std::uint64_t Draws::next() {
  std::uint64_t z = state_ += 0x9e3779b97f4a7c15;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
  z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
  return z ^ (z >> 31);
}

double Draws::uniform() { return static_cast<double>(next() >> (64 - kMantissaBits)) * 0x1p-53; }

std::vector<double> random_sample(Draws draws, int count) {
  std::vector<double> sample(count);
  for (double& value : sample) value = draws.uniform();
  return sample;
}

std::vector<double> latin_hypercube(Draws draws, int count) {
  std::vector<int> stratum(count);
  std::iota(stratum.begin(), stratum.end(), 0);
  for (int i = count - 1; i > 0; --i) std::swap(stratum[i], stratum[draws.next() % (i + 1)]);
  std::vector<double> sample(count);
  for (int i = 0; i < count; ++i) sample[i] = (stratum[i] + draws.uniform()) / count;
  return sample;
}

double StudyRange::at(double share) const {
  if (share <= 0) return from;
  if (share >= 1) return to;
  return scale == StudyScale::linear ? std::fma(share, to - from, from) : from * power(to / from, share);
}

std::vector<double> StudyRange::grid(int n) const {
  std::vector<double> values(n);
  for (int k = 0; k < n; ++k) values[k] = rounded(at(k / (n - 1.0)));
  values.front() = from;
  values.back() = to;
  return values;
}

}  // namespace aspic
