"""Levenberg-Marquardt with bounds, for few parameters that may end exactly at a bound, such as nonnegative coefficients."""
import dataclasses
import math

import numpy as np
from scipy.optimize import lsq_linear

MOST_ITERATIONS, TOLERANCE = 300, 1e-10  # predicted relative decrease of |r|^2
NEGLIGIBLE = 1e-24  # relative to |r|^2 of the guess: exact data are fitted to round-off
UNDETERMINED = 1e-13  # squared part of a column of the Jacobian that others do not explain


@dataclasses.dataclass
class Minimum:
    p: np.ndarray | None
    objective: float
    converged: bool = False
    iterations: int = 0


@np.errstate(over="ignore", invalid="ignore")  # steps that overflow are refused
def minimize_within(evaluate, p, lower, upper):
    """Levenberg-Marquardt within bounds: each iteration minimizes the damped Gauss-Newton model over the box [Nocedal 2006, alg.
    16.3]. evaluate(p) returns residuals and Jacobian, or None."""
    p = np.clip(p, lower, upper)
    if (found := evaluate(p)) is None:
        return Minimum(None, math.inf)
    r, J = found
    negligible, damping, converged, iterations = NEGLIGIBLE * (r @ r), 1e-3, False, 0
    while iterations < MOST_ITERATIONS and not converged:
        before = r @ r
        if before <= negligible:
            converged = True
            break
        iterations += 1
        size, moved = np.linalg.norm(J, axis=0), False
        free = size > 0
        while damping < 1e16:
            A = np.vstack([J[:, free], math.sqrt(damping) * np.diag(size[free])])
            low, high = (lower - p)[free], (upper - p)[free]
            d = lsq_linear(A, np.concatenate([-r, np.zeros(free.sum())]), (low, high), "bvls", tol=1e-14).x
            q = p.copy()
            q[free] = np.where(d <= low, lower[free], np.where(d >= high, upper[free], p[free] + d))
            linear = r + J @ (q - p)
            decrease = before - linear @ linear
            if decrease <= TOLERANCE * before and damping < 1:  # otherwise damping limited the step, which shows no convergence
                converged = True
                break
            trial = evaluate(q)
            if trial is None or not trial[0] @ trial[0] < before:
                damping *= 4
                continue
            if before - trial[0] @ trial[0] > 0.5 * decrease:
                damping = max(1e-12, damping / 9)
            p, (r, J), moved = q, trial, True
            break
        if not moved:
            break
    return Minimum(p, r @ r / 2, converged, iterations)


def deviations(r, J, at_bound):
    """Standard deviations of the parameters; 0 at a bound, infinite if undetermined."""
    sigma = np.where(at_bound, 0.0, math.inf)
    inner = np.flatnonzero(~at_bound & (np.linalg.norm(J, axis=0) > 0))
    freedom = len(r) - len(inner)
    size = np.linalg.norm(J[:, inner], axis=0)
    if freedom <= 0 or len(inner) == 0:
        return sigma
    R = np.linalg.qr(J[:, inner] / size, "r")
    if (np.diag(R)**2 <= UNDETERMINED).any():
        return sigma
    inverse = np.linalg.inv(R)
    sigma[inner] = np.sqrt(r @ r / freedom * np.sum(inverse**2, axis=1)) / size
    return sigma
