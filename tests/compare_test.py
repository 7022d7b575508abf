#!/usr/bin/env python3
"""The statistics of tests/bench/compare.py on synthetic times, and the command with synthetic programs."""
import importlib.util
import math
import pathlib
import random
import subprocess
import sys
import tempfile
import unittest

SCRIPT = pathlib.Path(__file__).resolve().parent / "bench" / "compare.py"
specification = importlib.util.spec_from_file_location("compare", SCRIPT)
compare = importlib.util.module_from_spec(specification)
specification.loader.exec_module(compare)


class Interval(unittest.TestCase):
    def test_six_values_are_the_fewest_with_95_percent(self):
        self.assertEqual(compare.median_interval([3, 1, 2, 6, 5, 4]), (1, 6, 1 - 2 / 2**6))
        self.assertLess(compare.median_interval([1, 2, 3, 4, 5])[2], 0.95)
        self.assertEqual(compare.median_interval([7])[:2], (7, 7))

    def test_ranks_are_those_of_the_tables(self):  # of the sign test, two-sided 5 %
        for n, k in ((8, 1), (9, 2), (11, 2), (12, 3), (15, 4), (20, 6), (25, 8), (50, 18)):
            low, high, confidence = compare.median_interval(range(1, n + 1))
            self.assertEqual((low, high), (k, n + 1 - k), n)
            self.assertGreaterEqual(confidence, 0.95)

    def test_covers_the_median_at_its_level(self):
        draw, covered, trials = random.Random(1), 0, 4000
        for _ in range(trials):  # a skewed distribution with median 1, like that of times
            low, high, confidence = compare.median_interval([math.exp(draw.gauss(0, 1)) for _ in range(11)])
            covered += low <= 1 <= high
        deviation = math.sqrt(confidence * (1 - confidence) / trials)
        self.assertAlmostEqual(covered / trials, confidence, delta=4 * deviation)


class Verdict(unittest.TestCase):
    @staticmethod
    def judged(old, new, noise, runs=11, seed=1):
        draw, mean = random.Random(seed), {"old": old, "new": new}
        pairs = compare.measure_in_turn(lambda which: mean[which] * (1 + noise * draw.random()), runs)
        return compare.summary(pairs, 0.01)[1]

    def test_clear_differences_are_seen_through_noise(self):
        self.assertEqual(self.judged(1, 0.8, 0.1), "faster")
        self.assertEqual(self.judged(1, 1.25, 0.1), "slower")

    def test_equal_programs_do_not_differ(self):
        verdicts = [self.judged(1, 1, 0.3, seed=seed) for seed in range(200)]
        self.assertGreater(verdicts.count("no difference"), 180)

    def test_ignores_insignificant_differences(self):
        self.assertEqual(self.judged(1, 1.005, 0), "no difference")
        self.assertEqual(self.judged(1, 1.02, 0), "slower")

    def test_too_few_runs_decide_nothing(self):
        self.assertEqual(self.judged(1, 2, 0, runs=5), "no difference")

    def test_slow_phases_affect_both_programs(self):
        calls = []

        def measure(which):
            calls.append(which)
            return (2 if len(calls) > 12 else 1) * (0.9 if which == "new" else 1)

        self.assertEqual(compare.summary(compare.measure_in_turn(measure, 11), 0.01)[1], "faster")
        self.assertEqual(calls[:6], ["old", "new", "new", "old", "old", "new"])


class Command(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        for build in ("old", "new"):
            (self.folder / build / "bin").mkdir(parents=True)

    def program(self, build, text):
        path = self.folder / build / "bin" / "bench_loop"
        path.write_text("#!/bin/sh\n" + text)
        path.chmod(0o755)

    def run_compare(self, *arguments):
        return subprocess.run([sys.executable, SCRIPT, self.folder / "old", self.folder / "new", *arguments],
                              capture_output=True, text=True)

    def test_it_ends_with_a_verdict(self):
        for build in ("old", "new"):
            self.program(build, 'i=0; while [ $i -lt "$1" ]; do i=$((i + 1)); done')
        done = self.run_compare("--runs", "6", "--wall", "loop", "200")
        self.assertIn(done.stdout.splitlines()[-1], ("faster", "slower", "no difference"), done.stderr)
        self.assertIn("medians of 6 runs", done.stdout)

    def test_missing_and_failing_programs_are_reported(self):
        self.assertIn("ninja -C", self.run_compare("loop").stderr)
        self.program("old", "echo it broke; exit 3")
        self.program("new", "exit 0")
        done = self.run_compare("loop")
        self.assertIn("exit code 3:\nit broke", done.stderr)
        self.assertEqual(done.returncode, 1)


if __name__ == "__main__":
    unittest.main()
