#!/usr/bin/python3
"""Costs of the Python package: a solver written in Python, observers, Ctrl-C. Needs example_05_lecture_loop.

PYTHONPATH=build/release/python tests/bench/python.py [--build build/release] [--cells 2 6] [--csv FILE]
"""
import argparse
import csv
import os
import pathlib
import re
import signal
import subprocess
import sys
import threading
import time

import numpy as np

import aspic

ROOT = pathlib.Path(__file__).resolve().parents[2]


def lecture_loop(n):
    """The loop of examples/05_lecture_loop.cpp. Returns its CPU time [s] and the height of the last vertex."""
    scene = aspic.Scene()
    bar = scene.add(aspic.box((.4, .1, .1), (4 * n, n, n)),
                    material=aspic.Material("neo_hookean", young=1e5, poisson=.4, density=1000))
    bar.pin(bar.vertices[:, 0] == 0)
    sim = aspic.Simulation(scene, h=.01)
    E, solver = sim.objective(), aspic.LinearSolver("cholesky")
    q, v, h = sim.q, sim.v, sim.h
    begin = time.process_time()
    for _ in range(20):
        q0, q = q, E.begin_step(q, v, h)
        while np.linalg.norm(g := E.gradient(q)) > 1e-10:
            d = -solver.factorize(E.hessian(q, "clamped")).solve(g)
            alpha, E0, slope = 1.0, E(q) + E.round_off, (g * d).sum()
            while E(q + alpha * d) > E0 + 1e-4 * alpha * slope and alpha >= 1e-10:
                alpha /= 2
            q = q + alpha * d
        v = (q - q0) / h
    return time.process_time() - begin, q[-1, 1]


def compare_loops(build, n, repeats=5):
    """The smallest CPU times [s] of alternating runs in Python and in C++."""
    ours, theirs = [], []
    for _ in range(repeats):
        seconds, tip = lecture_loop(n)
        output = subprocess.run([build / "bin/example_05_lecture_loop", str(n)], capture_output=True, text=True,
                                check=True).stdout
        assert abs(float(re.findall(r"y = (\S+) m", output)[-1]) - tip) < 2e-6, (output, tip)
        ours.append(seconds)
        theirs.append(float(re.search(r"(\S+) s of CPU time", output)[1]))
    return min(ours), min(theirs)


def bunny():
    return aspic.Simulation(ROOT / "scenes/bunny.toml", record=False)


def observer_overhead(observe, steps=10, repeats=7):
    """CPU time with an observer relative to that without, as a share; the smallest of alternating runs."""
    sim = bunny()
    sim.run(2)
    start, best = sim.snapshot(), {}
    for _ in range(repeats):
        for watched in (False, True):
            sim.restore(start)
            begin = time.process_time()
            sim.run(steps, observe=observe if watched else None)
            best[watched] = min(best.get(watched, np.inf), time.process_time() - begin)
    return best[True] / best[False] - 1


def interrupt_latencies(tries=20):
    """Times from SIGINT during a step of the bunny to KeyboardInterrupt [s]: (wall, CPU of the main thread), (tries, 2)."""
    sim, rng, latencies = bunny(), np.random.default_rng(1), []
    clock = time.pthread_getcpuclockid(threading.main_thread().ident)
    for _ in range(tries):
        sent = []

        def interrupt():
            time.sleep(rng.uniform(.05, .3))
            sent.append((time.monotonic(), time.clock_gettime(clock)))
            os.kill(os.getpid(), signal.SIGINT)

        thread = threading.Thread(target=interrupt)
        thread.start()
        try:
            while True:
                sim.step()
        except KeyboardInterrupt:
            latencies.append(np.subtract((time.monotonic(), time.clock_gettime(clock)), sent[0]))
        thread.join()
    return np.array(latencies)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build/release")
    parser.add_argument("--cells", type=int, nargs="*", default=[2, 6])
    parser.add_argument("--csv", type=argparse.FileType("w"), help="also write the rows to a file")
    arguments = parser.parse_args()
    rows = []

    def add(name, value, unit, target=""):
        rows.append({"measurement": name, "value": f"{value:.3g}", "unit": unit, "target": target})
        print(f"{name:48} {value:9.3g} {unit:6} {target}", flush=True)

    for n in arguments.cells:
        ours, theirs = compare_loops(arguments.build, n)
        name = f"own solver, {(4 * n + 1) * (n + 1)**2} vertices"
        add(f"{name}: C++", theirs, "s")
        add(f"{name}: Python / C++", ours / theirs, "", "<= 1.2")
    add("observer, empty", 100 * observer_overhead(lambda it: None), "%", "< 2")
    add("observer, Trace", 100 * observer_overhead(aspic.Trace()), "%", "< 2")
    latencies = interrupt_latencies()
    for i, clock in enumerate(("wall time", "CPU time")):
        add(f"Ctrl-C in a step of the bunny, median {clock}", np.median(latencies[:, i]), "s", "< 0.2")
        add(f"Ctrl-C in a step of the bunny, largest {clock}", latencies[:, i].max(), "s", "< 0.2")
    if arguments.csv:
        writer = csv.DictWriter(arguments.csv, rows[0], lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)


if __name__ == "__main__":
    sys.exit(main())
