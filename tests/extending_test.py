#!/usr/bin/env python3
"""Follows docs/extending.md: applies its files and edits to a copy of the sources, compiles them, and compares the added material,
energy, scene key and integrator with formulas of its own.

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

# The potential is compared with its formula, and the first step with the acceleration |w|^2 r of the center.
SCENE_CHECK = """
#include <cmath>
#include <cstdio>
#include "scene/scene.h"
using namespace aspic;
int main(int, char** argv) {
  Scene scene = load_scene(argv[1]);
  Simulation& s = scene.simulation;
  const StepReport report = s.step();
  const auto mass = s.model().mass->vertex_mass();
  double V = 0, all = 0, momentum = 0;
  for (size_t v = 0; v < mass.size(); ++v) {
    const double x = s.state().q[3 * v], y = s.state().q[3 * v + 1];
    V -= 0.5 * mass[v] * 4 * (x * x + y * y);
    all += mass[v], momentum += mass[v] * s.state().qdot[3 * v];
  }
  double reported = 0;
  const auto names = s.potential_names();
  for (size_t i = 0; i < names.size(); ++i)
    if (names[i] == "centrifugal") reported = report.potential[i];
  std::printf("potential %.12g, expected %.12g; velocity %g, expected 0.04\\n", reported, V, momentum / all);
  return is_success(report.status) && std::abs(reported / V - 1) < 1e-10 && std::abs(momentum / all / 0.04 - 1) < 0.01 ? 0 : 1;
}
"""
SCENE = """gravity = [0, 0, 0]
spin = [0, 0, 2]
time = { step = 0.01 }
[[body]]
shape = { box = { lower = [0.95, -0.05, -0.05], upper = [1.05, 0.05, 0.05], cells = [2, 2, 2] } }
"""

# The oscillator with w h = 0.1 is compared with the stability function of the scheme and with the row of the page.
INTEGRATOR_CHECK = """
#include <cmath>
#include <complex>
#include <cstdio>
#include <numbers>
#include "dynamics/integrator.h"
#include "reference/integrators.h"
using namespace aspic;
int main() {
  const verify::Oscillation row = verify::expected_oscillations().at("sdirk2"), found = verify::measured_oscillation("sdirk2");
  const double g = 1 - std::sqrt(0.5);
  const std::complex<double> z(0, 0.1), r = (1. + (1 - 2 * g) * z) / ((1. - g * z) * (1. - g * z));
  const double left = std::pow(std::norm(r), 2 * std::numbers::pi / 0.1), ratio = std::arg(r) / 0.1;
  std::printf("energy left %.9f, expected %.9f; frequency %.9f, expected %.9f\\n", found.energy_left, left, found.frequency_ratio, ratio);
  return std::abs(found.energy_left - left) < 1e-7 && std::abs(found.frequency_ratio - ratio) < 1e-6 &&
         std::abs(row.energy_left - left) < 6e-7 && std::abs(row.frequency_ratio - ratio) < 6e-6 &&
         verify::expected_oscillations().size() + 1 == integrator_names().size() ? 0 : 1;
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


def libraries(test):
    """Returns the libraries that a test of the build links; definitions of changed sources come before those of the libraries."""
    rules = (build / "build.ninja").read_text()
    at = re.search(rf"^build bin/{test}\b.*:", rules, re.M).end()
    return ["-Wl,-z,muldefs", *shlex.split(re.search(r"LINK_LIBRARIES = (.*)", rules[at:])[1])]


def run(command, **options):
    print("+", " ".join(str(word) for word in command)[-120:], flush=True)
    subprocess.run(command, check=True, timeout=600, **options)


def apply(page, copy):
    """Applies the page to the copy and returns the touched files."""
    touched = []
    for path, language, code in blocks(page):
        file = copy / path
        if not (source / path.split("/")[0]).exists():  # a package that was removed
            continue
        if (source / path).is_dir():
            first = next(line[1:] for line in code.splitlines() if not line.startswith("+"))
            path = next(str(f.relative_to(source)) for f in (source / path).glob("*.cpp") if first in f.read_text())
            file = copy / path
        if language == "diff":
            file.parent.mkdir(parents=True, exist_ok=True)
            text = (file if file.exists() else source / path).read_text()
            file.write_text(edited(text, code, path))
        else:
            assert not (source / path).exists(), f"{path} exists already; choose another name for the example"
            file.write_text(code)
        touched.append(path)
    for path in re.findall(r"`((?:src|apps|web|tests|docs)/[\w./]+)`", page):
        assert (copy / path).exists() or (source / path).exists(), f"{path} does not exist"
    assert len(touched) >= 12, touched
    return list(dict.fromkeys(touched))


def main():
    with tempfile.TemporaryDirectory() as folder:
        copy = pathlib.Path(folder)
        for name in ("src", "apps", "web"):
            shutil.copytree(source / name, copy / name, symlinks=True, ignore=shutil.ignore_patterns("node_modules", "dist"))
        touched = apply((source / "docs/extending.md").read_text(), copy)
        directory, flags = compiler_flags()
        # The copies of headers and sources come first.
        roots = [copy / "src", copy / "apps", copy / "tests", source / "tests", source / "inverse"]
        compiler, flags = flags[0], [*(f"-I{root}" for root in roots), "-O0", '-DASPIC_VERSION="0"', *flags[1:]]

        def program(name, main, sources, test, *arguments):
            sources = [copy / path for path in sources]
            if main:
                (copy / f"{name}.cpp").write_text(main)
                sources.insert(0, copy / f"{name}.cpp")
            run([compiler, *flags, "-o", str(copy / name), *map(str, sources), *(libraries(test) if test else [])], cwd=build)
            run([str(copy / name), *arguments])

        program("material_check", MATERIAL_CHECK, [], None)
        energy = "src/energy/centrifugal.cpp"
        program("energy_check", None, [energy, "src/energy/centrifugal_test.cpp"], "test_energy")
        (copy / "spin.toml").write_text(SCENE)
        edits = ["src/scene/schema_table.cpp", "src/scene/scene_builder.cpp"]
        program("scene_check", SCENE_CHECK, [energy, *edits], "test_scene", str(copy / "spin.toml"))
        edits = ["src/dynamics/integrator.cpp", "tests/reference/integrators.cpp"]
        program("integrator_check", INTEGRATOR_CHECK, edits, "test_dynamics")
        for path in touched:
            if path.startswith("inverse/"):
                run([compiler, *flags, "-fsyntax-only", str(copy / path)], cwd=directory)
        script = f"include({copy}/src/material/materials.cmake)\nif(NOT \"neo_hookean_simo NeoHookeanSimo\" IN_LIST materials)\nmessage(FATAL_ERROR \"not listed\")\nendif()\n"
        (copy / "list.cmake").write_text("cmake_minimum_required(VERSION 3.25)\n" + script)
        run(["cmake", "-P", str(copy / "list.cmake")])
        if node:
            (copy / "web/node_modules").symlink_to(source / "web/node_modules")
            run([node, str(source / "web/node_modules/typescript/bin/tsc"), "--noEmit", "--project", str(copy / "web")])
    print("docs/extending.md can be followed")


main()
