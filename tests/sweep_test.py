#!/usr/bin/env python3
"""Ensembles: studies, job lists that are killed and run again, collected results.

usage: ASPIC=path/to/aspic sweep_test.py [TestCase...]
"""
import csv
import os
import pathlib
import random
import re
import shutil
import signal
import subprocess
import sys
import time
import unittest

from command_line import ASPIC, CommandLine
from crash_test import Crash

KILLS = 25
ORACLE = pathlib.Path(__file__).with_name("sweep_oracle.py")
STUDY = """scene = "beam.toml"
[vary]
material.young = { from = 5e4, to = 2e5, count = 3, scale = "log" }
material.poisson = [0.2, 0.4]
"""


class Sweep(Crash):
    def setUp(self):
        super().setUp()
        self.environment = {**os.environ, "PATH": f"{pathlib.Path(ASPIC).parent}:{os.environ['PATH']}"}

    def study(self, text=STUDY, duration=0.4, out="study", extra=""):
        self.beam("beam.toml", duration, "3, 1, 1", extra)
        self.write("study.toml", text)
        return self.aspic("sweep", "study.toml", "-o", out).stdout

    def start_jobs(self, jobs="study/jobs.txt"):
        return subprocess.Popen(f"tr '\\n' '\\0' < {jobs} | xargs -0 -n 1 -P 2 sh -c", shell=True, cwd=self.folder,
                                env=self.environment, start_new_session=True, stdout=subprocess.PIPE,
                                stderr=subprocess.STDOUT, text=True)

    def run_jobs(self, code=0):
        process = self.start_jobs()
        text = process.communicate(timeout=600)[0]
        self.assertEqual(process.returncode, code, text)
        return text

    def table(self, name):
        with open(self.folder / name, newline="") as file:
            return list(csv.DictReader(file))

    def collect(self, code=0):
        text = self.aspic("sweep", "collect", "study", code=code).stdout
        return text, self.table("study/results.csv")

    def single_run(self, row, keys):
        """The last row of an uninterrupted run without --continue, with frames."""
        out = "single_" + row["case"]
        self.aspic("run", "beam.toml", *[f"--set={key}={row[key]}" for key in keys], "--out", out)
        return self.steps(out)[-1]


class Ensemble(Sweep):
    KEYS = ("material.young", "material.poisson")

    def assert_equal_to_single_runs(self, rows):
        for row in rows:
            last = self.single_run(row, self.KEYS)
            for column in ("state_hash", "kinetic", "potential_total", "min_det_F"):
                self.assertEqual(row[column], last[column], f"case {row['case']}: {column}")
            self.assertEqual((self.folder / "study/runs" / row["case"] / "steps.csv").read_bytes(),
                             (self.folder / f"single_{row['case']}/steps.csv").read_bytes())
        self.assertEqual(len({row["state_hash"] for row in rows}), len(rows))

    def test_killed_jobs_run_again_to_equal_bits(self):
        text = self.study()
        for command in ("xargs", "parallel", "sbatch", "collect"):
            self.assertIn(command, text)
        text, rows = self.collect(code=3)
        self.assertEqual({row["status"] for row in rows}, {"not begun"})
        chance, seen, all_done, longest = random.Random(1), set(), False, 0.3
        for _ in range(KILLS):
            process = self.start_jobs()
            time.sleep(chance.uniform(0, longest))
            os.killpg(process.pid, signal.SIGKILL)
            process.communicate()
            all_done = not self.aspic_fails("sweep", "collect", "study")
            seen |= {row["status"] for row in self.table("study/results.csv")}
            if all_done:
                break
            if not seen & {"killed", "done"}:  # a slow machine
                longest *= 1.5
        self.run_jobs()
        text, rows = self.collect()
        self.assertIn("6 done", text)
        self.assertTrue(seen & {"killed", "done"}, seen)
        self.assertTrue(all(row["status"] == "done" and row["steps"] == "40" and not row["reason"] for row in rows))
        self.assert_equal_to_single_runs(rows)
        self.assertIn("</html>", (self.folder / "study/index.html").read_text())
        self.assertIn("reaction of ", (self.folder / "study/index.html").read_text())

    def aspic_fails(self, *arguments):
        return subprocess.run([ASPIC, *arguments], cwd=self.folder, capture_output=True).returncode != 0

    def test_finished_jobs_do_nothing(self):
        self.study(duration=0.05)
        self.run_jobs()
        files = {p: (p.stat().st_mtime_ns, p.stat().st_ino) for p in (self.folder / "study/runs").rglob("*")}
        self.run_jobs()
        self.assertEqual({p: (p.stat().st_mtime_ns, p.stat().st_ino) for p in (self.folder / "study/runs").rglob("*")}, files)
        self.assertFalse([p for p in files if p.suffix in (".vtu", ".usda", ".pc2", ".html")])

    def test_slurm_script_runs_every_line_once(self):
        self.study(duration=0.05)
        script = (self.folder / "study/slurm.sh").read_text()
        self.assertEqual(re.search(r"#SBATCH --array=1-(\d+)", script)[1], "6")
        for task in range(1, 7):
            subprocess.run(["sh", "study/slurm.sh"], cwd=self.folder, check=True, timeout=60,
                           env={**self.environment, "SLURM_ARRAY_TASK_ID": str(task)})
            self.assertEqual(len(list((self.folder / "study/runs").iterdir())), task)
        _, rows = self.collect()
        self.assertEqual({row["status"] for row in rows}, {"done"})

    def test_slurm_tasks_share_long_lists(self):
        self.study("scene = \"beam.toml\"\nsample = { count = 2500 }\n[vary]\nmaterial.young = { from = 1e4, to = 1e5 }\n")
        self.write("study/jobs.txt", "".join(f"echo {line} >> ran\n" for line in range(1, 2501)))
        self.assertIn("--array=1-1000", (self.folder / "study/slurm.sh").read_text())
        for task in (1, 500, 501, 1000):
            subprocess.run(["sh", "study/slurm.sh"], cwd=self.folder, check=True, timeout=60,
                           env={**self.environment, "SLURM_ARRAY_TASK_ID": str(task)})
        self.assertEqual((self.folder / "ran").read_text().split(),
                         "1 1001 2001 500 1500 2500 501 1501 1000 2000".split())

    @unittest.skipUnless(shutil.which("parallel"), "needs GNU parallel")
    def test_gnu_parallel_runs_the_jobs(self):
        self.study(duration=0.05)
        subprocess.run("parallel -j 2 < study/jobs.txt", shell=True, cwd=self.folder, env=self.environment, check=True)
        self.assertEqual({row["status"] for row in self.collect()[1]}, {"done"})

    def test_values_reach_the_runs_through_the_shell(self):
        self.study("scene = \"beam.toml\"\n[vary]\nmaterial.young = [\"1e5 * (1 + X)\", \"X < 0.2 ? 1e5 : 2e5\"]\n"
                   "\"body.beam.velocity\" = [[\"Y\", 0, 0]]\n", duration=0.02)
        self.run_jobs()
        scenes = [(self.folder / f"study/runs/00000{i}/scene.toml").read_text() for i in (1, 2)]
        self.assertIn('young = "1e5 * (1 + X)"', scenes[0])
        self.assertIn('young = "X < 0.2 ? 1e5 : 2e5"', scenes[1])
        self.assertIn('velocity = ["Y", 0', scenes[1])


class Continued(Sweep):
    LINE = ("run", "beam.toml", "--set", "material.young=2e5", "--out", "run", "--continue")

    def test_run_killed_at_any_time_continues_to_equal_bits(self):
        self.beam("beam.toml", 0.4, "3, 1, 1", "[output]\nevery = 0\ncheckpoint_every = 0\n")
        seconds, chance = self.duration_of(*self.LINE[:-2], "whole", "--continue"), random.Random(2)
        kills, completed = 0, 0
        while kills < KILLS:
            if self.kill_at(chance.uniform(0, seconds), *self.LINE):
                kills += 1
                continue
            self.assert_same_folder("whole", "run")
            completed += 1
            shutil.rmtree(self.folder / "run")
        self.aspic(*self.LINE)
        self.assert_same_folder("whole", "run")

    def test_resumes_after_termination(self):
        self.beam("beam.toml", 20, "8, 2, 2", "[output]\nevery = 100\n")
        process = self.start(*self.LINE)
        self.wait_for_step("run", 3)
        process.send_signal(signal.SIGTERM)
        process.communicate(timeout=60)
        self.assertEqual(process.returncode, 143)
        self.assertIn("stopped: by signal 15", (self.folder / "run/outcome.txt").read_text())
        self.assertIn("resuming after step", self.aspic(*self.LINE).stdout)
        self.assertIn("all 2000 steps are computed", self.aspic(*self.LINE).stdout)
        self.aspic(*self.LINE[:-2], "whole")
        self.assertEqual((self.folder / "run/steps.csv").read_bytes(), (self.folder / "whole/steps.csv").read_bytes())

    def wait_for_step(self, run, count):
        for _ in range(600):
            steps = self.folder / run / "steps.csv"
            if steps.exists() and steps.read_text().count("\n") > count:
                return
            time.sleep(0.05)
        self.fail("no step")

    def test_second_process_is_refused(self):
        self.beam("beam.toml", 20, "8, 2, 2")
        first = self.start(*self.LINE)
        self.wait_for_step("run", 2)
        self.assertRegex(self.aspic(*self.LINE, code=2).stderr, rf"run: process {first.pid} is writing results into it")
        self.assertIn("running: on ", (self.folder / "run/outcome.txt").read_text())
        first.kill()
        first.communicate()

    def test_processes_that_start_together_do_no_harm(self):
        self.beam("beam.toml", 0.1, "3, 1, 1")
        self.aspic(*self.LINE[:-2], "whole", "--continue")
        for _ in range(10):
            processes = [self.start(*self.LINE) for _ in range(3)]
            for process in processes:
                complaint = process.communicate(timeout=60)[1]
                self.assertIn(process.returncode, (0, 2), complaint)
                self.assertIn("is writing results" if process.returncode else "", complaint)
            self.assertIn(0, [process.returncode for process in processes])
            self.assert_same_folder("whole", "run", ignore=("timings.csv", "report.html"))
            shutil.rmtree(self.folder / "run")

    def test_other_scenes_and_folders_are_refused(self):
        self.beam("beam.toml", 0.02)
        self.aspic(*self.LINE)
        before = {p: p.read_bytes() for p in (self.folder / "run").iterdir() if p.is_file() and p.name != "outcome.txt"}
        self.assertIn("was computed with another scene", self.aspic(*self.LINE, "--set", "material.poisson=0.1", code=2).stderr)
        self.assertIn("failed: run: was computed with another scene", (self.folder / "run/outcome.txt").read_text())
        self.assertEqual({p: p.read_bytes() for p in before}, before)
        self.aspic(*self.LINE)
        self.assertEqual((self.folder / "run/outcome.txt").read_text(), "done\n")
        (self.folder / "mine").mkdir()
        self.write("mine/notes.txt", "mine")
        self.assertIn("contains no run", self.aspic("run", "beam.toml", "--out", "mine", "--continue", code=2).stderr)
        self.assertEqual([p.name for p in (self.folder / "mine").iterdir()], ["notes.txt"])

    def test_unconverged_runs_keep_their_exit_code(self):
        self.beam("beam.toml", 0.05, "3, 1, 1", "[solver]\nmax_iterations = 1\n")
        for _ in range(2):
            self.aspic(*self.LINE, code=3)
            self.assertEqual((self.folder / "run/outcome.txt").read_text(), "unconverged\n")
        self.aspic(*self.LINE, "--allow-unconverged")
        self.assertEqual((self.folder / "run/outcome.txt").read_text(), "unconverged\n")

    def test_bad_input_leaves_its_reason_and_begins_later(self):
        self.aspic(*self.LINE, code=2)
        self.assertIn("failed: beam.toml: ", (self.folder / "run/outcome.txt").read_text())
        self.beam("beam.toml", 0.02)
        self.aspic(*self.LINE)
        self.assertEqual((self.folder / "run/outcome.txt").read_text(), "done\n")

    def test_excludes_force_and_resume(self):
        for option in ("--force", "--resume"):
            self.aspic(*self.LINE, option, code=2)


class Collected(Sweep):
    CASES = """solver.max_iterations,body.beam.pin.0.where,time.duration
100,,0.4
100,x < -1,0.4
1,,0.4
100,,40000
100,,300
"""

    def test_each_ending_is_named_with_its_reason(self):
        self.write("cases.csv", self.CASES)
        self.study('scene = "beam.toml"\ncases = "cases.csv"\n')
        lines = (self.folder / "study/jobs.txt").read_text().splitlines()
        run = lambda line: subprocess.Popen(["sh", "-c", "exec " + line], cwd=self.folder, env=self.environment,
                                            stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        for line, code in zip(lines[:3], (0, 2, 3)):
            process = run(line)
            process.communicate(timeout=300)
            self.assertEqual(process.returncode, code)
        process = run(lines[3])
        Continued.wait_for_step(self, "study/runs/000004", 3)
        _, rows = self.collect(code=3)
        self.assertEqual(rows[3]["status"], "running")
        self.assertIn(f"process {process.pid}", rows[3]["reason"])
        process.kill()
        process.communicate()
        text, rows = self.collect(code=3)
        self.assertEqual([row["status"] for row in rows], ["done", "failed", "unconverged", "killed", "not begun"])
        self.assertIn("1 done, 1 not begun, 1 killed, 1 unconverged, 1 failed", text)
        self.assertIn("x < -1", rows[1]["reason"])
        self.assertRegex(rows[2]["reason"], r"\d+ of 40 steps did not converge, the first is step \d+ \(iteration_limit\)")
        self.assertRegex(rows[3]["reason"], r"after step \d+ of 4000000; run the jobs again")
        self.assertEqual(rows[4]["reason"], "")
        page = (self.folder / "study/index.html").read_text()
        self.assertLess(page.index("did not converge, the first"), page.index("Cases that are done"))
        self.assertNotRegex(page, r"https?://(?!www\.w3\.org)")
        # A signal that the program handles.
        process = run(lines[4])
        Continued.wait_for_step(self, "study/runs/000005", 3)
        process.send_signal(signal.SIGTERM)
        process.communicate(timeout=60)
        self.assertEqual(self.collect(code=3)[1][4]["status"], "stopped")

    def test_damaged_results_never_count_as_done(self):
        self.study(duration=0.05)
        self.run_jobs()
        runs = self.folder / "study/runs"
        table = (runs / "000001/steps.csv").read_text().splitlines(keepends=True)
        (runs / "000001/steps.csv").write_text("".join(table[:-1]))
        (runs / "000002/steps.csv").write_text("".join(table).replace(",converged,", ",stuck,", 1))
        (runs / "000003/steps.csv").unlink()
        (runs / "000004/scene.toml").write_text("nonsense")
        (runs / "000005/timings.csv").unlink()
        _, rows = self.collect(code=3)
        self.assertEqual([row["status"] for row in rows],
                         ["failed", "unconverged", "failed", "failed", "failed", "done"])

    def test_writing_again_is_harmless(self):
        text = self.study(duration=0.05)
        self.run_jobs()
        names = ("cases.csv", "jobs.txt", "slurm.sh", "scene.toml")
        before = [(self.folder / "study" / name).read_text() for name in names]
        self.assertEqual(self.aspic("sweep", "study.toml", "-o", "study").stdout, text)
        self.assertEqual([(self.folder / "study" / name).read_text() for name in names], before)
        self.write("study.toml", STUDY.replace("0.4", "0.45"))
        refused = self.aspic("sweep", "study.toml", "-o", "study", code=2).stderr
        self.assertRegex(refused, r"study/cases\.csv:3: '.*0\.4' before, '.*0\.45' now; study/runs has results")
        self.write("study.toml", STUDY)
        self.beam("beam.toml", 0.1, "3, 1, 1")
        self.assertRegex(self.aspic("sweep", "study.toml", "-o", "study", code=2).stderr, r"study/scene\.toml:\d+: 'duration")
        self.assertEqual([(self.folder / "study" / name).read_text() for name in names], before)
        shutil.rmtree(self.folder / "study/runs")
        self.aspic("sweep", "study.toml", "-o", "study")

    def test_folders_of_others_are_refused(self):
        self.study()
        self.assertIn("contains no study", self.aspic("sweep", "study.toml", "-o", ".", code=2).stderr)
        self.assertIn("contains no study", self.aspic("sweep", "collect", ".", code=2).stderr)
        self.assertIn("a study file is missing", self.aspic("sweep", code=2).stderr)

    def test_bad_studies_end_with_line_and_remedy(self):
        self.beam()
        self.write("study.toml", STUDY.replace("poisson", "poison"))
        done = self.aspic("sweep", "study.toml", code=2)
        self.assertRegex(done.stderr, r"^error: study\.toml:4:\d+: .*did you mean 'poisson'")
        self.assertFalse((self.folder / "out").exists())


class Draws(Sweep):
    """cases.csv against an implementation that shares no code."""

    def assert_as_expected(self, text):
        self.study(text)
        done = subprocess.run([sys.executable, ORACLE, "study.toml", "study"], cwd=self.folder, capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        shutil.rmtree(self.folder / "study")

    def test_products_grids_and_draws(self):
        self.assert_as_expected(STUDY)
        for method in ("random", "latin_hypercube"):
            for seed in (1, 2, 2**40):
                self.assert_as_expected(f"""scene = "beam.toml"
sample = {{ method = "{method}", count = 100, seed = {seed} }}
[vary]
material.young = {{ from = 1e3, to = 1e7, scale = "log" }}
material.poisson = {{ from = 0.05, to = 0.45 }}
gravity = [[0, -9.81, 0], [0, 0, -9.81]]
time.step = {{ from = 0.005, to = 0.02, count = 4 }}
""")

    def test_oracle_rejects_wrong_tables(self):
        self.study('scene = "beam.toml"\nsample = { count = 8 }\n[vary]\nmaterial.poisson = { from = 0.1, to = 0.4 }\n')
        lines = (self.folder / "study/cases.csv").read_text().splitlines()
        self.write("study/cases.csv", "\n".join([*lines[:-1], "000008,0.25"]) + "\n")
        done = subprocess.run([sys.executable, ORACLE, "study.toml", "study"], cwd=self.folder, capture_output=True)
        self.assertNotEqual(done.returncode, 0)


if __name__ == "__main__":
    unittest.main(verbosity=2)
