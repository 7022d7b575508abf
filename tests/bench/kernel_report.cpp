#include "bench/kernel_report.h"
#include "math/vectors.h"

#include <algorithm>
#include <cstdio>
#include <utility>

namespace aspic::bench {

void report(benchmark::State& state, const KernelFacts& facts) {
  state.counters["n"] = facts.n;
  state.counters["threads_used"] = facts.threads;
  state.counters["bytes"] = facts.work.bytes;
  state.counters["flops"] = facts.work.flops;
  state.counters["items"] = facts.items;
  state.counters["repeats"] = facts.repeats;
}

KernelReport::KernelReport(std::map<int, Roofline> rooflines, Results& results)
    : rooflines_(std::move(rooflines)), results_(results) {}

bool KernelReport::ReportContext(const Context&) {
  std::printf("%-38s %7s %3s | %10s %9s | %8s %8s | %6s %8s  %s\n", "kernel", "threads", "n", "ms", "ns/item", "MB",
              "Mflop", "GB/s", "Gflop/s", "part of the nearer bound");
  return true;
}

void KernelReport::ReportRuns(const std::vector<Run>& runs) {
  std::vector<double> seconds;
  KernelFacts facts;
  std::string kernel;
  for (const Run& run : runs) {
    if (run.run_type != Run::RT_Iteration) continue;
    if (run.error_occurred) {
      std::printf("%-38s %s\n", run.run_name.function_name.c_str(), run.error_message.c_str());
      return;
    }
    const auto counter = [&run](const char* name) { return run.counters.at(name).value; };
    facts = {.n = static_cast<int>(counter("n")),
             .threads = static_cast<int>(counter("threads_used")),
             .work = {counter("bytes"), counter("flops")},
             .items = counter("items"),
             .repeats = counter("repeats")};
    kernel = run.run_name.function_name;
    // Other programs increase wall time; threads that wait for each other increase CPU time.
    const double total = facts.threads == 1 ? run.cpu_accumulated_time : run.real_accumulated_time;
    seconds.push_back(total / static_cast<double>(run.iterations) / facts.repeats);
  }
  if (!seconds.empty()) print(kernel.substr(0, kernel.find('@')), facts, median(seconds));
}

void KernelReport::print(const std::string& kernel, const KernelFacts& facts, double seconds) {
  std::printf("%-38s %7d %3d | %10.3f %9.2f |", kernel.c_str(), facts.threads, facts.n, 1e3 * seconds,
              1e9 * seconds / facts.items);
  results_.begin(kernel + " n=" + std::to_string(facts.n), facts.threads);
  results_.add("time, median", 1e3 * seconds, "ms");
  results_.add("time per item", 1e9 * seconds / facts.items, "ns");
  if (facts.work.flops > 0) {
    const Bound reached = bound(facts.work, seconds, rooflines_.at(facts.threads));
    std::printf(" %8.2f %8.2f | %6.1f %8.1f  %3.0f %% of %s", 1e-6 * facts.work.bytes, 1e-6 * facts.work.flops,
                1e-9 * reached.bytes_per_second, 1e-9 * reached.flops_per_second, 100 * reached.part,
                reached.by_memory ? "bandwidth" : "peak");
    results_.add("moved", 1e-6 * facts.work.bytes, "MB");
    results_.add("computed", 1e-6 * facts.work.flops, "Mflop");
    results_.add("bandwidth", 1e-9 * reached.bytes_per_second, "GB/s");
    results_.add("flops", 1e-9 * reached.flops_per_second, "Gflop/s");
    results_.add(reached.by_memory ? "of bandwidth" : "of peak", 100 * reached.part, "%");
  }
  std::printf("\n");
  std::fflush(stdout);
}

}  // namespace aspic::bench
