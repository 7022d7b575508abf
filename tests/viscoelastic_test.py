"""Runs with [[body.viscoelastic]] against the equations of a pulled cube, integrated here by Runge-Kutta steps.

usage: ASPIC=path/to/aspic viscoelastic_test.py. Exit code 77: the package numpy is missing."""
import math
import sys
import unittest

try:
    import numpy
except ImportError:
    sys.exit(77)
from command_line import CommandLine

YOUNG, POISSON = 1e5, 0.3
SHEAR, RELAXATION = numpy.array([6e4, 2e4]), numpy.array([0.4, 3.0])
TIMES, STRETCHES = (0.0, 1.0, 2.0, 2.5, 4.0), (1.0, 1.3, 1.3, 0.9, 0.9)
SCENE = """gravity = [0, 0, 0]
[time]
integrator = "quasi_static"
step = {step}
duration = 4
[solver]
tolerance = 1e-10
[output]
vtu = false
usd = false
report = false
[[body]]
name = "cube"
shape = {{ box = {{ upper = [1, 1, 1], cells = [1, 1, 1] }} }}
order = {order}
material = {{ model = "neo_hookean_log", young = {young}, poisson = {poisson} }}
""" + "".join(f"[[body.viscoelastic]]\nshear = {G}\nrelaxation_time = {tau}\n" for G, tau in zip(SHEAR, RELAXATION)) + \
    "".join(f"[[body.pin]]\nwhere = '{a} < 1e-6'\naxes = '{a}'\n" for a in "xyz") + """[[body.pin]]
name = "top"
where = "z > 1 - 1e-6"
axes = "z"
motion = {{ keyframes = [""" + ", ".join(f"{{{{ time = {t}, displacement = [0, 0, {l - 1:.6g}] }}}}"
                                         for t, l in zip(TIMES, STRETCHES)) + "] }}\n"

MU, LAMBDA = YOUNG / (2 * (1 + POISSON)), YOUNG * POISSON / ((1 + POISSON) * (1 - 2 * POISSON))


def green(stretch):
    return (stretch * stretch - 1) / 2


class PulledCube:
    """Viscous strains e of the branches along the pull and across: e' = (E - e) / tau, s = 2 G (E - e)."""

    def __init__(self):
        self.e, self.lost, self.side = numpy.zeros((2, 2)), 0.0, 1.0

    def sides(self, stretch, e):
        """The stretch of the free sides, where elastic and viscous stress cancel, by Newton's method."""
        t = self.side
        for _ in range(50):
            log_J = math.log(stretch * t * t)
            s = (2 * SHEAR * (green(t) - e[1])).sum()
            value = MU * (t - 1 / t) + LAMBDA * log_J / t + t * s
            slope = MU * (1 + 1 / t**2) + LAMBDA * (2 - log_J) / t**2 + s + t * t * 2 * SHEAR.sum()
            t -= value / slope
            if abs(value / slope) < 1e-15:
                break
        self.side = t
        return t

    def stresses(self, stretch, e):
        strain = numpy.array([[green(stretch)], [green(self.sides(stretch, e))]])
        return 2 * SHEAR * (strain - e)

    def rates(self, time, e):
        s = self.stresses(numpy.interp(time, TIMES, STRETCHES), e)
        power = ((s[0] ** 2 + 2 * s[1] ** 2) / (2 * SHEAR * RELAXATION)).sum()
        return s / (2 * SHEAR * RELAXATION), power

    def advance(self, time, h):
        k1, p1 = self.rates(time, self.e)
        k2, p2 = self.rates(time + h / 2, self.e + h / 2 * k1)
        k3, p3 = self.rates(time + h / 2, self.e + h / 2 * k2)
        k4, p4 = self.rates(time + h, self.e + h * k3)
        self.e = self.e + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
        self.lost += h / 6 * (p1 + 2 * p2 + 2 * p3 + p4)

    def at(self, time):
        """Pulling force, stored and dissipated energy of a cube of side 1."""
        stretch = numpy.interp(time, TIMES, STRETCHES)
        s, side = self.stresses(stretch, self.e), self.side
        force = MU * (stretch - 1 / stretch) + LAMBDA * math.log(stretch * side * side) / stretch + stretch * s[0].sum()
        return numpy.array([force, ((s[0] ** 2 + 2 * s[1] ** 2) / (4 * SHEAR)).sum(), self.lost])


def reference(step, substeps=40):
    """One row per step."""
    cube, rows = PulledCube(), []
    for n in range(round(TIMES[-1] / step)):
        for k in range(substeps):
            cube.advance(n * step + k * step / substeps, step / substeps)
        rows.append(cube.at((n + 1) * step))
    return numpy.array(rows)


class Viscoelastic(CommandLine):
    def run_cube(self, step, order):
        self.write("cube.toml", SCENE.format(step=step, order=order, young=YOUNG, poisson=POISSON))
        self.aspic("run", "cube.toml", "--out", "run", "--force", "--quiet")
        rows = self.steps("run")
        for row in rows:
            self.assertGreaterEqual(float(row["viscoelastic_loss"]), 0)
        lost = numpy.cumsum([float(row["viscoelastic_loss"]) for row in rows])
        columns = [[float(row[name]) for row in rows] for name in ("reaction_cube.top_z", "potential_viscoelastic")]
        return numpy.array([*columns, lost]).T

    def error(self, step, order):
        """Largest errors of force, stored and dissipated energy over their largest values."""
        exact = reference(step)
        return numpy.abs(self.run_cube(step, order) - exact).max(axis=0) / numpy.abs(exact).max(axis=0)

    def test_cube_converges_with_second_order(self):
        coarse, fine = self.error(0.05, 1), self.error(0.025, 1)
        self.assertLess(fine.max(), 2e-4)
        for ratio in coarse / fine:
            self.assertAlmostEqual(math.log2(ratio), 2, delta=0.15)

    def test_quadratic_tets_agree(self):
        self.assertLess(numpy.abs(self.run_cube(0.1, 2) / self.run_cube(0.1, 1) - 1).max(), 1e-7)

    def test_reference_is_converged(self):
        self.assertLess(numpy.abs(reference(0.1, 40) / reference(0.1, 80) - 1).max(), 1e-8)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
