#!/usr/bin/python3
"""Cramer-Rao bounds of the stiff ball of capture_truths.py: the information in its measurements.

    tests/oracle/ball_information.py [MARKERS ...]

Prints the least standard deviations of unbiased estimates of center, log radius, log contrast and log E, for noise of 1 % and
an inclusion that is known to be a ball.
"""
import sys

import numpy as np

import capture_truths

NOISE, CELLS, TRANSITION = 0.01, 9, 1e-3  # [m]: a sharp surface would make differences rough
STEPS = {"center x [mm]": 1, "center y [mm]": 1, "center z [mm]": 1, "log radius": 0.05, "log contrast": 0.1}


def measured(x, y, z, growth, stiffening):
    center, radius, outside, inside = capture_truths.BALL
    center, radius = center + 1e-3 * np.array([x, y, z]), radius * np.exp(growth)

    def young(points):
        depth = (radius - np.linalg.norm(points - center, axis=-1)) / TRANSITION
        return outside * (inside / outside * np.exp(stiffening)) ** (1 / (1 + np.exp(-2 * np.clip(depth, -20, 20))))

    return capture_truths.ball(cells=CELLS, field=young)


def residuals(truth, deviations, motions=1):
    """Readings over their standard deviations."""
    motion, force, torque = deviations
    return np.concatenate([v for r in truth.readings
                           for v in (motions * r.markers.ravel() / motion, r.force / force, r.torque / torque)])


def bounds(truth, changed, markers):
    truth, changed = truth.with_first_markers(markers), [t.with_first_markers(markers) for t in changed]
    deviations = NOISE * np.array(truth.largest())
    base = residuals(truth, deviations)
    columns = [(residuals(t, deviations) - base) / h for t, h in zip(changed, STEPS.values())]
    J = np.column_stack(columns + [residuals(truth, deviations, motions=0)])  # E scales forces alone
    return np.sqrt(np.diag(np.linalg.inv(J.T @ J)))


def main():
    truth = measured(*[0] * len(STEPS))
    changed = [measured(*(h * (i == k) for i in range(len(STEPS)))) for k, h in enumerate(STEPS.values())]
    for markers in map(int, sys.argv[1:] or ("300", "3000")):
        found = bounds(truth, changed, markers)
        print(f"{markers} markers:", ", ".join(f"{name} {sd:.3f}" for name, sd in zip([*STEPS, "log E"], found)), flush=True)


if __name__ == "__main__":
    main()
