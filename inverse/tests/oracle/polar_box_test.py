"""Verification of polar_box.py and of the disc of quadratic_fem.py: volume, circles, derivatives, a flat punch.

Exit code 77: NumPy or SciPy is missing."""
import sys
import unittest

try:
    import numpy as np
    import scipy  # noqa: F401
except ImportError:
    sys.exit(77)
import quadratic_fem as fem
from capture_truths import graded_between
from polar_box import polar_box

YOUNG, POISSON, RADIUS = 2e4, 0.3, 1.0


def uniform(points):
    return YOUNG + 0 * points[..., 0]


class Mesh(unittest.TestCase):
    mesh = polar_box([4, 6, 8, 9, 10, 14, 20, 40], (8, 14), np.array([0, 10, 24, 40.0]), 4)

    def test_tets_fill_the_box(self):
        volume = fem.Solid(self.mesh, uniform, POISSON).volume  # asserts that all are positive
        self.assertAlmostEqual(volume.sum(), 40 ** 3, delta=1e-8)
        corners = self.mesh.X[self.mesh.faces[:, :3]]
        normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]) / 2
        self.assertAlmostEqual(np.linalg.norm(normals, axis=1).sum(), 6 * 40 ** 2, delta=1e-8)  # no face inside
        self.assertAlmostEqual((normals * corners.mean(1)).sum() / 3, 40 ** 3, delta=1e-8)      # outward

    def test_rings_are_circles(self):
        corners = self.mesh.X[np.unique(self.mesh.tets[:, :4])]
        top = np.hypot(*corners[corners[:, 2] == 40][:, :2].T)
        for radius in (8, 9, 10, 14):
            self.assertEqual((np.abs(top - radius) < 1e-9).sum(), 9)


class RoundedDisc(unittest.TestCase):
    def test_derivatives_of_depth_match_differences(self):
        disc = fem.Disc(np.array([0.1, 0.2, 0.3]), 0.9, 0.1, 1)
        random = np.random.default_rng(1)
        angle, radius, height = random.uniform((0, 0.75, -0.2), (6, 1.25, 0.2), (300, 3)).T
        x = disc.center + np.column_stack([radius * np.cos(angle), radius * np.sin(angle), height])
        gradient, hessian = disc.depth(x)[1], disc.curvature(x)
        for k, step in enumerate(1e-6 * np.eye(3)):
            (low, down), (high, up) = disc.depth(x - step), disc.depth(x + step)
            self.assertLess(np.abs((high - low) / 2e-6 - gradient[:, k]).max(), 1e-8)
            self.assertLess(np.abs((up - down) / 2e-6 - hessian[:, :, k]).max(), 1e-4)

    def test_derivatives_of_contact_match_differences(self):
        mesh = polar_box([0.5, 0.8, 0.9, 1, 1.1, 1.5, 2], (0.8, 1.5), np.array([-1, -0.5, 0]), 2)
        solid, random = fem.Solid(mesh, uniform, POISSON), np.random.default_rng(1)
        solid.indenter = fem.Disc(np.array([0, 0, -0.1]), 0.9, 0.1, 1e3)
        x, d, h = mesh.X.ravel(), random.normal(size=mesh.X.size), 1e-6
        _, gradient, K, force = solid.contact(x, True)
        (low, down, *_), (high, up, *_) = (solid.contact(x + step * d) for step in (-h, h))
        self.assertAlmostEqual((high - low) / (2 * h) / (gradient @ d), 1, delta=1e-4)
        self.assertLess(np.linalg.norm((up - down) / (2 * h) - K @ d), 1e-3 * np.linalg.norm(K @ d))
        self.assertAlmostEqual(-gradient[2::3].sum() / force[2], 1, delta=1e-9)

    def test_disc_matches_a_flat_punch(self):
        # F = 2 E a d / (1 - nu^2) on a half-space [Sneddon 1965]; the rim is rounded from 0.95 a on.
        depth, size = 0.01 * RADIUS, np.array([0.3, 0.06, 0.15, 8])
        rings = graded_between([0.4, 0.9, 1.1, 20], size)
        mesh = polar_box(rings, (0.8, 1.5), -graded_between([0, 20], [0.12, 8])[::-1], 2)
        solid = fem.Solid(mesh, uniform, POISSON)
        solid.indenter = fem.Disc(np.array([0, 0, -depth]), 0.95, 0.05, 1e3 * YOUNG / RADIUS)
        X, edge = mesh.X, 20 - 1e-9
        held = np.stack([X[:, 0] < 1e-9, X[:, 1] < 1e-9, np.zeros(len(X), bool)], 1)
        held[(X[:, 0] > edge) | (X[:, 1] > edge) | (X[:, 2] < -edge)] = True
        x = solid.solve(X.ravel(), held.ravel())
        force = -4 * solid.contact(x)[3][2]
        self.assertAlmostEqual(force / (2 * YOUNG * RADIUS * depth / (1 - POISSON ** 2)), 1, delta=0.03)


if __name__ == "__main__":
    unittest.main()
