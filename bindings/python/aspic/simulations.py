"""Simulations, their reports and the trace of their minimizations."""
from __future__ import annotations

import os
import re
import tempfile
import warnings
from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import _aspic
from ._checks import Floats, Ints, SceneState, Strict, count_of, read_only
from .notebook import Player, in_notebook
from .results import Run
from .scenes import Scene, scene_of


class NotConverged(RuntimeError):
    """A step did not converge; `report` is that of the step."""

    def __init__(self, report) -> None:
        super().__init__(f"step {report.step}: {report.status}; {report.explanation}")
        self.report = report

    def __reduce__(self):
        return NotConverged, (self.report,)


class Reports(list):
    """The reports of several steps. reports["iterations"] is a column as an array."""

    def __getitem__(self, key) -> Any:
        if isinstance(key, str):
            return np.array([report.to_dict()[key] if not hasattr(report, key) else getattr(report, key)
                             for report in self])
        found = super().__getitem__(key)
        return Reports(found) if isinstance(key, slice) else found

    def __add__(self, other) -> Reports:
        return Reports(super().__add__(other))


class Simulation(Strict):
    """Advances a scene in time.

    scene: a Scene, or the path of a scene or a mesh. h: time step [s]. solver: keys of [solver], such as
    {"method": "lbfgs"}, or a method. out: folder of the results, as of `aspic run`; without one the motion is kept in a temporary
    folder for show() and results() (record=False: not at all).

    Changes of the scene afterwards raise in step(): restore(snapshot) continues in a simulation of the changed scene.
    Arrays of properties are read-only copies; assign q or v as a whole.

    >>> scene = aspic.Scene()
    >>> body = scene.add(aspic.box(0.1, cells=2))
    >>> sim = aspic.Simulation(scene, h=0.01)
    >>> reports = sim.run(10, check=True)
    >>> round(sim.time, 6), round(float(sim.v[:, 1].mean()), 6)
    (0.1, -0.981)
    """

    _advice = "the attributes q and v can be set; other settings belong to the scene or the constructor"

    def __init__(self, scene, h=None, solver=None, integrator=None, out=None, overwrite=False, record=True) -> None:
        self._scene = scene_of(scene)
        settings = {"time.step": h, "time.integrator": integrator,
                    **{f"solver.{key}": value for key, value in _solver_keys(solver or {}).items()}}
        try:
            source = self.scene._source({key: value for key, value in settings.items() if value is not None})
            self._core = _aspic.Simulation(source)
        except _aspic.InvalidInput as error:
            raise _aspic.InvalidInput(re.sub(r"^\S+ ?time\.step\S* step = ", "h = ", str(error))) from None
        for text in self._core.warnings:
            warnings.warn(text, stacklevel=2)
        self._scene_state = SceneState(self.scene, "simulation")
        self._inputs = self.scene._inputs  # files that the recording copies
        self._folder = out
        self._record = record
        if out is not None:
            self._start_recording(out, overwrite)

    def _start_recording(self, out, overwrite):
        try:
            self._core.record(os.fspath(out), False, overwrite)
        except _aspic.InvalidInput as error:
            remedies = "--force replaces it, --resume continues it"
            raise _aspic.InvalidInput(str(error).replace(remedies, "overwrite=True replaces it")) from None

    def __reduce__(self):
        raise TypeError("a simulation cannot be copied or pickled: restore its snapshot() in another one of the same scene")

    def __repr__(self):
        return f"<Simulation {self.name}: {len(self._core.rest)} vertices, step {self.steps_taken}>"

    @property
    def scene(self) -> Scene:
        """The scene that this was made of."""
        return self._scene

    # --- state ---------------------------------------------------------------------------------------------------------
    @property
    def q(self) -> Floats:
        """Positions, (n, 3) [m]. Assigning changes the state and ends the recording; fixed pins hold the new positions."""
        return read_only(self._core.q)

    @q.setter
    def q(self, q) -> None:
        self._core.set_q(q)

    @property
    def v(self) -> Floats:
        """Velocities, (n, 3) [m/s]. Assigning changes the state and ends the recording; those of pins are 0 or as before."""
        return read_only(self._core.v)

    @v.setter
    def v(self, v) -> None:
        self._core.set_v(v)

    @property
    def time(self) -> float:
        """At the end of the last step [s]."""
        return self._core.time

    @property
    def h(self) -> float:
        """Time step [s]."""
        return self._core.h

    @property
    def steps_taken(self) -> int:
        """Since time 0."""
        return self._core.steps_taken

    @property
    def name(self) -> str:
        """Name of the scene."""
        return self._core.name

    @property
    def notes(self) -> list[str]:
        """Chosen defaults and warnings, as sentences. The constructor gives the latter as Python warnings, too."""
        return self._core.notes

    @property
    def solver(self) -> str:
        """The methods and the reasons for their choice."""
        return self._core.solver

    @property
    def state_hash(self) -> str:
        """As in steps.csv: 16 digits, for any number of threads."""
        return self._core.state_hash

    @property
    def rest(self) -> Floats:
        """Rest positions, (n, 3) [m]."""
        return read_only(self._core.rest)

    @property
    def tets(self) -> Ints:
        """Vertices of each tet, (m, 4)."""
        return read_only(self._core.tets)

    @property
    def triangles(self) -> Ints:
        """Vertices of each triangle of the sheets, (k, 3)."""
        return read_only(self._core.triangles)

    @property
    def mass(self) -> Floats:
        """Mass of each vertex, (n,) [kg]."""
        return read_only(self._core.mass)

    @property
    def pinned(self) -> NDArray[np.bool_]:
        """Whether a pin holds each vertex, (n,)."""
        return read_only(self._core.pinned)

    @property
    def bodies(self) -> dict[str, dict[str, slice]]:
        """{name: {"vertices": slice, "tets": slice, "triangles": slice}}: sim.q[sim.bodies["jelly"]["vertices"]]."""
        keys = ("vertices", "tets", "triangles")
        return {b["name"]: {key: b[key] for key in keys} for b in self._core.bodies}

    def fields(self) -> dict[str, Floats]:
        """Quantities of each tet: energy_density [J/m^3], det_F, cauchy (m, 6) and von_mises [Pa], young, poisson."""
        return self._core.fields()

    def reactions(self) -> Floats:
        """Forces of the pins on the vertices in the last step, (n, 3) [N]; NaN before the first."""
        return self._core.reactions()

    def mesh_error(self) -> dict[str, Any]:
        """Estimates by how much linear tets are too stiff at the current state, see docs/verification.md.

        Returns a dict: "text"; "reliable"; and if there is an estimate, {body: value} for
        "stiffness" (that of the mesh over that of the body, minus 1; NaN: not strained) and "energy" [J], "density" of
        each tet, (m,) [J/m^3], and "direction" d, (n, 3) [m]: the estimated error of any function f(q), such as the
        position of a probe, is -(df/dq * d).sum().
        """
        return self._core.mesh_error()

    def snapshot(self) -> _aspic.Snapshot:
        """The state with everything that later steps depend on. It can be pickled."""
        return self._core.snapshot()

    def restore(self, snapshot) -> None:
        """Returns to a snapshot; later steps have the same bits. Ends the recording."""
        self._core.restore(snapshot)

    # --- steps ---------------------------------------------------------------------------------------------------------
    def step(self, observe=None, direction=None, line_search=None) -> _aspic.StepReport:
        """Takes one step and returns its StepReport.

        observe(iteration) is called in every iteration; if it returns False, the step is dropped. The state stays
        after an exception or Ctrl-C.
        direction(E, x, g) -> d and line_search(E, x, d, g) -> alpha replace those of the solver in this step. Pinned
        entries of d are set to 0. An alpha of 0 ends the step as `stuck`.
        """
        self._scene_state.require_unchanged(": new = aspic.Simulation(scene); new.restore(sim.snapshot())")
        if self._record and self._folder is None and not self._core.is_recording and self.steps_taken == 0:
            self._temporary = tempfile.TemporaryDirectory(prefix="aspic-run-", ignore_cleanup_errors=True)
            self._core.record(os.path.join(self._temporary.name, "run"), True, True)
        return self._core.step(observe, direction, line_search)

    def steps(self, count=None, observe=None, check=False, **method) -> Iterator[_aspic.StepReport]:
        """Takes steps one by one and yields their reports. count: by default to the end of the scene's duration.

        check: raise NotConverged at the first step that does not converge. method: direction and line_search of step().
        """
        last = self._last(count)
        while self.steps_taken < last:
            report = self.step(observe, **method)
            if report.status == "interrupted":
                return
            if check and not report.ok:
                raise NotConverged(report)
            yield report

    def _last(self, count):
        """Number of the last step of `count` steps from now on."""
        if count is None:
            return self._core.steps_of_run
        return self.steps_taken + count_of(count, "count", 0)

    def run(self, count=None, observe=None, check=False, progress=False, **method) -> Reports:
        """Takes steps, see steps(), and returns their Reports; progress: show a line about them."""
        reports = Reports()
        last = self._last(count)
        show = _progress(last) if progress else None
        for report in self.steps(count, observe, check, **method):
            reports.append(report)
            if show:
                show(report)
        if self._folder is not None:
            self._core.flush()
        return reports

    def objective(self) -> _aspic.StepObjective:
        """E(q) of the next steps as a function of its own: E(q), E.gradient(q), E.hessian(q), E.begin_step(q, v, h)."""
        self._scene_state.require_unchanged()
        return self._core.objective()

    # --- results -------------------------------------------------------------------------------------------------------
    def results(self) -> Run:
        """The recorded Run so far."""
        if not self._core.is_recording:
            raise RuntimeError("nothing is recorded: take a step first, and neither assign the state nor use record=False")
        self._core.flush()
        return Run(self._folder if self._folder is not None else os.path.join(self._temporary.name, "run"))

    def show(self, height=600) -> Player:
        """The recorded motion as a page for notebooks, see Run.show()."""
        return self.results().show(height)


def _solver_keys(solver):
    """Keys of [solver], of which a name is the method."""
    if isinstance(solver, str):
        return {"method": solver}
    if not isinstance(solver, dict):
        raise _aspic.InvalidInput(f"solver: this is {type(solver).__name__}; expected a dict or the name of a method")
    return solver


def _progress(last):
    """A function that shows the last report, in a notebook or on the terminal, at most five times per second."""
    import time

    shown = [0.0]
    handle = []

    def show(report):
        now = time.monotonic()
        if now - shown[0] < 0.2 and report.step < last:
            return
        shown[0] = now
        line = f"step {report.step}/{last}: {report.status}, {report.iterations} iterations, t = {report.time:.4g} s"
        if in_notebook():
            from IPython.display import display
            if handle:
                handle[0].update({"text/plain": line}, raw=True)
            else:
                handle.append(display({"text/plain": line}, raw=True, display_id=True))
        else:
            print("\r" + line, end="\n" if report.step >= last else "", flush=True)

    return show


class Trace:
    """An observer that keeps what every iteration did: sim.step(observe=trace), then trace["gradient_norm"].

    Columns as in trace/iterations.csv; `trials`: an array per iteration with the columns alpha, value, bound, accepted and
    by_slope. landscape: also sample E along each direction (curves) and on a plane (slices).

    >>> scene = aspic.Scene()
    >>> body = scene.add(aspic.box(0.1, cells=2)).pin([0])
    >>> trace = aspic.Trace()
    >>> report = aspic.Simulation(scene, h=0.01).step(observe=trace)
    >>> len(trace["gradient_norm"]) == report.iterations
    True
    """

    def __init__(self, landscape=False, samples=41) -> None:
        self.iterations, self.trials, self.curves, self.slices = [], [], [], []
        self._landscape, self._samples = landscape, samples

    def __call__(self, it) -> None:
        self.iterations.append({"index": it.index, "value": it.value, "gradient_norm": it.gradient_norm,
                                "decrement": it.decrement, "alpha": it.alpha, "trials": len(it.trials),
                                "fallbacks": it.fallbacks, "gradients": it.gradients, **it.work})
        self.trials.append(it.trials)
        if self._landscape:
            self.curves.append(it.curve())
            self.slices.append(it.slice(self._samples))

    def __getitem__(self, column) -> NDArray[Any]:
        return np.array([row[column] for row in self.iterations])

    def __len__(self) -> int:
        return len(self.iterations)


def compare(scene, methods, step=1, max_seconds=60) -> dict[str, dict[str, Any]]:
    """Solves one step by several methods, each from the same state, as `aspic compare` does.

    methods: dicts of [solver] keys or names of methods. max_seconds: limit per method. Returns a dict per method: its
    report; trace, the columns index, value, gradient_norm, gradients, hessians and seconds over iterations; the
    fastest of up to three runs [s]; distance, the largest of a vertex from the minimizer [m]; excess, that of E
    relative to the start; same_minimizer; description.

    >>> scene = aspic.Scene()
    >>> body = scene.add(aspic.box(0.1, cells=2)).pin([0])
    >>> sorted(aspic.compare(scene, ["newton", "lbfgs"]))
    ['lbfgs', 'newton']
    """
    scene = scene_of(scene)
    tables = [_solver_keys(method) for method in ([methods] if isinstance(methods, (str, dict)) else methods)]
    sources = [(", ".join(str(value) for value in table.values()),
                scene._source({f"solver.{key}": value for key, value in table.items()})) for table in tables]
    results = _aspic.compare(scene._source(), sources, step, max_seconds)
    return {result.pop("name"): result for result in results}
