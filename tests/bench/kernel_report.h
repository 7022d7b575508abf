// One line per kernel: its time, and the fraction of the machine's limits that it reaches.
#pragma once
#include <benchmark/benchmark.h>

#include <map>
#include <string>
#include <vector>

#include "bench/results.h"
#include "bench/roofline.h"

namespace aspic::bench {

// Data that a benchmark reports through its counters.
struct KernelFacts {
  int n = 0;           // cells across the beam
  int threads = 1;     //
  KernelWork work;     // without flops no bounds are reported
  double items = 1;    // tets, blocks, ...; the report has the time per item
  double repeats = 1;  // executions of this work per benchmark iteration
};
void report(benchmark::State& state, const KernelFacts& facts);

class KernelReport : public benchmark::BenchmarkReporter {
 public:
  KernelReport(std::map<int, Roofline> rooflines, Results& results);
  bool ReportContext(const Context&) override;
  void ReportRuns(const std::vector<Run>& runs) override;

 private:
  void print(const std::string& kernel, const KernelFacts& facts, double seconds);

  std::map<int, Roofline> rooflines_;  // by number of threads
  Results& results_;
};

}  // namespace aspic::bench
