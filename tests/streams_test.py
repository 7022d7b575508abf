#!/usr/bin/env python3
"""Every command with standard streams that are full, closed, or pipes without a reader.

usage: ASPIC=path/to/aspic streams_test.py
"""
import os
import pathlib
import re
import shutil
import signal
import subprocess
import tempfile
import unittest

ASPIC = os.environ["ASPIC"]
CUBE = """[time]
step = 0.01
duration = 0.02
[[body]]
name = "cube"
shape = { box = { upper = [0.1, 0.1, 0.1], cells = [1, 1, 1] } }
material = { young = 1e5, poisson = 0.3, density = 1000 }
"""
TET = """MeshVersionFormatted 2\nDimension 3\nVertices\n4\n0 0 0 0\n1 0 0 0\n0 1 0 0\n0 0 1 0
Tetrahedra\n1\n1 2 3 4 0\nEnd\n"""
# A quick use of each command that prints a result, and one that fails.
USES = {
    "run": (["cube.toml", "--out", "run", "--force"], ["none.toml"]),
    "check": (["tet.mesh"], ["none.mesh"]),
    "mesh": (["--help"], ["none.obj", "-o", "none.mesh"]),
    "convert": (["tet.mesh", "copy.msh"], ["none.mesh", "copy.msh"]),
    "fit": (["--help"], ["none"]),
    "compare": (["cube.toml", "--methods", "newton,gradient_descent", "--out", "methods"], ["none.toml"]),
    "materials": (["--json"], ["none"]),
    "fit-motion": (["--help"], ["none.toml", "none.csv", "--fit", "young"]),
    "fit-jobs": (["--help"], ["none"]),
    "minimize": (["rosenbrock"], ["none"]),
    "capture": (["--help"], ["none.toml"]),
    "modes": (["cube.toml", "--out", "modes", "--force"], ["none.toml"]),
    "lecture": ([], ["999"]),
    "gallery": ([], ["none"]),
    "schema": ([], ["none"]),
    "verify": (["--list"], ["none"]),
    "view": (["--help"], ["none.toml"]),
    "report": (["--help"], ["none"]),
    "completion": (["bash"], ["none"]),
    "sweep": (["--help"], ["none.toml", "-o", "study"]),
    "render": (["--help"], ["none", "-o", "none.png"]),
}
DOCUMENTED = {0, 1, 2, 3, 4, 130, 141, 143}


class Streams(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(tempfile.mkdtemp(prefix="aspic_streams_"))
        cls.addClassCleanup(shutil.rmtree, cls.folder)
        for name, text in (("cube.toml", CUBE), ("tet.mesh", TET)):
            (cls.folder / name).write_text(text)
        help_text = cls.aspic("--help").stdout.decode()
        cls.expected = {}  # results with ordinary streams
        for command in re.findall(r"(?m)^  ([a-z-]+) {2,}", help_text.split("Subcommands:")[1].split("Examples:")[0]):
            if command == "mesh" and not pathlib.Path(ASPIC).with_name("aspic-mesh").exists():
                continue
            for use in USES[command]:
                cls.expected[command, *use] = cls.aspic(command, *use)

    @classmethod
    def aspic(cls, *arguments, prefix="", **streams):
        """`prefix`: redirections of a shell that then executes the program."""
        command = ["sh", "-c", f'exec "$0" "$@" {prefix}', ASPIC, *arguments]
        streams = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, **streams}
        return subprocess.run(command, cwd=cls.folder, timeout=60, **streams)

    def test_lost_messages_change_no_exit_code(self):
        for arguments, expected in self.expected.items():
            self.assertIn(expected.returncode, DOCUMENTED, arguments)
            for prefix in ("2> /dev/full", "2>&- <&-"):
                done = self.aspic(*arguments, prefix=prefix)
                self.assertEqual(done.returncode, expected.returncode, (arguments, prefix))

    def test_lost_results_are_bad_input(self):
        for arguments, expected in self.expected.items():
            is_lost = expected.stdout and arguments[0] != "mesh"  # aspic-mesh is a program of its own
            code = 2 if is_lost and expected.returncode in (0, 3) else expected.returncode
            for prefix in ("> /dev/full", ">&-"):
                done = self.aspic(*arguments, prefix=prefix)
                self.assertEqual(done.returncode, code, (arguments, prefix, done.stderr))
                if is_lost:
                    self.assertIn(b"standard output: cannot be written", done.stderr, arguments)

    def test_no_stream_at_all_is_no_crash(self):
        for arguments in self.expected:
            for prefix in ("> /dev/full 2>&1", "<&- >&- 2>&-"):
                self.assertIn(self.aspic(*arguments, prefix=prefix).returncode, DOCUMENTED, (arguments, prefix))

    def test_pipes_without_a_reader_end_quietly(self):
        for arguments in self.expected:
            read, write = os.pipe()
            os.close(read)
            done = self.aspic(*arguments, stdout=write)
            os.close(write)
            self.assertIn(done.returncode, DOCUMENTED | {-signal.SIGPIPE}, arguments)
            self.assertNotIn(b"internal error", done.stderr)

    def test_run_completes_without_a_reader(self):
        for prefix in ("> /dev/full", ">&- 2>&-"):
            self.aspic("run", "cube.toml", "--out", "unread", "--force", prefix=prefix)
            self.assertEqual(len((self.folder / "unread/steps.csv").read_text().splitlines()), 4)  # names, the start, two steps
            self.assertNotIn("warning", (self.folder / "unread/steps.csv").read_text())

    def test_run_ends_with_checkpoint_after_reader_exits(self):
        (self.folder / "long.toml").write_text(CUBE.replace("duration = 0.02", "duration = 1000"))
        process = subprocess.Popen([ASPIC, "run", "long.toml", "--json"], cwd=self.folder, stdout=subprocess.PIPE,
                                   stderr=subprocess.PIPE)
        process.stdout.readline()
        process.stdout.close()
        messages = process.stderr.read()
        process.stderr.close()
        self.assertEqual(process.wait(timeout=60), 141, messages)
        done = self.aspic("run", "long.toml", "--resume", "--steps", "1", "--quiet")
        self.assertEqual(done.returncode, 0, done.stderr)


if __name__ == "__main__":
    unittest.main(verbosity=2)
