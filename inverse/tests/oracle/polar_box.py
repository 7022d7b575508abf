"""Quadratic mesh of a quarter of a box whose cells follow circles around the box's axis.

A vertex has the polar coordinates (r, angle) around the vertical axis x = y = 0. Its distance from the axis is
r (1 + s (1 / max(cos, sin) - 1)) with the squareness s: 0 on circles, 1 on squares with sides parallel to x and y.
"""
import itertools

import numpy as np

import quadratic_fem as fem


def polar_box(rings, circles, planes, sectors):
    """Returns the mesh of 0 <= x, y <= rings[-1]. `rings`: increasing radii; those from circles[0] to circles[1] are
    circles. A layer has sectors x sectors cells inside rings[0], and 2 sectors between two rings. `planes`: increasing
    heights of planes."""
    radius, angle, parity, quads = layer(np.asarray(rings), sectors)
    squareness = np.interp(radius, [0, rings[0], *circles, rings[-1]], [1, 0.4, 0, 0, 1])
    away = radius * (1 + squareness * (1 / np.maximum(np.cos(angle), np.sin(angle)) - 1))
    across = np.stack([away * np.cos(angle), away * np.sin(angle)], 1)
    across[np.abs(across) < 1e-12] = 0
    count, level = len(radius), np.arange(len(planes))
    X = np.concatenate([np.tile(across, (len(planes), 1)), np.repeat(planes, count)[:, None]], 1)
    cells = (quads[None, :, :, None] + count * (level[:-1, None, None, None] + np.arange(2))).reshape(-1, 8)
    return fem.cut_cells(X, cells, (parity + level[:, None]).ravel() % 2)


def layer(rings, n):
    """Returns radius, angle and parity of the vertices of a plane, and its cells, whose corners are in binary order."""
    radius, angle, parity, index = [], [], [], {}
    for i, j in itertools.product(range(n + 1), repeat=2):
        index[i, j] = len(radius)
        radius.append(rings[0] * max(i, j) / n)
        angle.append(0 if i == j == 0 else np.pi / 4 * (j / i if i >= j else 2 - i / j))
        parity.append((i + j) % 2)
    ring = np.empty((2 * n + 1, len(rings)), int)
    for t in range(2 * n + 1):
        ring[t, 0] = index[(n, t) if t <= n else (2 * n - t, n)]
        for k in range(1, len(rings)):
            ring[t, k] = len(radius)
            radius.append(rings[k])
            angle.append(np.pi / 4 * t / n)
            parity.append((n + t + k) % 2)
    quads = [[index[i + a, j + b] for a, b in itertools.product((0, 1), repeat=2)]
             for i, j in itertools.product(range(n), repeat=2)]
    quads += [[ring[t, k], ring[t + 1, k], ring[t, k + 1], ring[t + 1, k + 1]]
              for t in range(2 * n) for k in range(len(rings) - 1)]
    return np.array(radius), np.array(angle), np.array(parity), np.array(quads)
