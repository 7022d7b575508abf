"""A solution of week 4: iterations of Newton's method on Rosenbrock's valley from ten starts.

The slowest starts have x < 0: their path follows the bend of the valley around the origin, in steps no longer than the valley
is straight. Starts with x > 0 reach its floor on the side of the minimum and need about half as many.
"""
import numpy as np
from newton import backtrack, minimize, newton

angles = 2 * np.pi * np.arange(10) / 10
starts = 1.5 * np.stack([np.cos(angles), np.sin(angles)], axis=1)
counts = [len(minimize(start, newton, backtrack)) - 1 for start in starts]
for start, count in zip(starts, counts):
    print(f"from ({start[0]:5.2f}, {start[1]:5.2f}): {count:2} iterations")
