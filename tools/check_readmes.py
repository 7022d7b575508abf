#!/usr/bin/env python3
"""Fails if the README of a folder of code names a file that does not exist.

Lowercase names in backticks are files: of the folder, with or without their ending, or paths from the top; `*` is any
text. Functions end with ().
"""
import fnmatch
import pathlib
import re
import subprocess
import sys

CODE = ("apps/", "bench/", "distributed/", "inverse/", "src/", "verification/", "web/")
OTHERS = {"double", "newton_cg", "residual_threshold"}  # a type, a method, a column
WRITTEN = {"body*.mesh", "capture.toml", "obstacle*.obj", "parameters.json", "scene.toml", "steps.csv"}  # by users or programs
TARGETS = r"\w*aspic\w*|bench_\w+"

root = pathlib.Path(__file__).resolve().parent.parent
tracked = [pathlib.PurePosixPath(p) for p in subprocess.check_output(["git", "ls-files"], cwd=root, text=True).split()]
folders = {folder for path in tracked for folder in path.parents}


def names_in(folder):
    """Names by which a README may call files and folders: paths from the top, modules, and what is below the folder."""
    names = {str(path) for path in folders.union(tracked)} | {path.name for path in folders}
    for path in tracked:
        if folder in path.parents:
            inside = path.relative_to(folder)
            names |= {str(inside), str(inside.with_suffix("")), path.name, path.name.split(".")[0]}
            names |= {str(part) for part in inside.parents}
    return names


def faults():
    for readme in tracked:
        if readme.name != "README.md" or not str(readme).startswith(CODE):
            continue
        known = names_in(readme.parent)
        for number, line in enumerate((root / readme).read_text().split("\n"), 1):
            for name in re.findall(r"`([a-z0-9_*./]+)`", line):
                if name in OTHERS | WRITTEN or re.fullmatch(TARGETS, name) or fnmatch.filter(known, name.rstrip("/")):
                    continue
                yield f"{readme}:{number}: `{name}` is no file; correct the name, or write `{name}()` for a function"


found = list(faults())
print("\n".join(found) or "READMEs: all files exist")
sys.exit(1 if found else 0)
