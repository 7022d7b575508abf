"""Verification of quadratic_fem.py: derivatives, patch test, closed forms, Hertz, convergence.

Exit code 77: NumPy or SciPy is missing."""
import sys
import unittest

try:
    import numpy as np
    import scipy  # noqa: F401
except ImportError:
    sys.exit(77)
import quadratic_fem as fem

YOUNG, POISSON = 2e4, 0.45


def uniform(points):
    return YOUNG + 0 * points[..., 0]


def cube(n=2, size=1.0, jitter=0.3):
    planes = np.linspace(0, size, n + 1)
    return fem.box(planes, planes, planes, jitter)


def stress(F, b):
    """Cauchy stress of the law, by differences of its energy density."""
    mu, K = YOUNG / (2 + 2 * POISSON), YOUNG / (3 - 6 * POISSON)

    def energy(F):
        J = np.linalg.det(F)
        x = J ** (-2 / 3) * (F ** 2).sum() - 3
        return mu / 2 * (x + b * x ** 2) + K / 4 * (J ** 2 - 1 - 2 * np.log(J))

    P, h = np.zeros((3, 3)), 1e-5
    for i in range(3):
        for j in range(3):
            d = np.zeros((3, 3))
            d[i, j] = h
            P[i, j] = (energy(F + d) - energy(F - d)) / (2 * h)
    return P


class Elements(unittest.TestCase):
    def test_derivatives_match_differences(self):
        solid = fem.Solid(cube(1), uniform, POISSON, weight=(0, 0, -9.81e3))
        random = np.random.default_rng(1)
        x = solid.mesh.X.ravel() + 0.02 * random.normal(size=solid.mesh.X.size)
        d, h = random.normal(size=x.size), 1e-5
        energy, gradient, K = solid.evaluate(x, True)
        values = [solid.evaluate(x + s * h * d) for s in (-1, 1)]
        self.assertAlmostEqual((values[1][0] - values[0][0]) / (2 * h) / (gradient @ d), 1, delta=1e-6)
        slope = (values[1][1] - values[0][1]) / (2 * h)
        self.assertLess(np.linalg.norm(slope - K @ d), 1e-6 * np.linalg.norm(slope))
        self.assertLess(abs(K - K.T).max(), 1e-9 * abs(K).max())

    def test_derivatives_of_fibres_match_differences(self):
        axes = lambda points: np.stack([np.cos(points[..., 0]), np.sin(points[..., 0]), 0 * points[..., 0]], -1)
        solid = fem.Solid(cube(1), uniform, POISSON, fibres=fem.Fibres(axes, 5.0, 2.0))
        random = np.random.default_rng(1)
        x = (1.02 * solid.mesh.X + 0.02 * random.normal(size=solid.mesh.X.shape)).ravel()
        d, h = random.normal(size=x.size), 1e-6
        energy, gradient, K = solid.evaluate(x, True)
        values = [solid.evaluate(x + s * h * d) for s in (-1, 1)]
        self.assertAlmostEqual((values[1][0] - values[0][0]) / (2 * h) / (gradient @ d), 1, delta=1e-6)
        slope = (values[1][1] - values[0][1]) / (2 * h)
        self.assertLess(np.linalg.norm(slope - K @ d), 1e-5 * np.linalg.norm(slope))

    def test_stretched_fibres_have_their_energy(self):
        along = lambda points: np.array([0.0, 0.6, 0.8])
        with_fibres, without = (fem.Solid(cube(1), uniform, POISSON, fibres=f) for f in (fem.Fibres(along, 3.0, 2.0), None))
        mu = YOUNG / (2 + 2 * POISSON)
        for stretch, strain in ((1.2, 0.64 * 0.44), (0.9, 0)):
            x = (with_fibres.mesh.X * [1, 1, stretch]).ravel()
            more = with_fibres.evaluate(x)[0] - without.evaluate(x)[0]
            taut = max(strain - 0.005, 0)
            self.assertAlmostEqual(more / mu, 3 / 4 * (np.exp(2 * taut ** 2) - 1), delta=1e-12)

    def test_patch_of_homogeneous_strain_is_exact(self):
        solid = fem.Solid(cube(2), uniform, POISSON)
        F = np.eye(3) + 0.1 * np.array([[1, 2, -1], [0.5, -0.5, 1], [0, 1, 0.3]])
        X = solid.mesh.X
        on_boundary = np.zeros(len(X), bool)
        on_boundary[solid.mesh.faces] = True
        start = X @ F.T
        start[~on_boundary] += 0.01 * np.random.default_rng(2).normal(size=(int((~on_boundary).sum()), 3))
        x = solid.solve(start.ravel(), np.repeat(on_boundary, 3), tolerance=1e-11)
        self.assertLess(np.abs(x - (X @ F.T).ravel()).max(), 1e-8)
        reaction = solid.evaluate(x)[1].reshape(-1, 3)
        # Moments of all reactions: sum f X' = V P, by the principle of virtual work.
        P = stress(F, solid.b)
        self.assertLess(np.abs(reaction.T @ X - P).max(), 1e-5 * np.abs(P).max())

    def test_uniaxial_stretch_matches_closed_form(self):
        solid = fem.Solid(cube(1), uniform, POISSON)
        X, stretch = solid.mesh.X, 1.1
        held = (X < 1e-9)
        held[:, 2] |= X[:, 2] > 1 - 1e-9
        x = solid.solve((X * [1, 1, stretch]).ravel(), held.ravel(), tolerance=1e-11)
        across = x.reshape(-1, 3)[X[:, 0] > 1 - 1e-9][0, 0]
        P = stress(np.diag([across, across, stretch]), solid.b)
        self.assertLess(abs(P[0, 0]), 1e-5 * P[2, 2])
        force = solid.evaluate(x)[1].reshape(-1, 3)[X[:, 2] > 1 - 1e-9, 2].sum()
        self.assertAlmostEqual(force / P[2, 2], 1, delta=1e-5)
        small = fem.Solid(cube(1), uniform, POISSON)  # moduli of small strains
        held_x = small.solve((X * [1, 1, 1 + 1e-4]).ravel(), held.ravel(), tolerance=1e-9).reshape(-1, 3)
        self.assertAlmostEqual(small.evaluate(held_x.ravel())[1].reshape(-1, 3)[X[:, 2] > 1 - 1e-9, 2].sum() / 1e-4 / YOUNG, 1,
                               delta=1e-3)
        self.assertAlmostEqual((1 - held_x[X[:, 0] > 1 - 1e-9][0, 0]) / 1e-4, POISSON, delta=1e-3)

    def test_simple_shear_matches_closed_form(self):
        solid = fem.Solid(cube(2), uniform, POISSON)
        X = solid.mesh.X
        F = np.eye(3)
        F[0, 2] = 0.2
        on_boundary = np.zeros(len(X), bool)
        on_boundary[solid.mesh.faces] = True
        x = solid.solve((X @ F.T).ravel(), np.repeat(on_boundary, 3))
        reaction = solid.evaluate(x)[1].reshape(-1, 3)
        mu = YOUNG / (2 + 2 * POISSON)
        expected = mu * (1 + 2 * solid.b * 0.04) * 0.2  # x = gamma^2
        self.assertAlmostEqual((reaction[:, 0] * X[:, 2]).sum() / expected, 1, delta=1e-6)


class Convergence(unittest.TestCase):
    @staticmethod
    def compression(n):
        """Force and bulge of a glued cube that is compressed by a tenth."""
        solid = fem.Solid(cube(n, 1.0, 0.2), uniform, POISSON)
        X = solid.mesh.X
        ends = (X[:, 2] < 1e-9) | (X[:, 2] > 1 - 1e-9)
        x = solid.solve((X * [1, 1, 0.9]).ravel(), np.repeat(ends, 3))
        force = solid.evaluate(x)[1].reshape(-1, 3)[X[:, 2] > 1 - 1e-9, 2].sum()
        return -force, fem.Interpolation(solid.mesh, [[1, 0.5, 0.5]])(x)[0, 0] - 1

    def test_glued_cube_converges(self):
        found = np.array([self.compression(n) for n in (2, 3, 5)])
        change = np.abs(np.diff(found, axis=0) / found[2])
        self.assertLess(change[1, 0], 0.8 * change[0, 0])
        self.assertLess(change[1, 0], 0.002)
        self.assertLess(change[1, 1], 0.5 * change[0, 1])

    def test_sphere_matches_hertz(self):
        # A quarter of a thick block under a small sphere: F = 4/3 E / (1 - nu^2) sqrt(R) d^(3/2). The block is finite and
        # the strain too, which adds two percent.
        planes = np.concatenate([np.linspace(0, 6e-3, 4), 6e-3 * 2.0 ** np.arange(1, 5)])
        R, depth = 20e-3, 0.5e-3
        solid = fem.Solid(fem.box(planes, planes, -planes[::-1], 0.1), uniform, 0.3)
        solid.indenter = fem.Indenter(np.array([0, 0, R - depth]), 0, R, 1e3 * YOUNG / R)
        X, edge = solid.mesh.X, planes[-1] - 1e-9
        held = np.stack([X[:, 0] < 1e-9, X[:, 1] < 1e-9, np.zeros(len(X), bool)], 1)
        held[(X[:, 0] > edge) | (X[:, 1] > edge) | (X[:, 2] < -edge)] = True
        x = solid.solve(X.ravel(), held.ravel())
        force = -4 * solid.contact(x)[3][2]
        self.assertAlmostEqual(force / (4 / 3 * YOUNG / (1 - 0.3 ** 2) * R ** 0.5 * depth ** 1.5), 1, delta=0.04)


if __name__ == "__main__":
    unittest.main()
