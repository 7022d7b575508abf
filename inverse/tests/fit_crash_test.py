#!/usr/bin/env python3
"""Fits and synthetic measurements that are killed, interrupted or out of disk space: files stay whole, and resuming
gives the same bits.

usage: ASPIC=path/to/aspic fit_crash_test.py [TestCase...]
"""
import filecmp
import os
import random
import shutil
import unittest

from command_line import ASPIC, BENCH, CUBE
from crash_test import Crash, NoRoom, OTHER_KILLS, ReadOnly
from fit_test import QUICK, FitCommand
from signals_test import Signals


class KilledCapture(Crash):
    def test_killed_capture_leaves_whole_files(self):
        self.write("cube.toml", CUBE)
        command = ("capture", "cube.toml", *BENCH)
        seconds, chance = self.duration_of(*command, "-o", "whole"), random.Random(3)
        self.aspic(*command, "-o", "other", "--seed", "2")
        shutil.copytree(self.folder / "other", self.folder / "data")
        for kill in range(OTHER_KILLS):
            # The cases take most of the time; the files are written at the end.
            self.kill_at(chance.uniform(0.5, 1.1) * seconds, *command, "-o", "data", "--force")
            if (self.folder / "data/capture.toml").exists():
                files = {p.name for p in (self.folder / "data").iterdir() if p.is_file()}
                same = [name for name in ("whole", "other")
                        if all(filecmp.cmp(self.folder / name / f, self.folder / "data" / f, shallow=False)
                               for f in files if not f.startswith(".aspic"))]
                self.assertTrue(same, f"kill {kill}: files of two data sets")
        self.aspic(*command, "-o", "data", "--force")
        self.assert_same_folder("whole", "data")


class KilledFit(FitCommand, Crash):
    def test_killed_fit_resumes_to_equal_bits(self):
        options = ("fit", "layers", *QUICK, "-q")
        seconds, chance = self.duration_of(*options, "-o", "whole.vtu"), random.Random(5)
        kills, completed = 0, 0
        part = self.folder / "part.fit"
        while kills < OTHER_KILLS or not completed:
            # Every second completed fit is replaced by a new one.
            is_unfinished = (part / "options.toml").exists() and any(part.glob("*.journal"))
            how = "--resume" if is_unfinished else "--force"
            limit = chance.uniform(0, seconds) if kills < OTHER_KILLS else 300
            if not self.kill_at(limit, *options, "-o", "part.vtu", how):
                self.assertEqual(self.bytes_of("part.vtu"), self.bytes_of("whole.vtu"))
                completed += 1
                if completed % 2:
                    shutil.rmtree(part)
                    (self.folder / "part.vtu").unlink()
                continue
            kills += 1
            for table in part.glob("*.csv"):
                self.assert_whole_table(table)


class CaptureSignals(Crash):
    CODES, signalled = Signals.CODES, Signals.signalled

    def test_capture_writes_finished_cases(self):
        self.write("cube.toml", CUBE)
        for with_signal, code in self.CODES.items():
            got, said = self.signalled(with_signal, "2 of", "capture", "cube.toml", "-o", "data", "--pokes", "20",
                                       "--depths", "4", "--markers", "20", "--tip", "disc:0.02", "--force",
                                       stream="stdout")
            self.assertEqual(got, code, said)
            self.assertIn("the finished cases", said)
            self.assertNotIn("error:", self.aspic("check", "data").stdout)


class CaptureWithoutRoom(Crash):
    limited, assert_refused = NoRoom.limited, NoRoom.assert_refused

    def test_earlier_data_survive_a_full_disk(self):
        self.write("cube.toml", CUBE)
        self.aspic("capture", "cube.toml", "-o", "data", *BENCH)
        before = {p: p.read_bytes() for p in self.folder.rglob("*") if p.is_file()}
        self.assert_refused(self.limited(500, "capture", "cube.toml", "-o", "data", *BENCH, "--seed", "2", "--force"), "data")
        self.assertEqual({p: p.read_bytes() for p in self.folder.rglob("*") if p.is_file()}, before)


class CaptureReadOnly(Crash):
    without_rights = ReadOnly.without_rights

    def test_read_only_folder_is_named(self):
        self.write("cube.toml", CUBE)
        shutil.copy(ASPIC, self.folder / "aspic")
        shutil.copy(ASPIC + "-fit", self.folder / "aspic-fit")
        os.chmod(self.folder, 0o555)
        self.addCleanup(os.chmod, self.folder, 0o755)
        done = self.without_rights("capture", "cube.toml", "-o", "data", *BENCH)
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertIn("data", done.stderr)


if __name__ == "__main__":
    unittest.main(verbosity=2)
