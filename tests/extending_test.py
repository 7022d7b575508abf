#!/usr/bin/env python3
"""Follows docs/extending.md: applies its files and edits to a copy of the sources, compiles them, runs its tests.

extending_test.py SOURCE BUILD [NODE]
"""
import json
import pathlib
import re
import shlex
import shutil
import subprocess
import sys
import tempfile

source, build = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
node = sys.argv[3] if len(sys.argv) > 3 else ""

MATERIAL_CHECK = """
#include <cstdio>
#include "material/neo_hookean_simo.h"
#include "material/list.h"
using namespace aspic;
static_assert(RegisteredMaterial<NeoHookeanSimo>);
int main() {
  const std::array<long double, 3> l = {1.1L, 0.9L, 1.05L};
  const Lame lame{40, 60};
  const double nu = 60. / (2 * (60 + 40)), E = 2 * 40 * (1 + nu);
  Mat3d F{};
  for (int i = 0; i < 3; ++i) F(i, i) = double(l[i]);
  const double psi = NeoHookeanSimo::psi(F, NeoHookeanSimo::params(MaterialParameters{lame, {}}));
  const double expected = double(NeoHookeanSimo::reference_energy(PrincipalStretches(l), {E, nu}));
  std::printf("psi %.15g, reference %.15g\\n", psi, expected);
  return std::abs(psi - expected) < 1e-12 * expected ? 0 : 1;
}
"""


def blocks(page):
    """Yields (path, language, code) of each code block. A block without a name belongs to the previous file."""
    path = None
    for line in re.finditer(r"^`([\w./]+)`[^\n]*?:?$|^```(\w+)\n(.*?)^```$", page, re.M | re.S):
        if line[1]:
            path = line[1]
        elif line[2] in ("cpp", "ts", "diff"):
            assert path, f"a block without a file: {line[3][:60]}"
            yield path, line[2], line[3]


def edited(text, diff, path):
    lines = diff.splitlines()
    old = "".join(line[1:] + "\n" for line in lines if not line.startswith("+"))
    new = "".join(line[1:] + "\n" for line in lines if not line.startswith("-"))
    assert text.count(old) == 1, f"{path}: the context of this edit occurs {text.count(old)} times:\n{diff}"
    return text.replace(old, new)


def compiler_flags():
    """Returns the compiler with the flags of a test of the build, without input and output."""
    for entry in json.loads((build / "compile_commands.json").read_text()):
        if "test_lessons.dir" in entry.get("output", entry["command"]):
            words = shlex.split(entry["command"])
            words = words[words.index(next(w for w in words if re.search(r"(\+\+|clang)[-\w.]*$", w))):]
            drop = {words.index("-c"), words.index("-c") + 1, words.index("-o"), words.index("-o") + 1}
            flags = [w for i, w in enumerate(words) if i not in drop and not re.match(r"-O|-Winvalid-pch|-include", w)]
            return [str(pathlib.Path(entry["directory"])), flags]
    sys.exit("the build has no compile command of test_lessons")


def libraries():
    """Returns the libraries that test_energy links."""
    rules = (build / "build.ninja").read_text()
    at = re.search(r"^build bin/test_energy\b.*:", rules, re.M).end()
    return shlex.split(re.search(r"LINK_LIBRARIES = (.*)", rules[at:])[1])


def run(command, **options):
    print("+", " ".join(str(word) for word in command)[-120:], flush=True)
    subprocess.run(command, check=True, timeout=600, **options)


def main():
    with tempfile.TemporaryDirectory() as folder:
        copy = pathlib.Path(folder)
        for name in ("src", "apps", "web"):
            shutil.copytree(source / name, copy / name, symlinks=True, ignore=shutil.ignore_patterns("node_modules", "dist"))
        touched = []
        for path, language, code in blocks((source / "docs/extending.md").read_text()):
            file = copy / path
            if language == "diff":
                file.write_text(edited(file.read_text(), code, path))
            else:
                assert not file.exists(), f"{path} exists already; choose another name for the example"
                file.write_text(code)
            touched.append(path)
        assert len(touched) >= 13, touched

        directory, flags = compiler_flags()
        # The copies of headers and sources come first.
        compiler, flags = flags[0], [f"-I{copy / 'src'}", f"-I{copy / 'apps'}", "-O0", '-DASPIC_VERSION="0"', *flags[1:]]
        (copy / "material_check.cpp").write_text(MATERIAL_CHECK)

        def program(name, sources, link):
            run([compiler, *flags, "-o", str(copy / name), *map(str, sources), *link], cwd=build)
            run([str(copy / name)])

        program("material_check", [copy / "material_check.cpp"], [])
        program("energy_check", [copy / f"src/energy/centrifugal{end}.cpp" for end in ("", "_test")], libraries())
        for path in dict.fromkeys(touched):
            if path.endswith(".cpp") and "centrifugal" not in path:
                run([compiler, *flags, "-fsyntax-only", str(copy / path)], cwd=directory)
        script = f"include({copy}/src/material/materials.cmake)\nif(NOT \"neo_hookean_simo NeoHookeanSimo\" IN_LIST materials)\nmessage(FATAL_ERROR \"not listed\")\nendif()\n"
        (copy / "list.cmake").write_text("cmake_minimum_required(VERSION 3.25)\n" + script)
        run(["cmake", "-P", str(copy / "list.cmake")])
        if node:
            (copy / "web/node_modules").symlink_to(source / "web/node_modules")
            run([node, str(source / "web/node_modules/typescript/bin/tsc"), "--noEmit", "--project", str(copy / "web")])
    print("docs/extending.md can be followed")


main()
