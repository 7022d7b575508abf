#!/usr/bin/env python3
"""Follows docs/tutorial.md in an empty folder: saves its files, runs its commands, and compares what they print with its numbers.

With ASPIC_TUTORIAL=FOLDER, the results stay there, for tools/pictures.
"""
import os
import pathlib
import re
import shlex
import shutil
import subprocess
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent
ASPIC = pathlib.Path(os.environ["ASPIC"])
PACKAGE = ASPIC.parents[1] / "python"
NUMBER = r"-?\d+(?:\.\d+)?(?:e-?\d+)?"


def command_of(line):
    """The command of a line of the page, with the program of this build; None if this build cannot run it."""
    words = shlex.split(line)
    if words[:2] == ["./run", "python"]:
        return ["/usr/bin/python3", *words[2:]] if (PACKAGE / "aspic").exists() else None
    if words[:2] == ["./run", "render"] and not shutil.which("chromium"):
        return None
    if words[:2] == ["./run", "mesh"] and not ASPIC.with_name("aspic-mesh").exists():
        raise unittest.SkipTest("needs aspic-mesh")
    return [str(ASPIC), *words[1:]] if words[0] == "./run" else words


def save_files(section, folder):
    """Writes every fenced block under the last name in backticks before it that follows 'save ... as'."""
    for name, text in re.findall(r"[Ss]ave (?:this )?as `([^`]+)`:\n\n```\w+\n(.*?)```", section, re.S):
        (folder / name).write_text(text)


def run_commands(section, folder):
    """All that the commands of a section print; each must end with exit code 0."""
    printed = ""
    for line in re.findall(r"^    ((?:\./run|python3) .*)", re.sub(r"```.*?```", "", section, flags=re.S), re.M):
        if command := command_of(line):
            result = subprocess.run(command, cwd=folder, capture_output=True, text=True,
                                    env={**os.environ, "PYTHONPATH": str(PACKAGE), "MPLBACKEND": "Agg"})
            if result.returncode:
                raise AssertionError(f"{line}\n{result.stdout}{result.stderr}")
            printed += result.stdout
    return printed


class Tutorial(unittest.TestCase):
    def test_numbers_of_the_page_are_printed(self):
        folder = pathlib.Path(os.environ.get("ASPIC_TUTORIAL") or self.enterContext(tempfile.TemporaryDirectory()))
        (folder / "out").mkdir()
        shutil.copytree(ROOT / "scenes", folder / "scenes")
        checks = 0
        for section in (ROOT / "docs/tutorial.md").read_text().split("\n## "):
            save_files(section, folder)
            printed = run_commands(section, folder)
            found = {}
            for label, value, tolerance in re.findall(rf"`([^`]+)`\s({NUMBER}) ± ({NUMBER})", section):
                if label not in found:
                    found[label] = iter(re.findall(rf"^\s*{re.escape(label)}:?\s+({NUMBER})", printed, re.M))
                if label == "imbalance" and not (PACKAGE / "aspic").exists():
                    continue
                with self.subTest(section=section.splitlines()[0], label=label):
                    self.assertAlmostEqual(float(next(found[label])), float(value), delta=float(tolerance))
                checks += 1
        self.assertGreaterEqual(checks, 6)


if __name__ == "__main__":
    unittest.main()
