"""Fits a material to measured curves of homogeneous deformation, several at once, by least squares."""
import dataclasses
import difflib
import math

import numpy as np

from .. import _aspic
from .._aspic import InvalidInput
from .homogeneous import nominal_stress
from .least_squares import deviations, minimize_within

WEIGHTINGS = ("absolute", "balanced", "relative")
POWERS = 100  # larger ranges of a parameter use its logarithm
LEAST_RELATIVE = 0.05  # of the largest stress: floor of relative errors


@dataclasses.dataclass
class Curve:
    deformation: str
    stretch: np.ndarray  # stretch, or amount of shear
    stress: np.ndarray  # nominal stress [Pa]


@dataclasses.dataclass
class Parameter:
    name: str
    unit: str
    value: float
    sigma: float  # standard deviation from the scatter of the residuals; infinite: undetermined
    at_bound: bool = False
    is_held: bool = False

    @property
    def words(self):
        if self.is_held:
            return "held"
        if self.at_bound:
            return "at the end of its range"
        return f"+- {self.sigma:.2g}" if math.isfinite(self.sigma) else "not determined by these curves"


@dataclasses.dataclass
class Errors:
    """Of a curve, or of all points."""
    name: str
    predicted: np.ndarray  # [Pa]
    rms: float  # root mean square of predicted - measured [Pa]
    relative: float  # |predicted - measured| / |measured|, norms over the points
    largest: float  # largest |predicted - measured| over the largest |measured|
    r_squared: float  # 1 - sum of squares / sum of squares about the mean of the measurements


@dataclasses.dataclass
class CurveFit:
    material: str
    poisson: float
    theta: list  # mu, lambda [Pa] and the material's own parameters
    parameters: list
    curves: list  # errors of each
    all: Errors
    converged: bool
    iterations: int
    starts: list  # |r|^2 / 2 from each initial guess; infinite: failed
    incompressible: bool
    data: list  # the curves

    @property
    def scene(self):
        """The line of a scene."""
        words = [f'model = "{self.material}"']
        for p in self.parameters:
            words.append(f"{p.name} = {p.value:.6g}")
            if p.name == "young":
                words.append(f"poisson = {self.poisson:.6g}")
        return f"material = {{ {', '.join(words)} }}"

    def __str__(self):
        lines = [self.material]
        lines += [f"  {p.name:<14} {p.value:>12.6g} {p.unit:<4} {p.words}" for p in self.parameters]
        lines.append(f"  {'test':<14} {'relative':>10} {'largest':>10} {'R^2':>10} {'rms [Pa]':>14}")
        for e in [*self.curves, self.all]:
            lines.append(f"  {e.name:<14} {100 * e.relative:>9.2f}% {100 * e.largest:>9.2f}% {e.r_squared:>10.5f} {e.rms:>14.5g}")
        if len(self.starts) > 1:
            same = sum(s <= min(self.starts) * (1 + 1e-6) + 1e-300 for s in self.starts)
            lines.append(f"  {same} of {len(self.starts)} initial guesses end here")
        if not self.converged:
            lines.append(f"  did not converge in {self.iterations} iterations")
        return "\n".join([*lines, f"  {self.scene}"])


def suggestion(name, known):
    near = difflib.get_close_matches(name, known, 1)
    return f" (did you mean '{near[0]}'?)" if near else f" (known: {', '.join(known)})"


def is_stretch(deformation, l):
    return l is not None and math.isfinite(l) and abs(l) <= 1e3 and (l > 0 or deformation == "simple_shear")


class _Misfit:
    """Residuals as a function of ln mu and the material's other free parameters (as logarithms if their range spans powers of
    ten)."""

    def __init__(self, curves, material, poisson, weighting, incompressible, held):
        self.curves, self.material, self.poisson, self.incompressible = curves, material, poisson, incompressible
        self.extra = _aspic.material_parameters(material)
        if not curves:
            raise InvalidInput("there is no curve to fit")
        if not _aspic.is_isotropic(material):
            raise InvalidInput(f"the model {material} is anisotropic; curves need an isotropic one (`aspic fit` finds fibres from "
                               "motions)")
        for curve in curves:
            self.check(curve)
        if not -1 < poisson < 0.5:
            raise InvalidInput(f"poisson = {poisson:.6g} must lie between -1 and 0.5 (try 0.49)")
        if weighting not in WEIGHTINGS:
            raise InvalidInput(f"weighting = '{weighting}'{suggestion(weighting, WEIGHTINGS)}")
        names = [name for name, *_ in self.extra]
        for name in held:
            if name not in names:
                raise InvalidInput(f"'{name}' is not a parameter of {material}{suggestion(name, names)}")
        self.own = [k for k, name in enumerate(names) if name not in held]
        self.is_log = [self.extra[k][3] > 0 and self.extra[k][4] > POWERS * self.extra[k][3] for k in self.own]
        ranges = [self.extra[k][3:] for k in self.own]
        self.bounds = np.array([(-math.inf, math.inf), *(np.log(r) if log else r for r, log in zip(ranges, self.is_log))]).T
        self.measured = np.concatenate([curve.stress for curve in curves])
        self.scale = np.concatenate([self.scale_of(curve, weighting) for curve in curves])

    @staticmethod
    def check(curve):
        if len(curve.stretch) == 0 or len(curve.stretch) != len(curve.stress):
            raise InvalidInput(f"curve '{curve.deformation}': has {len(curve.stretch)} stretches and {len(curve.stress)} stresses; give "
                               "the same number of each")
        for i, (l, s) in enumerate(zip(curve.stretch, curve.stress), 1):
            if not is_stretch(curve.deformation, l):
                raise InvalidInput(f"curve '{curve.deformation}': point {i} has the stretch {l:.6g}; give length over rest length, 1 at "
                                   "rest")
            if not math.isfinite(s):
                raise InvalidInput(f"curve '{curve.deformation}': point {i} has no finite stress")
        if not np.any(curve.stress):
            raise InvalidInput(f"curve '{curve.deformation}': all stresses are 0; there is nothing to fit")

    def scale_of(self, curve, weighting):
        """Equal weights for each stress (absolute), each curve (balanced), or each relative error (relative)."""
        size = np.abs(curve.stress)
        if weighting == "relative":
            return np.maximum(size, LEAST_RELATIVE * size.max())
        return np.full(len(size), np.linalg.norm(size) if weighting == "balanced" else np.sqrt(np.mean(self.measured**2)))

    def theta(self, p):
        mu = math.exp(p[0])
        extra = [fallback for _, _, fallback, _, _ in self.extra]
        for k, log, value in zip(self.own, self.is_log, p[1:]):
            extra[k] = math.exp(value) if log else float(value)
        return [mu, 2 * mu * self.poisson / (1 - 2 * self.poisson), *extra]

    def stresses(self, p):
        theta = self.theta(p)
        found = [nominal_stress(self.material, theta, c.deformation, c.stretch, self.incompressible) for c in self.curves]
        return None if None in [f and 1 for f in found] else [np.concatenate(part) for part in zip(*found)]

    def evaluate(self, p):
        """Residuals and Jacobian; None where the material has no state."""
        if (found := self.stresses(p)) is None:
            return None
        stress, slopes = found
        theta = self.theta(p)
        columns = [theta[0] * slopes[:, 0] + theta[1] * slopes[:, 1]]
        columns += [slopes[:, 2 + k] * (theta[2 + k] if log else 1) for k, log in zip(self.own, self.is_log)]
        return (stress - self.measured) / self.scale, np.stack(columns, 1) / self.scale[:, None]

    def guess(self, start):
        """The defaults, or random ones with this seed; mu is that of a neo-Hookean solid, whose stress is proportional to it."""
        unit = np.concatenate([nominal_stress("neo_hookean_isochoric", [1.0, 1.0], c.deformation, c.stretch)[0] for c in self.curves])
        product = np.sum(unit * self.measured / self.scale**2)
        if not product > 0:
            raise InvalidInput("stresses and stretches have opposite signs; use one sign convention: l > 1 and stress > 0 in tension")
        p, random = [math.log(product / np.sum((unit / self.scale)**2))], np.random.RandomState(start)

        def draw():
            low, high = (int(x) for x in random.randint(0, 2**32, 2, np.uint32))
            return (low + high * 2.0**32) / 2.0**64

        for k, log in zip(self.own, self.is_log):
            value, least, most = self.extra[k][2:]
            if start > 0 and most - least >= POWERS:
                value = 10**(3 * draw() - 2)  # 0.01 to 10
                value = -value if least < 0 and draw() < 0.5 else value
            elif start > 0:
                value = least + draw() * (most - least)
            value = min(max(value, least), most)
            p.append(math.log(value) if log else value)
        return np.array(p)


def _errors(name, measured, predicted):
    e, mean = predicted - measured, np.mean(measured)
    about_mean = np.sum((measured - mean)**2)
    return Errors(name, predicted, math.sqrt(np.mean(e**2)), np.linalg.norm(e) / np.linalg.norm(measured),
                  np.abs(e).max() / np.abs(measured).max(), 1 - e @ e / about_mean if about_mean > 0 else math.nan)


def fit_curves(curves, material="spline", poisson=0.49, weighting="balanced", incompressible=True, held=(), starts=6):
    """Fits a material to curves by least squares within the ranges of its parameters, from several initial guesses.

    poisson: of compressible bodies, and for the scene. held: parameters that keep their defaults."""
    misfit = _Misfit(curves, material, poisson, weighting, incompressible, held)
    lower, upper = misfit.bounds
    tries = [minimize_within(misfit.evaluate, misfit.guess(start), lower, upper)
             for start in range(max(1, starts) if len(lower) > 1 else 1)]
    least = min(t.objective for t in tries)
    best = next(t for t in tries if t.objective <= least * (1 + 1e-12))  # the first of equal minima
    if best.p is None:
        raise InvalidInput(f"{material} has no state of free faces at some stretch of the curves; choose another material or its "
                           "incompressible limit")
    theta, at_bound = misfit.theta(best.p), (best.p <= lower) | (best.p >= upper)
    sigma = deviations(*misfit.evaluate(best.p), at_bound)
    young = 2 * (1 + poisson) * theta[0]
    parameters = [Parameter("young", "Pa", young, young * sigma[0])]
    for k, (name, unit, *_) in enumerate(misfit.extra):
        value, place = theta[2 + k], misfit.own.index(k) + 1 if k in misfit.own else 0
        factor = value if place and misfit.is_log[place - 1] else 1
        parameters.append(Parameter(name, unit, value, factor * sigma[place], bool(at_bound[place]), place == 0))
    predicted = np.split(misfit.stresses(best.p)[0], np.cumsum([len(c.stress) for c in curves])[:-1])
    errors = [_errors(c.deformation, c.stress, s) for c, s in zip(curves, predicted)]
    whole = _errors("all", misfit.measured, np.concatenate(predicted))
    return CurveFit(material, poisson, theta, parameters, errors, whole, best.converged, best.iterations,
                    [t.objective for t in tries], incompressible, curves)
