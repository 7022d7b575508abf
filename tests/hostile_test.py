#!/usr/bin/env python3
"""Invalid command lines: each ends soon, with a documented exit code and a readable message.

usage: ASPIC=path/to/aspic hostile_test.py [TestCase...]; with COUNT=1000 SEED=7, another thousand random lines
"""
import os
import pathlib
import random
import re
import resource
import shutil
import subprocess
import tempfile
import unittest

ASPIC = os.environ["ASPIC"]
FITS = [["fit"], ["capture"]] if pathlib.Path(ASPIC).with_name("aspic-fit").exists() else []
NOBODY = 65534
CUBE = """[time]
step = 0.01
duration = 0.02
[[body]]
name = "cube"
shape = { box = { upper = [0.1, 0.1, 0.1], cells = [1, 1, 1] } }
material = { young = 1e5, poisson = 0.3, density = 1000 }
"""
MESH = "MeshVersionFormatted 2\nDimension 3\nVertices\n4\n0 0 0 0\n{0} 0 0 0\n0 {0} 0 0\n0 0 {0} 0\n" \
       "Tetrahedra\n1\n1 2 3 4 0\nEnd\n"
LONG = "a" * 300
FILES = ["cube.toml", "tet.mesh", "big.mesh", "empty.mesh", "empty.toml", "zeros.obj", "none.mesh", "none.toml", ".", "..",
         "", "-", "--", LONG, LONG + ".toml", LONG + ".mesh", "loop", "loop/x.toml", "loop.mesh", "tet.mesh/x.mesh",
         "closed", "closed/x.mesh", "closed/x.toml", "/dev/null", "/dev/full", "/dev/zero", "/proc/self/mem", "new\nline.toml",
         "\x1b[31mred.mesh", "nul.toml", "./cube.toml", "a" * 5000, "run", "run/steps.csv", "$(reboot)", "; ls", "%s%n.toml",
         "{}.toml", "{0:n}.mesh"]
VALUES = ["nan", "-nan", "inf", "-inf", "", " ", "0", "-1", "1e400", "1e-400", "0x10", "1,5", "99999999999999999999",
          "-2147483648", "1e9", "true", "a=b", "=", "material.young=nan", "time.step=0", "time.duration=-1", "a.b.c=1",
          "body.0.x=[[[[", "sphere:nan", "1:1:1", "{}", "%s", LONG]


class Hostile(unittest.TestCase):
    def setUp(self):
        self.parent = pathlib.Path(tempfile.mkdtemp(prefix="aspic_hostile_"))
        self.parent.chmod(0o755)
        self.folder = self.parent / "work"  # so that ".." is harmless, too
        self.folder.mkdir()
        self.addCleanup(self.remove)
        for name, text in (("cube.toml", CUBE), ("tet.mesh", MESH.format(1)), ("big.mesh", MESH.format("1e130")),
                           ("empty.mesh", ""), ("empty.toml", ""), ("zeros.obj", "\0" * 5000), ("nul.toml", "a = \0")):
            (self.folder / name).write_text(text)
        for name in ("loop", "loop.mesh"):
            (self.folder / name).symlink_to(name)
        (self.folder / "closed").mkdir(mode=0)

    def remove(self):
        (self.folder / "closed").chmod(0o755)
        shutil.rmtree(self.parent)

    def open_to_all(self):
        """Copies the programs to a folder that every user can execute from, unlike root's home."""
        program = self.parent / "aspic"
        if not program.exists():
            for name in ("aspic", "aspic-fit") if FITS else ("aspic",):
                shutil.copy(pathlib.Path(ASPIC).with_name(name), self.parent)
        return program

    def aspic(self, *arguments, code=None, user=0, memory=0):
        """Runs as a user without rights and with a limit of address space [bytes], if given."""
        def limit():
            if memory:
                resource.setrlimit(resource.RLIMIT_AS, (memory, memory))
            if user and os.getuid() == 0:
                os.setgroups([])
                os.setgid(user)
                os.setuid(user)
        done = subprocess.run([self.open_to_all() if user else ASPIC, *arguments], cwd=self.folder, capture_output=True, timeout=60, preexec_fn=limit,
                              stdin=subprocess.DEVNULL)
        text = f"aspic {arguments}: {done.returncode}\n{done.stdout[-2000:]}\n{done.stderr[-2000:]}"
        self.assertIn(done.returncode, {0, 1, 2, 3, 4} if code is None else {code}, text)
        self.assertNotIn(b"internal error", done.stderr, text)
        self.assertNotIn(b"\x1b[31m", done.stderr, text)
        if done.returncode == 2:
            self.assertTrue(done.stderr or done.stdout, text)
        return done.stderr.decode(errors="replace")


class Names(Hostile):
    def test_too_long_looping_and_missing_names_are_refused(self):
        for command in (["run"], ["check"], ["view", "--no-browser"], ["report"], *FITS,
                        ["compare", "--methods", "newton"], ["render", "-o", "a.png", "--step", "1"]):
            for name in (LONG, "loop", "loop/x", LONG + "/x", "tet.mesh/x"):
                message = self.aspic(*command, name, code=2)
                self.assertRegex(message, re.escape(name[:20]))

    def test_output_names_are_refused(self):
        for name in (LONG, "loop", "loop/x", LONG + "/x", "tet.mesh/x", "/proc/x"):
            self.assertIn(name[:20], self.aspic("run", "cube.toml", "--out", name, code=2))
            self.assertIn(name[:20], self.aspic("convert", "tet.mesh", name + "/x.msh", code=2))


class Rights(Hostile):
    def test_a_folder_without_rights_is_named(self):
        for command in (["run"], ["check"], ["view", "--no-browser"], ["report"], *FITS):
            for name in ("closed", "closed/x", "closed/x.toml"):
                if FITS or command != ["check"] or name != "closed":  # a folder is a data set, which aspic-fit checks
                    self.assertIn("closed", self.aspic(*command, name, code=2, user=NOBODY))
        for out in ("closed", "closed/out", "out"):
            self.assertIn(out, self.aspic("run", "cube.toml", "--out", out, code=2, user=NOBODY))


class Limits(Hostile):
    def test_number_of_threads_respects_memory_limit(self):
        self.aspic("run", "cube.toml", "--threads", "1024", "--out", "few", code=0, memory=3 << 30)
        self.aspic("run", "cube.toml", "--threads", "1", "--out", "one", code=0)
        self.assertEqual((self.folder / "few/steps.csv").read_bytes(), (self.folder / "one/steps.csv").read_bytes())

    def test_a_mesh_beyond_the_memory_is_refused(self):
        with open(self.folder / "large.mesh", "w") as file:
            file.write("MeshVersionFormatted 2\n" + "# a comment of forty characters and more\n" * 3_000_000)
        message = self.aspic("check", "large.mesh", code=2, memory=160 << 20)
        self.assertIn("bytes of memory are free", message)

    def test_coordinates_that_overflow_are_refused(self):
        self.aspic("check", "big.mesh", code=2)
        (self.folder / "big.toml").write_text(CUBE.replace("[0.1, 0.1, 0.1]", "[1e140, 1e140, 1e140]"))
        self.assertIn("choose a larger unit", self.aspic("run", "big.toml", code=2))
        self.aspic("run", "big.mesh", "--steps", "1", code=0)  # a bare mesh is scaled


class Numbers(Hostile):
    def test_invalid_numbers_are_refused_everywhere(self):
        script = subprocess.run([ASPIC, "completion", "man"], capture_output=True, text=True).stdout
        self.assertIn("time\\-limit", script)
        for command in (["run", "cube.toml", "--time-limit"], ["render", "run", "-o", "a.mp4", "--fps"],
                        ["check", "cube.toml", "--derivatives", "--tolerance"]):
            for value in ("nan", "-nan", "NaN", "inf", "", "1e999"):
                self.assertIn(command[-1], self.aspic(*command, value, code=2))


class Random(Hostile):
    def test_random_lines_end_with_a_message(self):
        help_text = subprocess.run([ASPIC, "completion", "bash"], capture_output=True, text=True).stdout
        options = {name: words.split() for name, words in re.findall(r"(?m)^    ([a-z-]+)\) options='(.*)' ;;", help_text)}
        self.assertGreater(len(options), 10)
        chance = random.Random(int(os.environ.get("SEED", "1")))
        for _ in range(int(os.environ.get("COUNT", "60"))):
            command = chance.choice(sorted(options))
            if command in ("mesh", "view", "lecture", "verify"):  # another program; no end; long
                command = "run"
            line = [command] if chance.random() < 0.97 else []
            line += chance.sample(FILES, chance.choice([0, 1, 1, 1, 2]))
            for _ in range(chance.choice([0, 1, 1, 2, 3])):
                option = chance.choice(options[command] or ["--help"])
                line += [option] + ([chance.choice(VALUES + FILES)] if chance.random() < 0.8 else [])
            with self.subTest(line=line):
                self.aspic(*line)


if __name__ == "__main__":
    unittest.main(verbosity=2)
