// What the machine can do, measured now and by the library's own threads: the two bounds that a kernel is held against
// [Williams 2009].
#pragma once
#include <vector>

namespace aspic::bench {

struct Bandwidth {
  double footprint;         // of the three arrays of the triad [bytes]
  double bytes_per_second;  // an array that is written counts twice: its lines are read first
};

struct Roofline {
  int threads = 1;
  double flops_per_second = 0;       // fused multiply-adds on full SIMD registers, each counts as two
  std::vector<Bandwidth> bandwidth;  // of a[i] = b[i] + s c[i], by size: caches are faster than memory

  double bandwidth_at(double footprint) const;  // of the size nearest to it
};

Roofline measure_roofline(int threads);  // takes about half a second
void print(const Roofline& roofline);

// What a kernel moves and computes at least, each datum read or written once, by a formula.
struct KernelWork {
  double bytes = 0, flops = 0;
};

struct Bound {
  double bytes_per_second = 0, flops_per_second = 0;  // reached
  bool by_memory = false;                             // the nearer of the two bounds
  double part = 0;                                    // of that bound [1]
};
Bound bound(const KernelWork& work, double seconds, const Roofline& roofline);

}  // namespace aspic::bench
