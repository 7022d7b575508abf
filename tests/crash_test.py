#!/usr/bin/env python3
"""Runs that are killed, interrupted, out of time or out of disk space: their files can be read, and resumption is
bit-reproducible.

usage: ASPIC=path/to/aspic crash_test.py [TestCase...]
"""
import csv
import filecmp
import json
import mmap
import os
import random
import resource
import shutil
import signal
import struct
import subprocess
import time
import unittest
import xml.etree.ElementTree
import zlib

from command_line import ASPIC, CommandLine

RUN_KILLS, OTHER_KILLS = 200, 24
NOBODY = 65534
EVERY_STEP = "[output]\nevery = 0\ncheckpoint_every = 0\n"


def checkpoint(path):
    """Returns {name: numbers} of a checkpoint. Raises if a byte is wrong."""
    data = path.read_bytes()
    assert data[:8] == b"ASPICCHK" and struct.unpack("<Q", data[16:24])[0] == len(data), f"{path}: cut short"
    assert zlib.crc32(data[:-4]) == struct.unpack("<I", data[-4:])[0], f"{path}: wrong checksum"
    at, found = 24, {}

    def take(count):
        nonlocal at
        at += count
        return data[at - count:at]

    integer = lambda: struct.unpack("<Q", take(8))[0]
    take(integer())  # the fingerprint
    for _ in range(integer()):
        name = take(integer()).decode()
        found[name] = struct.unpack("<q", take(8))[0]
    for _ in range(integer()):
        name, count = take(integer()).decode(), integer()
        found[name] = take(8 * count)
    return found


def state_hash(state):
    """The hash of docs/determinism.md."""
    value = 0xCBF29CE484222325
    for name in ("q", "qdot"):
        for (word,) in struct.iter_unpack("<Q", state[name]):
            value = ((value ^ word) * 0x100000001B3) % 2**64
            value ^= value >> 32
    return f"{value:016x}"


class Crash(CommandLine):
    def scene(self, name="beam.toml", duration=0.4, cells="3, 1, 1", extra=""):
        return self.beam(name, duration, cells, EVERY_STEP + extra)

    def whole_lines(self, path):
        """The bytes of the whole lines. If a process is killed during a write, the system completes whole pages of the file."""
        data = path.read_bytes()
        if data and not data.endswith(b"\n"):
            self.assertEqual(len(data) % mmap.PAGESIZE, 0, f"{path}: torn within a page: {data[-60:]!r}")
        return data[: data.rfind(b"\n") + 1]

    def assert_whole_table(self, path):
        rows = list(csv.reader(self.whole_lines(path).decode().splitlines()))
        self.assertEqual({len(row) for row in rows}, {len(rows[0])}, f"{path}: rows of different lengths")

    def assert_readable(self, run):
        """Checks the files of a run killed at any time. Returns the step of the checkpoint, -1 without one."""
        run = self.folder / run
        for table in ("steps.csv", "iterations.csv", "timings.csv"):
            if (run / table).exists():
                self.assert_whole_table(run / table)
        for index in [*run.glob("run.pvd")]:
            for frame in xml.etree.ElementTree.parse(index).getroot().iter("DataSet"):
                xml.etree.ElementTree.parse(run / frame.get("file"))
        for page in [*run.glob("report.html")]:
            self.assertIn("</html>", page.read_text())
        for stage in [*run.glob("run.usda")]:
            text = stage.read_text()
            self.assertEqual(text.count("{"), text.count("}"))
        for cache in run.glob("skins/*.pc2"):
            data = cache.read_bytes()
            if data:
                points, samples = struct.unpack("<i", data[16:20])[0], struct.unpack("<i", data[28:32])[0]
                self.assertGreaterEqual(len(data), 32 + 12 * points * samples)
        newest = run / "checkpoint.bin"
        for path in (newest, run / "checkpoint.previous.bin"):
            if path.exists():
                checkpoint(path)
        return checkpoint(newest)["steps_taken"] if newest.exists() else -1

    def kill_at(self, seconds, *arguments, stdout=subprocess.DEVNULL):
        """Returns whether the run was killed before its end."""
        process = subprocess.Popen([ASPIC, *arguments], cwd=self.folder, stdout=stdout, stderr=subprocess.PIPE)
        try:
            _, complaint = process.communicate(timeout=seconds)
        except subprocess.TimeoutExpired:
            process.kill()
            process.communicate()
            return True
        self.assertEqual(process.returncode, 0, complaint.decode())
        return False

    def duration_of(self, *arguments):
        begin = time.monotonic()
        self.aspic(*arguments)
        return time.monotonic() - begin

    def assert_same_folder(self, one, other, ignore=("timings.csv",)):
        left, right = self.folder / one, self.folder / other
        files = lambda root: {p.relative_to(root) for p in root.rglob("*") if p.is_file()}
        self.assertEqual(files(left), files(right))
        for name in sorted(files(left)):
            if name.name not in ignore:
                self.assertTrue(filecmp.cmp(left / name, right / name, shallow=False), f"{name} differs")


class Killed(Crash):
    def test_run_killed_at_200_instants_resumes(self):
        scene, chance = self.scene(), random.Random(1)
        seconds = self.duration_of("run", scene, "--out", "whole")
        kills, completed, step = 0, 0, -1
        with open(self.folder / "lines.json", "ab") as lines:
            while kills < RUN_KILLS:
                how = "--resume" if step >= 0 else "--force"
                if self.kill_at(chance.uniform(0, seconds), "run", scene, "--out", "run", how, "--json", stdout=lines):
                    kills += 1
                    self.drop_torn_line(lines)
                    before, step = step, self.assert_readable("run")
                    self.assertGreaterEqual(step, before)
                    continue
                completed += 1
                self.assert_same_folder("whole", "run")
                step = -1  # replaces it by a new run
        if step >= 0:
            self.aspic("run", scene, "--out", "run", "--resume")
            self.assert_same_folder("whole", "run")
            completed += 1
        self.assertGreater(completed, 0)
        for line in (self.folder / "lines.json").read_text().splitlines():
            json.loads(line)

    def drop_torn_line(self, lines):
        lines.truncate(len(self.whole_lines(self.folder / "lines.json")))

    def test_killed_report_leaves_the_old_one(self):
        self.aspic("run", self.scene(), "--out", "run")
        page = self.folder / "run/report.html"
        whole, chance = page.read_bytes(), random.Random(2)
        seconds = self.duration_of("report", "run")
        for _ in range(OTHER_KILLS):
            self.kill_at(chance.uniform(0, seconds), "report", "run")
            self.assertEqual(page.read_bytes(), whole)


@unittest.skipUnless(shutil.which("chromium"), "chromium is missing")
class KilledRender(Crash):
    def test_pictures_are_whole(self):
        self.aspic("run", self.scene(duration=0.05), "--out", "run")
        command = ("render", "run", "-o", "frames", "--size", "80x60")
        seconds, chance = self.duration_of(*command), random.Random(4)
        whole = {p.name: p.read_bytes() for p in (self.folder / "frames").iterdir()}
        for _ in range(OTHER_KILLS // 2):
            shutil.rmtree(self.folder / "frames", ignore_errors=True)
            self.kill_at(chance.uniform(0.3, 1) * seconds, *command)
            for picture in (self.folder / "frames").glob("frame_*.png"):
                self.assertEqual(picture.read_bytes(), whole[picture.name])


class NoRoom(Crash):
    """Simulates a full disk by a limit of the file size."""

    def limited(self, size, *arguments):
        def limit():
            signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
            resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))

        return subprocess.run([ASPIC, *arguments], cwd=self.folder, capture_output=True, text=True, timeout=120,
                              preexec_fn=limit)

    def assert_refused(self, done, *names):
        self.assertEqual(done.returncode, 2, done.stdout + done.stderr)
        self.assertIn("File too large", done.stderr)
        self.assertTrue(any(name in done.stderr for name in names), done.stderr)

    def test_run_on_full_disk_resumes_with_room(self):
        scene = self.scene()
        self.aspic("run", scene, "--out", "whole")
        for size in (600, 3000, 8000, 15000):
            shutil.rmtree(self.folder / "run", ignore_errors=True)
            self.assert_refused(self.limited(size, "run", scene, "--out", "run"), "run/")
            step = self.assert_readable("run")
            self.aspic("run", scene, "--out", "run", "--resume" if step >= 0 else "--force")
            self.assert_same_folder("whole", "run")

    def test_earlier_results_survive_a_full_disk(self):
        self.aspic("run", self.scene(), "--out", "run")
        before = {p: p.read_bytes() for p in self.folder.rglob("*") if p.is_file()}
        self.assert_refused(self.limited(2000, "report", "run"), "report.html")
        self.assertEqual({p: p.read_bytes() for p in self.folder.rglob("*") if p.is_file()}, before)

    @unittest.skipUnless(os.path.exists("/dev/full"), "needs a device that is always full")
    def test_lost_json_lines_are_an_error(self):
        with open("/dev/full", "w") as full:
            done = subprocess.run([ASPIC, "run", self.scene(), "--json"], cwd=self.folder, stdout=full,
                                  stderr=subprocess.PIPE, text=True, timeout=60)
        self.assertEqual(done.returncode, 2)
        self.assertIn("standard output", done.stderr)


class ReadOnly(Crash):
    def without_rights(self, *arguments):
        """Runs as a user without write permission, because root can write everywhere."""
        def drop():
            if os.getuid() == 0:
                os.setgid(NOBODY)
                os.setuid(NOBODY)

        return subprocess.run([self.folder / "aspic", *arguments], cwd=self.folder, capture_output=True, text=True,
                              timeout=120, preexec_fn=drop)

    def test_read_only_folder_is_named_and_unchanged(self):
        scene = self.scene(duration=0.05)
        self.aspic("run", scene, "--out", "run")
        shutil.copy(ASPIC, self.folder / "aspic")  # a folder that every user can execute from, unlike root's home
        before = {p: p.read_bytes() for p in self.folder.rglob("*") if p.is_file()}
        for folder in (self.folder, self.folder / "run"):
            os.chmod(folder, 0o555)
            self.addCleanup(os.chmod, folder, 0o755)
        for arguments, name in ((("run", scene, "--out", "new"), "new"), (("run", scene, "--out", "run", "--force"), "run/"),
                                (("run", "run", "--resume"), "run/"), (("report", "run"), "report.html")):
            done = self.without_rights(*arguments)
            self.assertEqual(done.returncode, 2, f"{arguments}: {done.stdout}{done.stderr}")
            self.assertIn(name, done.stderr)
            self.assertRegex(done.stderr, "Permission denied|not permitted")
        self.assertEqual({p: p.read_bytes() for p in self.folder.rglob("*") if p.is_file()}, before)


class TimeLimit(Crash):
    def test_run_ends_between_steps_and_resumes(self):
        scene = self.scene(duration=1.0, cells="8, 2, 2")
        self.aspic("run", scene, "--out", "whole")
        for _ in range(3):
            how = ["--resume"] if (self.folder / "run").exists() else []
            done = subprocess.run([ASPIC, "run", scene, "--out", "run", "--time-limit", "0.15", *how], cwd=self.folder,
                                  capture_output=True, text=True, timeout=60)
            self.assertIn(done.returncode, (0, 4), done.stderr)
            if done.returncode == 0:
                break
            self.assertIn("--time-limit of 0.15 s", done.stdout)
            self.assertIn("aspic run run --resume", done.stdout)
            self.assertEqual(self.assert_readable("run"), len(self.steps("run")))
        self.aspic("run", scene, "--out", "run", "--resume")
        self.assert_same_folder("whole", "run")

    def test_step_beyond_the_time_limit_is_dropped(self):
        """Ten thousand iterations of gradient descent on a stiff beam: one step takes minutes."""
        scene = self.scene(duration=0.02, cells="24, 6, 6", extra="""[solver]
method = "gradient_descent"
preconditioner = "none"
tolerance = 1e-12
max_iterations = 1000000
""")
        begin = time.monotonic()
        out = self.aspic("run", scene, "--time-limit", "1", code=4).stdout
        self.assertLess(time.monotonic() - begin, 60)
        self.assertIn("stopped    0 of 2 steps", out)
        self.assertEqual(self.assert_readable("out/beam"), 0)


if __name__ == "__main__":
    unittest.main(verbosity=2)
