#!/usr/bin/env python3
"""Configures copies of the sources in two folders and compares the commands of their builds.

folder_names_test.py SOURCE CMAKE
"""
import json
import pathlib
import shutil
import subprocess
import sys
import tempfile

source, cmake = pathlib.Path(sys.argv[1]), sys.argv[2]
IGNORED = shutil.ignore_patterns(".git", "build", "out", "node_modules", "__pycache__")


def units(folder):
    """Returns the compiled files of a build in `folder` and the text of those that include others, without the folder's name."""
    shutil.copytree(source, folder / "aspic", ignore=IGNORED)
    build = folder / "aspic/build"
    subprocess.run([cmake, "-S", folder / "aspic", "-B", build, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release", "-DASPIC_TESTS=OFF",
                    "-DASPIC_BENCH=OFF", "-DASPIC_MESHER=OFF", "-DASPIC_VIEWER=OFF"], check=True, capture_output=True)
    plain = lambda text: text.replace(str(folder), "")
    files = [pathlib.Path(entry["file"]) for entry in json.loads((build / "compile_commands.json").read_text())]
    return {plain(str(f)): plain(f.read_text()) if "/Unity/" in str(f) else "" for f in files}


with tempfile.TemporaryDirectory(prefix="aspic_folders_") as top:
    plain = units(pathlib.Path(top) / "plain")
    named = units(pathlib.Path(top) / "distributed/contact/math/tet_terms")
assert len(plain) > 100, len(plain)
assert plain == named, f"these units differ: {sorted(plain.items() ^ named.items())[:3]}"
