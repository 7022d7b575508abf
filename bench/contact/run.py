#!/usr/bin/env python3
"""Runs the scenes of contact and prints the cost of their steps.

usage: bench/contact/run.py [SCENE...] [--steps N] [--threads N] [--csv FILE] [--write-only] [--refine]

SCENE: chute knives funnel rollers twist boxes; all by default. --refine: the chute from 1 000 to 30 000 vertices, and the exponent of
the growth of its cost. Wall times per step are those of the program, CPU time is that of the whole process."""
import argparse
import csv
import math
import os
import pathlib
import resource
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).parent))
import scenes  # noqa: E402

ROOT = pathlib.Path(__file__).resolve().parents[2]
ASPIC = os.environ.get("ASPIC", ROOT / "build/release/bin/aspic")


def column(rows, key):
    return [float(row[key]) for row in rows]


def measure(name, problem, arguments):
    folder = pathlib.Path(arguments.out) / name
    problem.write(folder)
    if arguments.write_only:
        return None
    steps = arguments.steps or problem.given["steps"]
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run([ASPIC, "run", folder / "scene.toml", "--steps", str(steps), "--threads", str(arguments.threads), "--out", folder / "run",
                    "--force", "--quiet", "--allow-unconverged"], check=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    read = lambda file: list(csv.DictReader(open(folder / "run" / file, newline="")))
    rows, wall = read("steps.csv")[1:], sorted(column(read("timings.csv"), "seconds")[-steps:])
    per_step = lambda key: sum(column(rows, key)) / len(rows)
    touching = [row for row in rows if int(row["contacts"])]
    return {"scene": name, "vertices": problem.given["vertices"], "steps": len(rows),
            "converged": sum(row["status"] in ("converged", "round_off") for row in rows),
            "median_ms": 1e3 * wall[len(wall) // 2], "p99_ms": 1e3 * wall[min(len(wall) - 1, math.ceil(.99 * len(wall)) - 1)],
            "cpu_ms": 1e3 * (after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime) / len(rows),
            "newton": per_step("iterations"), "cg": per_step("linear_iterations"), "passes": per_step("friction_passes"),
            "contacts": max(map(int, column(rows, "contacts"))),
            "min_gap_m": min(column(touching, "min_gap")) if touching else math.nan}


def exponent(table):
    """Slope of log cost over log n, least squares."""
    x, y = ([math.log(row[key]) for row in table] for key in ("vertices", "cpu_ms"))
    mx, my = sum(x) / len(x), sum(y) / len(y)
    return sum((a - mx) * (b - my) for a, b in zip(x, y)) / sum((a - mx) ** 2 for a in x)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n", 1)[0])
    parser.add_argument("scene", nargs="*", help=", ".join(scenes.PROBLEMS))
    parser.add_argument("--steps", type=int, help="steps of each scene; default: all")
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--csv", type=pathlib.Path, help="CSV file to write the table to")
    parser.add_argument("--out", default="out/bench_contact", help="folder of scenes and runs")
    parser.add_argument("--write-only", action="store_true", help="write the files of the scenes without running them")
    parser.add_argument("--refine", action="store_true", help="run the chute with a sequence of finer meshes")
    arguments = parser.parse_args()
    unknown = set(arguments.scene) - set(scenes.PROBLEMS)
    if unknown:
        parser.error(f"unknown scene {', '.join(unknown)}; known: {', '.join(scenes.PROBLEMS)}")
    if arguments.refine:
        wanted = [(f"chute{cells}", scenes.chute(cells)) for cells in (9, 13, 20, 30)]
    else:
        wanted = [(name, scenes.PROBLEMS[name]()) for name in arguments.scene or scenes.PROBLEMS]
    table = []
    for name, problem in wanted:
        row = measure(name, problem, arguments)
        if not row:
            continue
        table.append(row)
        if len(table) == 1:
            print(" ".join(f"{key:>10}" for key in row))
        print(" ".join(f"{value:>10}" if isinstance(value, (str, int)) else f"{value:>10.3g}" for value in row.values()), flush=True)
        if arguments.csv:
            with open(arguments.csv, "w", newline="") as file:
                writer = csv.DictWriter(file, row)
                writer.writeheader()
                writer.writerows(table)
    if arguments.refine and table:
        print(f"cost grows with n^{exponent(table):.2f}")


if __name__ == "__main__":
    main()
