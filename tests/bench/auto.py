#!/usr/bin/env python3
"""Compares the linear solver that `auto` chooses with each solver alone: CPU time of the steps of 50 small scenes.

usage: tests/bench/auto.py [--runs N] [SCENE...]

Prints for each scene the ratio to the fastest solver, and the seconds of all."""
import argparse
import csv
import math
import os
import pathlib
import subprocess
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
ASPIC = os.environ.get("ASPIC", ROOT / "build/release/bin/aspic")
SOLVERS = ("auto", "cholesky", "multigrid", "block_jacobi")
HELD = "[[body.pin]]\nwhere = { box = { lower = [-1e-6, -99, -99], upper = [1e-6, 99, 99] } }\n"
FEET = "[[body.pin]]\nwhere = { lowest = 0.08 }\n"


def scene(body, h=1 / 60, steps=5, integrator="backward_euler"):
    return (f'gravity = [0, -9.81, 0]\n[time]\nstep = {h}\nduration = {h * steps}\nintegrator = "{integrator}"\n'
            f'[output]\nevery = 100\nvtu = false\n[solver]\ntolerance = 1e-4\nmesh_error = "off"\n[[body]]\n{body}')


def solid(geometry, young, poisson=.45, order=1, pin=HELD):
    return (f'{geometry}\nmaterial = {{ model = "neo_hookean", young = {young}, poisson = {poisson}, density = 1000 }}\n'
            f"order = {order}\n{pin}")


def box(size, cells, young=1e6, **rest):
    return solid(f"shape = {{ box = {{ upper = {[float(x) for x in size]}, cells = {cells} }} }}", young, **rest)


def sheet(size, thickness, bending="hinge"):
    return (f"shape = {{ rectangle = {{ width = 1, height = 1, size = {size} }} }}\n"
            f'shell = {{ thickness = {thickness}, bending = "{bending}" }}\n'
            'material = { model = "neo_hookean", young = 1e6, poisson = 0.3, density = 200 }\n'
            "[[body.pin]]\nwhere = { box = { lower = [-9, 0.499, -9], upper = [9, 9, 9] } }\n")


def checkers(young, contrast):
    return f'"{young} * exp({math.log(contrast)} * min(1, max(0, 0.5 + 20 * sin(25*x) * sin(25*y) * sin(25*z))))"'


def scenes():
    bunny = 'mesh = "bunny.mesh"'
    yield from ((f"tiny{n}_{E:g}", scene(box([4, 1, 1], [4 * n, n, n], E), steps=20)) for n in (2, 3, 4, 5) for E in (1e5, 1e7))
    yield from ((f"beam{n}_{E:g}", scene(box([4, 1, 1], [4 * n, n, n], E)))
                for n, E in ((7, 1e4), (7, 1e6), (7, 1e8), (10, 1e5), (10, 1e7), (14, 1e5), (14, 1e7)))
    yield from ((f"slender_{E:g}", scene(box([40, 1, 1], [160, 4, 4], E))) for E in (1e5, 1e7, 1e9))
    yield from ((f"rod_{E:g}", scene(box([200, 1, 1], [600, 3, 3], E))) for E in (1e6, 1e8))
    yield from ((f"chain_{E:g}", scene(box([400, 1, 1], [400, 1, 1], E), steps=10)) for E in (1e5, 1e7, 1e9))
    yield from ((f"flat{a}", scene(box([1, 1, 1 / a], [16, 16, 16]), steps=3)) for a in (30, 100, 1000))
    yield from ((f"needle{a}", scene(box([1, 1 / a, 1 / a], [12, 12, 12]), steps=3)) for a in (30, 100))
    yield from ((f"bunny_{nu}", scene(solid(bunny, 1e5, nu, pin=FEET))) for nu in (.45, .49, .495, .499))
    yield from ((f"bunny_{E:g}", scene(solid(bunny, E, pin=FEET))) for E in (1e4, 1e6, 1e8))
    yield from ((f"quadratic_{nu}", scene(solid(bunny, 1e5, nu, 2, FEET), steps=2)) for nu in (.45, .49))
    yield "quadratic_small", scene(box([2, 1, 1], [8, 3, 3], 1e5, poisson=.49, order=2), steps=5)
    yield "quadratic_box", scene(box([2, 1, 1], [12, 6, 6], 1e5, poisson=.499, order=2), steps=3)
    yield from ((f"checkers{c:g}_{E:g}", scene(box([1, 1, 1], [16, 16, 16], checkers(E, c)), steps=3))
                for c, E in ((1e2, 1e5), (1e4, 1e5), (1e4, 1e7)))
    yield from ((f"static{n}", scene(box([4, 1, 1], [4 * n, n, n]), .5, 2, "quasi_static")) for n in (6, 12))
    yield "static_slender", scene(box([40, 1, 1], [160, 4, 4], 1e9), .5, 2, "quasi_static")
    yield "free", scene(box([1, 1, 1], [20, 20, 20], 1e5, pin=""), steps=3)
    yield "cube", scene(box([1, 1, 1], [30, 30, 30]), steps=2)
    yield from ((f"plate_{E:g}", scene(box([4, 4, .2], [40, 40, 2], E), steps=4)) for E in (1e6, 1e9))
    yield from ((f"step_{h:g}", scene(box([4, 1, 1], [40, 10, 10], E), h)) for h, E in ((.005, 1e7), (.1, 1e6)))
    yield from ((f"sheet_{size}", scene(sheet(size, 1e-3))) for size in (.03, .0107))
    yield "sheet_thick", scene(sheet(.015, 1e-2))
    yield "sheet_mid_edge", scene(sheet(.025, 1e-3, "mid_edge"))


def seconds(file, solver, runs):
    """Least CPU time of the steps; infinite if they take longer than a minute or fail."""
    times = []
    for _ in range(runs):
        try:
            subprocess.run([ASPIC, "run", file, "--threads", "1", "--force", "--quiet", "--out", file.parent / "run",
                            "--set", f"solver.linear={solver}"], check=True, capture_output=True, timeout=60)
        except (subprocess.TimeoutExpired, subprocess.CalledProcessError):
            return math.inf
        with open(file.parent / "run/timings.csv", newline="") as rows:
            times.append(sum(float(row["cpu_seconds"]) for row in csv.DictReader(rows)))
    return min(times)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n", 1)[0])
    known = dict(scenes())
    parser.add_argument("scene", nargs="*", help=", ".join(known))
    parser.add_argument("--runs", type=int, default=1, help="runs of each, of which the fastest counts")
    arguments = parser.parse_args()
    if misspelt := set(arguments.scene) - set(known):
        parser.error(f"no scene {', '.join(misspelt)}")
    print(f"{'scene':18}{'ratio':>6}", *(f"{solver:>12}" for solver in SOLVERS))
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder) / "scene.toml"
        (file.parent / "bunny.mesh").write_bytes((ROOT / "scenes/bunny.mesh").read_bytes())
        for name in arguments.scene or known:
            file.write_text(known[name])
            times = [seconds(file, solver, arguments.runs) for solver in SOLVERS]
            print(f"{name:18}{times[0] / min(times[1:]):6.2f}", *(f"{time:12.3f}" for time in times), flush=True)


main()
