#include "bench/roofline.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>

#include "base/parallel.h"
#include "bench/stopwatch.h"
#include "math/pack.h"

namespace aspic::bench {
namespace {

constexpr int kTrials = 24;  // the fastest counts, because other programs may run

// A single thread is timed by CPU time, which is independent of other programs.
template <class Fn>
double fastest(int threads, const Fn& fn) {
  double best = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kTrials; ++i) {
    Stopwatch stopwatch;
    fn();
    const Seconds seconds = stopwatch.lap();
    best = std::min(best, threads == 1 ? seconds.processor : seconds.wall);
  }
  return best;
}

double triad(double footprint, int threads) {
  const int size = static_cast<int>(footprint / (3 * sizeof(double)));
  std::vector<double> a(size, 0.0), b(size, 1.0), c(size, 2.0);
  const int sweeps = std::max(1, static_cast<int>(64e6 / footprint));
  double s = 0.5;
  const double seconds = fastest(threads, [&] {
    for (int sweep = 0; sweep < sweeps; ++sweep) {
      parallel_chunks(size, [&](int first, int last) {
        for (int i = first; i < last; ++i) a[i] = b[i] + s * c[i];
      });
      s = a[sweep];  // prevents removal of the sweep
    }
  });
  return 4.0 * sizeof(double) * size * sweeps / seconds;
}

// Sixteen independent chains of fused multiply-adds hide the latency.
Pack multiply_add_chains(int length) {
  constexpr int kChains = 16;
  std::array<Pack, kChains> x;
  for (int k = 0; k < kChains; ++k) x[k] = Pack(1.0 + k);
  const Pack scale(0.999), shift(0.001);
  for (int i = 0; i < length; ++i)
    for (int k = 0; k < kChains; ++k) x[k] = x[k] * scale + shift;
  Pack total(0.0);
  for (const Pack& chain : x) total += chain;
  return total;
}

double peak(int threads) {
  constexpr int kLength = 1 << 18;
  std::vector<double> results(threads);
  const double seconds =
      fastest(threads, [&] { parallel_for(threads, [&](int i) { results[i] = sum(multiply_add_chains(kLength)); }); });
  return 2.0 * 16 * kPackWidth * kLength * threads / seconds;
}

}  // namespace

double Roofline::bandwidth_at(double footprint) const {
  const auto distance = [&](const Bandwidth& b) { return std::abs(std::log(b.footprint / std::max(footprint, 1.0))); };
  return std::min_element(bandwidth.begin(), bandwidth.end(),
                          [&](const Bandwidth& a, const Bandwidth& b) { return distance(a) < distance(b); })
      ->bytes_per_second;
}

Roofline measure_roofline(int threads) {
  set_thread_count(threads);
  Roofline roofline{.threads = threads, .flops_per_second = peak(threads), .bandwidth = {}};
  for (const double megabytes : {0.5, 2.0, 8.0, 32.0, 128.0}) {
    roofline.bandwidth.push_back({1e6 * megabytes, triad(1e6 * megabytes, threads)});
  }
  return roofline;
}

void print(const Roofline& roofline) {
  std::printf("%d thread%s: %.1f Gflop/s;", roofline.threads, roofline.threads == 1 ? "" : "s",
              1e-9 * roofline.flops_per_second);
  for (const Bandwidth& b : roofline.bandwidth)
    std::printf(" %.0f GB/s at %g MB%s", 1e-9 * b.bytes_per_second, 1e-6 * b.footprint,
                &b == &roofline.bandwidth.back() ? "\n" : ",");
}

Bound bound(const KernelWork& work, double seconds, const Roofline& roofline) {
  Bound bound{work.bytes / seconds, work.flops / seconds, false, 0};
  const double memory = bound.bytes_per_second / roofline.bandwidth_at(work.bytes);
  const double arithmetic = bound.flops_per_second / roofline.flops_per_second;
  bound.by_memory = memory >= arithmetic;
  bound.part = std::max(memory, arithmetic);
  return bound;
}

}  // namespace aspic::bench
