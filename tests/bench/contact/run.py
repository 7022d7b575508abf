#!/usr/bin/env python3
"""Runs the scenes of contact and prints the cost of their steps.

usage: tests/bench/contact/run.py [SCENE...] [--steps N] [--threads N] [--csv FILE] [--write-only] [--refine]

SCENE: chute knives funnel rollers twist boxes slab slab_fine, and of sheets hanging draped draped_coarse stack cape tablecloth; all by
default. --refine: the chute from 1 000 to 30 000 vertices, and the exponent of
the growth of its cost; --refine 5 adds 100 000. Times per step are those of the program. Shares are those of stages in the wall time:
of assembling and solving linear systems, of the line search, and of contact in all of them (search for pairs, bounds of steps, forces
and Hessians)."""
import argparse
import csv
import math
import os
import pathlib
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).parent))
import scenes  # noqa: E402

ROOT = pathlib.Path(__file__).resolve().parents[3]
ASPIC = os.environ.get("ASPIC", ROOT / "build/release/bin/aspic")


def column(rows, key):
    return [float(row[key]) for row in rows]


def measure(name, problem, arguments):
    folder = pathlib.Path(arguments.out) / name
    problem.write(folder)
    if arguments.write_only:
        return None
    steps = arguments.steps or problem.given["steps"]
    subprocess.run([ASPIC, "run", folder / "scene.toml", "--steps", str(steps), "--threads", str(arguments.threads), "--out", folder / "run",
                    "--force", "--quiet", "--allow-unconverged"], check=True)
    read = lambda file: list(csv.DictReader(open(folder / "run" / file, newline="")))
    rows, times = read("steps.csv")[1:], read("timings.csv")
    wall, cpu = (sorted(column(times, key)) for key in ("seconds", "cpu_seconds"))
    middle = lambda times: 1e3 * times[len(times) // 2]
    last = lambda times: 1e3 * times[min(len(times) - 1, math.ceil(.99 * len(times)) - 1)]
    share = lambda *keys: 100 * sum(sum(column(times, key)) for key in keys) / sum(wall)
    per_step = lambda key: sum(column(rows, key)) / len(rows)
    touching = [row for row in rows if int(row["contacts"])]
    return {"scene": name, "vertices": problem.given["vertices"], "steps": len(rows),
            "converged": sum(row["status"] in ("converged", "round_off") for row in rows),
            "median_ms": middle(wall), "p99_ms": last(wall), "cpu_median_ms": middle(cpu), "cpu_p99_ms": last(cpu),
            "cpu_ms": 1e3 * sum(cpu) / len(cpu), "newton": per_step("iterations"), "cg": per_step("linear_iterations"), "passes": per_step("friction_passes"),
            "distances": sum(column(times, "distances")) / len(times), "contact_%": share("contact_search", "contact_bound", "contact_forces"),
            "search_%": share("contact_search"), "bound_%": share("contact_bound"), "forces_%": share("contact_forces"),
            "hessian_%": share("hessian"), "factorize_%": share("factorize"), "solve_%": share("solve_linear"),
            "line_search_%": share("line_search"), "gradient_%": share("gradient"),
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
    parser.add_argument("--refine", type=int, nargs="?", const=4, metavar="N", help="run the chute with N finer and finer meshes; default: 4")
    arguments = parser.parse_args()
    unknown_scenes = set(arguments.scene) - set(scenes.PROBLEMS)
    if unknown_scenes:
        parser.error(f"unknown scene {', '.join(unknown_scenes)}; known: {', '.join(scenes.PROBLEMS)}")
    if arguments.refine:
        wanted = [(f"chute{cells}", scenes.chute(cells)) for cells in (9, 13, 20, 30, 46)[:arguments.refine]]
    else:
        wanted = [(name, scenes.PROBLEMS[name]()) for name in arguments.scene or scenes.PROBLEMS]
    table = []
    for name, problem in wanted:
        row = measure(name, problem, arguments)
        if not row:
            continue
        table.append(row)
        if len(table) == 1:
            print(" ".join(f"{key:>{max(8, len(key))}}" for key in row))
        print(" ".join(f"{value:>{max(8, len(key))}}" if isinstance(value, (str, int)) else f"{value:>{max(8, len(key))}.3g}"
                       for key, value in row.items()), flush=True)
        if arguments.csv:
            with open(arguments.csv, "w", newline="") as file:
                writer = csv.DictWriter(file, row)
                writer.writeheader()
                writer.writerows(table)
    if arguments.refine and len(table) > 1:
        print(f"cost grows with n^{exponent(table):.2f}")


if __name__ == "__main__":
    main()
