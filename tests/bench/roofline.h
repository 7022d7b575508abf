// Limits of the machine, measured with the library's threads: bandwidth and flops, the two bounds of a kernel [Williams
// 2009].
#pragma once
#include <vector>

namespace aspic::bench {

struct Bandwidth {
  double footprint;         // size of the triad's three arrays [bytes]
  double bytes_per_second;  // a written array counts twice because its cache lines are read first
};

struct Roofline {
  int threads = 1;
  double flops_per_second = 0;       // fused multiply-adds on full SIMD registers, counted as two flops
  std::vector<Bandwidth> bandwidth;  // bandwidth of a[i] = b[i] + s c[i] by size; caches are faster than memory

  double bandwidth_at(double footprint) const;  // value for the nearest size
};

Roofline measure_roofline(int threads);  // takes about half a second
void print(const Roofline& roofline);

// Lower bounds of data and flops of a kernel by a formula; each datum is read or written once.
struct KernelWork {
  double bytes = 0, flops = 0;
};

struct Bound {
  double bytes_per_second = 0, flops_per_second = 0;  // reached values
  bool by_memory = false;                             // whether memory is the tighter bound
  double part = 0;                                    // fraction of that bound [1]
};
Bound bound(const KernelWork& work, double seconds, const Roofline& roofline);

}  // namespace aspic::bench
