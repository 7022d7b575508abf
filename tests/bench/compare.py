#!/usr/bin/env python3
"""Compares two builds: compare.py OLD_BUILD NEW_BUILD [--runs N] [--wall] BENCH ARGS...

Runs bin/bench_BENCH of both build folders alternately, so that other load affects both equally. Prints the median of
the ratios new / old of the pairs with a 95 % interval, and "faster", "slower" or "no difference".
Exit code: 0, or 1 for slower. For example
  tests/bench/compare.py build/old build/new --runs 15 beam 14 --naive 0
"""
import argparse
import math
import pathlib
import resource
import statistics
import subprocess
import sys
import time

CONFIDENCE = 0.95


def median_interval(values):
    """Returns a distribution-free interval of the median by order statistics: (low, high, confidence).

    The k-th smallest and the k-th largest of n values enclose the median with probability 1 - 2 P(B < k), B binomial
    with n and 1/2. Uses the largest k that reaches CONFIDENCE; fewer than 6 values never reach it and give their range.
    """
    ordered, n = sorted(values), len(values)

    def confidence(k):
        return 1 - 2 * sum(math.comb(n, i) for i in range(k)) / 2**n

    k = 1
    while k + 1 <= (n + 1) // 2 and confidence(k + 1) >= CONFIDENCE:
        k += 1
    return ordered[k - 1], ordered[n - k], confidence(k)


def verdict(low, high, least):
    """Returns "no difference" unless the whole interval exceeds the relative difference `least`."""
    if high < 1 - least:
        return "faster"
    if low > 1 + least:
        return "slower"
    return "no difference"


def measure_in_turn(measure, runs):
    """Returns the times (old, new) of each pair in alternating order. Discards a first pair, which warms the caches."""
    pairs = []
    for i in range(runs + 1):
        order = ("old", "new") if i % 2 == 0 else ("new", "old")
        seconds = {which: measure(which) for which in order}
        pairs.append((seconds["old"], seconds["new"]))
    return pairs[1:]


def summary(pairs, least):
    """Returns the lines to print, and the verdict."""
    ratios = [new / old for old, new in pairs]
    low, high, confidence = median_interval(ratios)
    judged = verdict(low, high, least)
    old, new = (statistics.median(side) for side in zip(*pairs))
    lines = [f"old {old:.4g} s, new {new:.4g} s (medians of {len(pairs)} runs each)",
             f"new / old: {statistics.median(ratios):.4f}, {100 * confidence:.1f} % interval [{low:.4f}, {high:.4f}]"]
    if confidence < CONFIDENCE:
        lines.append(f"too few runs for {100 * CONFIDENCE:.0f} %: use at least 6")
        judged = "no difference"
    return lines + [judged], judged


def seconds_of(command, wall):
    """Returns the CPU time of the command with all threads, or its wall time."""
    start = time.perf_counter()
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    if done.returncode != 0:
        sys.exit(f"error: {' '.join(command)} failed with exit code {done.returncode}:\n{done.stdout}")
    if wall:
        return time.perf_counter() - start
    return after.ru_utime - before.ru_utime + after.ru_stime - before.ru_stime


def program(build, bench):
    path = pathlib.Path(build) / "bin" / f"bench_{bench}"
    if not path.is_file():
        sys.exit(f"error: {path}: the program does not exist; build it: ninja -C {build} bench_{bench}")
    return str(path)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("old")
    parser.add_argument("new")
    parser.add_argument("--runs", type=int, default=11, help="pairs (default: 11)")
    parser.add_argument("--wall", action="store_true", help="compare wall time, for several threads; by default CPU time")
    parser.add_argument("--least", type=float, default=0.01, help="relative difference that counts (default: 0.01)")
    parser.add_argument("bench")
    parser.add_argument("args", nargs=argparse.REMAINDER)
    options = parser.parse_args()
    if options.runs < 1:
        parser.error("--runs: at least 1")
    commands = {which: [program(build, options.bench), *options.args]
                for which, build in (("old", options.old), ("new", options.new))}
    pairs = measure_in_turn(lambda which: seconds_of(commands[which], options.wall), options.runs)
    if any(min(pair) <= 0 for pair in pairs):
        sys.exit("error: a run was too short to be timed; choose a larger problem")
    lines, judged = summary(pairs, options.least)
    print("\n".join(lines))
    return judged == "slower"


if __name__ == "__main__":
    sys.exit(main())
