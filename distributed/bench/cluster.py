#!/usr/bin/env python3
"""Measures aspic-mpi on this machine and prints Markdown tables.

usage: cluster.py [iterations] [strong] [weak] [size] [serial] [--bin build/mpi/bin] [--cells N...] [--ranks N...] [--newton N] [--linear auto]

The beam is the box 0.4 x 0.1 x 0.1 m of 4n x n x n cells, clamped at x = 0: stable_neo_hookean, E = 1e7 Pa, nu = 0.45,
steps of 1/60 s, with GAMG unless --linear is given.
iterations: linear iterations of two Newton iterations, for the beam and for the beam twisted by 90 degrees
strong: one step of the same beam on several ranks; weak: of finer beams, with about as many vertices per rank
size: one step of large beams, with memory per vertex; serial: three steps against aspic run, at tolerance 1e-10
CPU times are those of all ranks, with the start and the time that ranks wait for each other (they poll).
"""
import argparse
import csv
import os
import pathlib
import resource
import struct
import subprocess
import sys
import tempfile
import time

SCENE = """[time]
step = {step}
duration = {duration}
[solver]
linear = "{linear}"
{solver}
[output]
vtu = false
[[body]]
name = "beam"
shape = {{ box = {{ upper = [0.4, 0.1, 0.1], cells = [{x}, {n}, {n}] }} }}
material = {{ model = "stable_neo_hookean", young = 1e7, poisson = 0.45 }}
{deform}
[[body.pin]]
where = "x < 1e-9"
"""
TWIST = "deform = { twist = { axis = [1, 0, 0], angle_deg = 90 } }"


def scene(options, folder, n, steps=1, solver="", deform=""):
    path = folder / "beam.toml"
    path.write_text(SCENE.format(step=1 / 60, duration=steps / 60, n=n, x=4 * n, linear=options.linear, solver=solver,
                                 deform=deform))
    return path


def run(options, ranks, path, out="run"):
    """Returns (steps, ranks, CPU time in s, wall time in s) of a run with aspic-mpi, or with aspic for 0 ranks."""
    launch = ["mpirun", "--oversubscribe", "-n", str(ranks), options.bin / "aspic-mpi"] if ranks else [options.bin / "aspic"]
    root = {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"} if os.geteuid() == 0 else {}
    threads = {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1", "OMPI_MCA_mpi_yield_when_idle": "1"}
    one = [] if ranks else ["--threads", "1"]
    before, begin = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime, time.monotonic()
    done = subprocess.run([*launch, "run", path, "--out", path.parent / out, "--force", "--allow-unconverged", *one],
                          env=os.environ | root | threads, capture_output=True, text=True)
    if done.returncode:
        sys.exit(done.stdout + done.stderr)
    tables = [list(csv.DictReader(open(path.parent / out / f"{name}.csv"))) if (path.parent / out / f"{name}.csv").exists()
              else [] for name in ("steps", "ranks")]
    return *tables, resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before, time.monotonic() - begin


def positions(checkpoint):
    """The positions of a checkpoint: its first array."""
    data, at = checkpoint.read_bytes(), 24
    integer = lambda p: struct.unpack_from("<Q", data, p)[0]
    at += 8 + integer(at)
    count, at = integer(at), at + 8
    for _ in range(count):
        at += 8 + integer(at) + 8
    arrays, at = integer(at), at + 8
    for _ in range(arrays):
        name, at = data[at + 8:at + 8 + integer(at)], at + 8 + integer(at)
        count, at = integer(at), at + 8
        if name == b"q":
            return struct.unpack_from(f"<{count}d", data, at)
        at += 8 * count
    sys.exit(f"{checkpoint}: no positions")


def total(rows, name):
    return sum(float(row[name]) for row in rows)


def row(*cells):
    print("| " + " | ".join(f"{c:.3g}" if isinstance(c, float) else f"{c:,}" if isinstance(c, int) else c for c in cells) + " |", flush=True)


def header(*cells):
    row(*cells)
    row(*["---"] * len(cells))


def iterations(options, folder):
    header("cells", *(f"{r} ranks" for r in options.ranks or [1, 4, 16, 64]))
    for n in options.cells or [6]:
        for name, deform in (("beam", ""), ("twisted", TWIST)):
            path = scene(options, folder, n, solver="max_iterations = 2", deform=deform)
            row(f"{name} {4 * n} x {n} x {n}",
                *(int(run(options, r, path)[1][0]["linear_iterations"]) for r in options.ranks or [1, 4, 16, 64]))


def one_step(options, ranks, path):
    steps, per_rank, *seconds = run(options, ranks, path)
    vertices = int(total(per_rank, "vertices"))
    memory = max(float(r["peak_bytes"]) for r in per_rank)
    row(ranks, vertices, int(total(steps[1:] or steps, "iterations")), int(per_rank[0]["linear_iterations"]), *seconds,
        memory / 1e6, (total(per_rank, "peak_bytes") - 45e6 * ranks) / vertices / 1e3)


STEP = ("ranks", "vertices", "Newton", "linear iterations", "CPU s", "wall s", "largest rank, MB", "KB per vertex beyond 45 MB")


def strong(options, folder):
    header(*STEP)
    for ranks in options.ranks or [1, 2, 4]:
        one_step(options, ranks, scene(options, folder, (options.cells or [14])[0]))


def weak(options, folder):
    header(*STEP)
    for ranks in options.ranks or [1, 2, 4]:
        one_step(options, ranks, scene(options, folder, round((options.cells or [10])[0] * ranks ** (1 / 3))))


def size(options, folder):
    header(*STEP)
    for n in options.cells or [35]:
        for ranks in options.ranks or [2]:
            one_step(options, ranks, scene(options, folder, n, solver=f"max_iterations = {options.newton}" if options.newton else ""))


def serial(options, folder):
    ranks_ = options.ranks or [1, 2, 4]
    header("n", "vertices", "aspic run: Newton", "CPU s", *(t for r in ranks_ for t in (f"{r} ranks: Newton", "CPU s")), "largest distance, m")
    for n in options.cells or [7, 14]:
        path = scene(options, folder, n, steps=3, solver="tolerance = 1e-10")
        steps, _, seconds, _ = run(options, 0, path, "serial")
        cells, far = [int(total(steps, "iterations")), seconds], 0.0
        own = positions(folder / "serial/checkpoint.bin")
        for ranks in ranks_:
            steps, _, seconds, _ = run(options, ranks, path)
            cells += [int(total(steps, "iterations")), seconds]
            far = max(far, max(abs(a - b) for a, b in zip(own, positions(folder / "run/checkpoint.bin"))))
        row(n, len(own) // 3, *cells, far)


def main():
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    kinds = {f.__name__: f for f in (iterations, strong, weak, size, serial)}
    arguments.add_argument("kind", nargs="*", metavar="KIND", help="; ".join(kinds) + "; all without one")
    arguments.add_argument("--bin", type=pathlib.Path, default=pathlib.Path("build/mpi/bin"))
    arguments.add_argument("--cells", type=int, nargs="+")
    arguments.add_argument("--ranks", type=int, nargs="+")
    arguments.add_argument("--newton", type=int, help="limit of Newton iterations for size")
    arguments.add_argument("--linear", default="multigrid", help="solver.linear of the scenes (default: %(default)s)")
    options = arguments.parse_args()
    if other := set(options.kind) - set(kinds):
        arguments.error(f"unknown: {', '.join(other)}; there are {', '.join(kinds)}")
    for kind in options.kind or kinds:
        print(f"\n{kind}\n")
        with tempfile.TemporaryDirectory() as folder:
            kinds[kind](options, pathlib.Path(folder))


if __name__ == "__main__":
    main()
