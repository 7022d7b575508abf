"""Minimization: with the methods of the library, or with directions and line searches written in Python."""
import types

import numpy as np

from . import _aspic


def test_function(name) -> _aspic.Objective:
    """A function of two variables with a known minimum, as an Objective; see test_functions().

    >>> float(aspic.test_function("rosenbrock")([1, 1]))
    0.0
    """
    return _aspic.test_function(name)


def _objective(f, x0):
    if isinstance(f, _aspic.Objective):
        return f
    if not (hasattr(f, "value") and hasattr(f, "gradient")):
        raise _aspic.InvalidInput(f"f: this is {type(f).__name__}; expected an Objective, or an object with value(x) and gradient(x)")
    return _aspic.PythonObjective(f, np.asarray(x0, float))


def minimize(f, x0, direction="newton", line_search=None, observe=None, **options) -> types.SimpleNamespace:
    """Minimizes f from x0 and returns an object with x, status, success, value, gradient_norm and iterations.

    f: an Objective, such as sim.objective(), or an object with value(x), gradient(x) and, for Newton's method,
    hessian(x), a dense or a scipy matrix for x.ravel().
    direction: a method, see minimizer_names(), or a function direction(E, x, g) -> d in the shape of x.
    line_search: keys of solver.line_search, or a function line_search(E, x, d, g) -> alpha.
    options: keys of [solver]: tolerance, criterion, max_iterations, linear, definiteness, ...
    observe(iteration) is called in every iteration.

    >>> found = aspic.minimize(aspic.test_function("rosenbrock"), [-1.2, 1])
    >>> found.status, found.x.round(6).tolist()
    ('converged', [1.0, 1.0])
    """
    E = _objective(f, x0)
    if line_search is not None:
        options["line_search"] = line_search
    if not isinstance(f, _aspic.Objective) and direction == "newton" and "definiteness" not in options:
        options["definiteness"] = "on_demand" if np.size(x0) <= 600 else "exact"
    return types.SimpleNamespace(**_aspic.minimize(E, x0, direction, options, observe))


def backtrack(E, x, d, g, alpha=1.0, c=1e-4, p=0.5, smallest=1e-10) -> float:
    """The lecture's line search: the first alpha, alpha p, alpha p^2, ... of sufficient decrease up to round-off; 0: none.

    >>> E = aspic.test_function("rosenbrock")
    >>> aspic.minimize(E, [-1.2, 1], line_search=aspic.backtrack).status
    'converged'
    """
    alpha, value, slope = min(alpha, 0.99 * E.max_step(x, d)), E(x), float((g * d).sum())
    value += E.round_off
    while not E(x + alpha * d) <= value + c * alpha * slope:
        alpha *= p
        if alpha < smallest:
            return 0.0
    return alpha
