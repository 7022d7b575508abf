#!/usr/bin/env python3
"""Signals end commands between steps; the state of every step is certified and reproducible."""
import csv
import json
import re
import shutil
import signal
import time
import unittest

from crash_test import checkpoint, state_hash, Crash


class Signals(Crash):
    CODES = {signal.SIGINT: 130, signal.SIGTERM: 143}

    def signalled(self, with_signal, ready, *arguments, stream="stderr"):
        """Sends the signal at the first line of the stream that matches."""
        process = self.start(*arguments)
        for line in getattr(process, stream):
            if re.search(ready, line):
                break
        else:
            self.fail(process.communicate())
        process.send_signal(with_signal)
        out, err = process.communicate(timeout=60)
        return process.returncode, out + err

    def test_compare_writes_finished_methods(self):
        for with_signal, code in self.CODES.items():
            shutil.rmtree(self.folder / "out", ignore_errors=True)
            got, said = self.signalled(with_signal, "gradient_descent", "compare", self.scene(cells="16, 6, 6"), "--methods",
                                       "newton,gradient_descent:none,lbfgs", "--set", "solver.tolerance=1e-13")
            self.assertEqual(got, code, said)
            self.assertIn("1 of 3 methods are in the tables", said)
            with open(self.folder / "out/compare_beam/methods.csv", newline="") as file:
                self.assertEqual(len(list(csv.DictReader(file))), 1)

    def test_minimize_reports_its_last_iterate(self):
        for with_signal, code in self.CODES.items():
            got, said = self.signalled(with_signal, "^ +100 ", "minimize", "rosenbrock", "--method", "gradient_descent",
                                       "--max-iterations", "100000000", "--tolerance", "0", "--trace", "trace",
                                       stream="stdout")
            self.assertEqual(got, code, said)
            self.assertIn("interrupted after", said)
            self.assert_whole_table(self.folder / "trace/iterations.csv")

    def test_view_ends_successfully(self):
        for with_signal in self.CODES:
            for what in (self.scene(), "run"):
                if what == "run" and not (self.folder / "run").exists():
                    self.aspic("run", self.scene(duration=0.02), "--out", "run")
                got, said = self.signalled(with_signal, "Ctrl-C ends it", "view", what, "--no-browser", stream="stdout")
                self.assertEqual(got, 0, said)

    def test_run_writes_report_and_resume_hint(self):
        for with_signal, code in self.CODES.items():
            shutil.rmtree(self.folder / "run", ignore_errors=True)
            got, said = self.signalled(with_signal, '"step":3\\b', "run", self.scene(duration=20, cells="16, 4, 4"), "--out",
                                       "run", "--json", stream="stdout")
            self.assertEqual(got, code, said[-500:])
            self.assertIn("--resume", said)
            self.assertTrue((self.folder / "run/report.html").exists())
            self.assertEqual(self.assert_readable("run"), len(self.steps("run")))

    def test_loading_ends_at_once(self):
        """There are no results to keep, so the signal has its default effect."""
        self.beam("large.toml", 0.05, "60, 30, 30")
        for arguments in (("check", "large.toml"), ("run", "large.toml"), ("compare", "large.toml", "--methods", "newton")):
            process = self.start(*arguments)
            time.sleep(0.3)
            process.send_signal(signal.SIGINT)
            process.communicate(timeout=20)
            self.assertEqual(process.returncode, -signal.SIGINT, arguments)
        self.assertFalse((self.folder / "out/large").exists())


@unittest.skipUnless(shutil.which("chromium"), "chromium is missing")
class SignalsToRender(Crash):
    def test_render_leaves_whole_pictures(self):
        self.aspic("run", self.scene(duration=0.2), "--out", "run")
        for with_signal, code in Signals.CODES.items():
            shutil.rmtree(self.folder / "frames", ignore_errors=True)
            process = self.start("render", "run", "-o", "frames", "--size", "80x60")
            until = time.monotonic() + 60
            while not [*self.folder.glob("frames/*.png")] and time.monotonic() < until:
                time.sleep(0.002)
            process.send_signal(with_signal)
            process.communicate(timeout=60)
            self.assertEqual(process.returncode, code)
            pictures = [*self.folder.glob("frames/*.png")]
            self.assertTrue(pictures)
            for picture in pictures:
                self.assertTrue(picture.read_bytes().endswith(b"IEND\xaeB`\x82"), picture)


class Certificate(Crash):
    def test_hash_matches_documentation_in_all_outputs(self):
        done = self.aspic("run", self.scene(duration=0.1), "--json", "--out", "run")
        lines = [json.loads(line) for line in done.stdout.splitlines()]
        rows = self.steps("run")
        self.assertEqual([line["state_hash"] for line in lines], [row["state_hash"] for row in rows])
        self.assertEqual(len({row["state_hash"] for row in rows}), 10)
        self.assertEqual(rows[-1]["state_hash"], state_hash(checkpoint(self.folder / "run/checkpoint.bin")))
        self.assertIn(f"state      {rows[-1]['state_hash']} after step 10", done.stderr)

    def test_every_step_has_a_status(self):
        done = self.aspic("run", self.scene(duration=0.1), "--json", "--out", "run")
        for line in map(json.loads, done.stdout.splitlines()):
            self.assertEqual((line["status"], line["criterion"], line["energy_bound"]), ("converged", "scale", "holds"))
            self.assertLessEqual(line["residual"], line["residual_threshold"])
            self.assertGreater(line["decrement"], 0)
            self.assertGreater(line["energy_slack"], 0)
        self.assertIn("the bound of backward Euler holds in 10 of 10 steps", done.stderr)
        self.assertRegex(done.stderr, r"status     10 converged; worst: step \d+, converged, residual .* N \(tolerance .* N\)")

    def test_criterion_of_directions_is_stated(self):
        done = self.aspic("run", self.scene(duration=0.1), "--set", "solver.criterion=velocity", "solver.tolerance=1e-3")
        self.assertIn("converged  10 of 10 to 0.001 m/s; iterations per step", done.stdout)

    def test_the_worst_step_is_named(self):
        done = self.aspic("run", self.scene(duration=0.1), "--set", "solver.max_iterations=1", "--allow-unconverged")
        self.assertRegex(done.stdout, r"status     .*iteration_limit; worst: step \d+, iteration_limit, residual")


class SameBits(Crash):
    """Threads and restarts of the program; determinism_test.cpp covers all combinations."""

    def test_threads_change_no_bit(self):
        scene = self.scene(duration=0.1, cells="12, 4, 4")
        self.aspic("run", scene, "--out", "one", "--threads", "1")
        for threads in ("2", "3", "8"):
            self.aspic("run", scene, "--out", threads, "--threads", threads)
            self.assert_same_folder("one", threads)

    def test_restarts_change_no_bit(self):
        scene = self.scene(duration=0.5)
        self.aspic("run", scene, "--out", "whole")
        for k in range(1, 50, 7):
            self.aspic("run", scene, "--out", "run", "--force", "--steps", str(k))
            self.aspic("run", scene, "--out", "run", "--resume")
            self.assert_same_folder("whole", "run")


if __name__ == "__main__":
    unittest.main(verbosity=2)
