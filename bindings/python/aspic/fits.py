"""Gradients of equilibria and motions with respect to the material, and fits to measurements."""
from __future__ import annotations

import os
import types
from typing import Any

import numpy as np

from . import _aspic
from ._checks import Floats, SceneState, Strict, count_of
from .scenes import scene_of


def lame(young, poisson) -> tuple[Any, Any]:
    """The Lame constants (mu, lambda) [Pa] of Young's modulus [Pa] and Poisson's ratio; numbers, arrays or tensors.

    >>> aspic.lame(young=2.5e5, poisson=0.25)
    (100000.0, 100000.0)
    """
    if isinstance(poisson, (int, float, np.ndarray)) and not np.all((-1 < poisson) & (poisson < .5)):
        raise _aspic.InvalidInput(f"poisson = {poisson}; expected more than -1 and less than 0.5")
    return young / (2 * (1 + poisson)), young * poisson / ((1 + poisson) * (1 - 2 * poisson))


class Equilibrium(Strict):
    """The body at rest as a function of its material: x(theta) = argmin V(x; theta).

    theta: (m, p) parameters per tet: mu, lambda [Pa] and those of the material; `parameters` are those of the scene.

    >>> scene = aspic.Scene()
    >>> body = scene.add(aspic.box((1, .2, .2), cells=(5, 1, 1))).pin([0, 1, 2, 3])
    >>> rest = aspic.Equilibrium(scene)
    >>> x = rest.solve(1.1 * rest.parameters)
    >>> rest.vjp(np.ones(x.shape)).shape == rest.parameters.shape
    True
    """

    _advice = "give parameters and start to solve()"

    def __init__(self, scene, tolerance=1e-9) -> None:
        scene = scene_of(scene)
        self._core = _aspic.Equilibrium(scene._source(), tolerance)
        self._scene_state = SceneState(scene, "equilibrium")

    @property
    def parameters(self) -> Floats:
        """The parameters of the scene, (m, p)."""
        return self._core.parameters

    @property
    def shape(self) -> tuple[int, ...]:
        """Of the result: (n, 3)."""
        return self._core.shape

    def solve(self, parameters=None, start=None) -> Floats:
        """Positions at rest, (n, 3) [m], from `start` or the last solution. Raises RuntimeError without convergence."""
        self._scene_state.require_unchanged()
        return self._core.solve(parameters, start)

    def vjp(self, qbar) -> Floats:
        """The gradient (m, p) of sum(qbar * x) at the last solution: one linear solve."""
        return self._core.vjp(qbar)

    def jvp(self, change) -> Floats:
        """The change (n, 3) of x for a change (m, p) of theta: one linear solve."""
        return self._core.jvp(change)

    def value_and_gradient(self, objective, parameters) -> tuple[float, Floats]:
        """objective(x) -> (value, dvalue/dx). Returns (value, dvalue/dtheta)."""
        value, qbar = objective(self.solve(parameters))
        return value, self.vjp(qbar)


class Trajectory(Strict):
    """The motion by backward Euler as a function of the material and the initial state.

    >>> scene = aspic.Scene()
    >>> body = scene.add(aspic.box(1, cells=1))
    >>> motion = aspic.Trajectory(scene, steps=3, h=0.01)
    >>> motion.simulate().shape
    (4, 8, 3)
    >>> sorted(motion.vjp(np.ones(motion.shape)))
    ['density', 'parameters', 'q', 'v']
    """

    _advice = "give parameters, q and v to simulate()"

    def __init__(self, scene, steps, h=0.0, tolerance=1e-9) -> None:
        scene = scene_of(scene)
        self._core = _aspic.Trajectory(scene._source(), count_of(steps, "steps", 1), h or 0.0, tolerance)
        self._scene_state = SceneState(scene, "trajectory")

    @property
    def parameters(self) -> Floats:
        """The parameters of the scene, (m, p)."""
        return self._core.parameters

    @property
    def shape(self) -> tuple[int, ...]:
        """Of the result: (steps + 1, n, 3)."""
        return self._core.shape

    def _set(self, parameters, q, v):
        self._scene_state.require_unchanged()
        if parameters is not None:
            self._core.set_parameters(parameters)
        if (q is None) != (v is None):
            raise _aspic.InvalidInput("q and v are set together")
        if q is not None:
            self._core.set_start(q, v)

    def simulate(self, parameters=None, q=None, v=None) -> Floats:
        """The motion, (steps + 1, n, 3) [m], for parameters (m, p) and the initial state q, v (n, 3)."""
        self._set(parameters, q, v)
        return self._core.simulate()

    def vjp(self, qbar) -> dict[str, Floats]:
        """The gradient of sum(qbar * motion): a dict with parameters (m, p), density (m,), q and v (n, 3)."""
        return self._core.vjp(qbar)

    def value_and_gradient(self, objective, parameters=None, q=None, v=None) -> tuple[float, dict[str, Floats]]:
        """objective(point, q, v) -> (value, dvalue/dq, dvalue/dv), summed over the points 0 ... steps.

        Derivatives may be None or missing. It is called once per point forward, and once more backward. Returns the
        value and its gradient, as vjp() does.
        """
        self._set(parameters, q, v)
        return self._core.value_and_gradient(objective)


def fit(data, model="neo_hookean", parameters=None, known=None, observe=None, out=None, **options) -> types.SimpleNamespace:
    """Fits a material to a data set, as `aspic fit` does.

    data: a folder, see inverse/docs/capture_format.md. parameters: {"young": "tets"}; known: {"poisson": 0.45}.
    observe(iteration, misfit, p) is called in every iteration; out: write the material to this .vtu file.
    options: those of the command line, such as uncertainty=False. Returns an object with quantities, by name: values
    per tet, their standard deviations `sigma` and reductions; misfit, status, verdict, reasons and warnings.
    """
    result = _aspic.fit(os.fspath(data), model, [f"{k}={v}" for k, v in (parameters or {}).items()],
                        [f"{k}={v}" for k, v in (known or {}).items()], options, observe,
                        None if out is None else os.fspath(out))
    result["history"] = np.array(result["history"])
    return types.SimpleNamespace(**result)


def capture(scene, folder, **options) -> list[str]:
    """Writes a synthetic data set of a scene of one pinned body, as `aspic capture` does; returns notes.

    options: indentations, depths, markers, deepest, tip_radius [m], noise, force_noise, regions, seed.
    """
    known = {"indentations", "depths", "markers", "deepest", "tip_radius", "noise", "force_noise", "regions", "seed"}
    if unknown_options := set(options) - known:
        raise _aspic.InvalidInput(f"unknown options {sorted(unknown_options)} (known: {', '.join(sorted(known))})")
    return _aspic.capture(scene_of(scene)._source(), os.fspath(folder), options)


def verify(name="", quick=True) -> dict[str, list[dict[str, Any]]]:
    """Runs problems with known answers: a family, one check, or all. Returns {check: [rows]}."""
    return _aspic.verify(name, quick)
