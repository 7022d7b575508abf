"""Pictures with matplotlib. Every function draws into `ax`, or into new axes, and returns them."""
from __future__ import annotations

from typing import Any

import numpy as np


def _axes(ax, **how):
    if ax is not None:
        return ax
    import matplotlib.pyplot as plt
    return plt.figure(figsize=how.pop("figsize", (6, 3.5))).add_subplot(**how)


def energies(run, ax=None) -> Any:
    """Kinetic, potential and total energy over time. run: Reports, a Run, or a Simulation that is recorded."""
    run = run.results() if hasattr(run, "results") else run
    ax, rows = _axes(ax), run if isinstance(run, list) else run.steps
    time, kinetic, potential = rows["time"], rows["kinetic"], rows["potential_total"]
    for label, values in (("kinetic", kinetic), ("potential", potential), ("total", kinetic + potential)):
        ax.plot(time, values, label=label)
    ax.set(xlabel="time [s]", ylabel="energy [J]")
    ax.legend()
    return ax


def convergence(traces, ax=None) -> Any:
    """|g| over iterations. traces: a Trace, a result of compare(), or a dict of either by label, such as compare()."""
    ax = _axes(ax)
    has_labels = isinstance(traces, dict) and not {"trace", "gradient_norm"} & set(traces)
    for label, trace in (traces if has_labels else {"": traces}).items():
        trace = trace["trace"] if isinstance(trace, dict) and "trace" in trace else trace
        ax.semilogy(trace["index"], trace["gradient_norm"], ".-", label=label)
    ax.set(xlabel="iteration", ylabel="|g|")
    if has_labels:
        ax.legend()
    return ax


def line_search(curve, trials=None, ax=None) -> Any:
    """E along a search direction with its quadratic model and the bound of the decrease test.

    curve: it.curve(), or an Iteration `it` inside its observer, with its trials.
    """
    if hasattr(curve, "curve"):
        curve, trials = curve.curve(), curve.trials if trials is None else trials
    ax = _axes(ax)
    ax.plot(curve["alpha"], curve["value"], label="E")
    ax.plot(curve["alpha"], curve["model"], "--", label="quadratic model")
    ax.plot(curve["alpha"], curve["textbook_bound"], ":", label="sufficient decrease")
    if trials is not None:
        accepted = trials[:, 3] > 0
        ax.plot(trials[~accepted, 0], trials[~accepted, 1], "x", color="C3", label="rejected")
        ax.plot(trials[accepted, 0], trials[accepted, 1], "o", color="C2", label="accepted")
    finite = curve["value"][np.isfinite(curve["value"])]
    if finite.size:
        low, high = min(finite.min(), curve["model"].min()), finite.max()
        ax.set_ylim(low - .05 * (high - low), high + .05 * (high - low))
    ax.set(xlabel="alpha", ylabel="E")
    ax.legend()
    return ax


def landscape(plane, ax=None, levels=30) -> Any:
    """Contours of E on the plane of the search direction. plane: it.slice(), or an Iteration inside its observer."""
    plane = plane.slice() if hasattr(plane, "slice") else plane
    ax, value = _axes(ax, figsize=(5, 4)), np.ma.masked_invalid(plane["value"])
    picture = ax.contourf(plane["s"], plane["t"], value, levels)
    ax.figure.colorbar(picture, ax=ax, label="E")
    ax.plot([0, 1], [0, 0], "w.-")
    ax.set(xlabel="s: x + s d", ylabel="t: across d")
    return ax


def contours(f, lower, upper, path=None, ax=None, levels=30, samples=101) -> Any:
    """Contours of a function of two variables, and the points that a minimizer visited, (k, 2)."""
    ax = _axes(ax, figsize=(5, 4))
    X, Y = np.meshgrid(np.linspace(lower[0], upper[0], samples), np.linspace(lower[1], upper[1], samples))
    Z = np.array([f(p) for p in np.column_stack([X.ravel(), Y.ravel()])]).reshape(X.shape)
    ax.contour(X, Y, np.log10(Z - Z.min() + 1e-6 * np.ptp(Z)), levels, linewidths=.7)
    if path is not None:
        ax.plot(*np.asarray(path).T, "k.-", linewidth=1)
    ax.set(xlabel="x", ylabel="y")
    return ax


def body(shape, tets=None, values=None, ax=None, label="") -> Any:
    """The boundary of a body. shape: a Simulation, a Mesh, a Body of a scene, or positions (n, 3) with `tets`.

    values: one per tet or vertex, as colors; of a Simulation also the name of a field, such as "von_mises".
    """
    from . import _aspic
    if hasattr(shape, "tets"):
        if values is None and np.ndim(tets) != 2:  # body(sim, values)
            tets, values = None, tets
        if isinstance(values, str):
            label, values = label or values, _field(shape, values)
        shape, tets = shape.q if hasattr(shape, "q") else shape.vertices, shape.tets if tets is None else tets
    if tets is None:
        raise _aspic.InvalidInput("body(q, tets): positions need the tets; or give a Simulation, a Mesh or a Body")
    q, tets = np.asarray(shape), np.asarray(tets)
    triangles = _aspic.boundary(q, tets)
    values = None if values is None else _of_triangles(np.asarray(values), q, tets, triangles)
    ax = _axes(ax, figsize=(5, 4), projection="3d")
    color = {"color": "tab:blue"} if values is None else {"cmap": "viridis"}
    picture = ax.plot_trisurf(q[:, 0], q[:, 2], q[:, 1], triangles=triangles, linewidth=.1, edgecolor="k", **color)
    if values is not None:
        picture.set_array(values)
        ax.figure.colorbar(picture, ax=ax, label=label)
    ax.set_aspect("equal")
    ax.set(xlabel="x", ylabel="z", zlabel="y")
    return ax


def _field(sim, name):
    from . import _aspic
    fields = sim.fields() if hasattr(sim, "fields") else {}
    if name not in fields:
        raise _aspic.InvalidInput(f"values: no field '{name}' (known: {', '.join(fields) or 'none, without a Simulation'})")
    return fields[name]


def _of_triangles(values, q, tets, triangles):
    """Means over the vertices of each triangle, of values per tet or vertex."""
    from . import _aspic
    if values.shape == (len(tets),):
        total, count = np.zeros(len(q)), np.zeros(len(q))
        np.add.at(total, tets, values[:, None])
        np.add.at(count, tets, 1)
        values = total / np.maximum(count, 1)
    if values.shape != (len(q),):
        raise _aspic.InvalidInput(f"values: shape {values.shape}; expected ({len(tets)},), one per tet, or ({len(q)},), "
                                  "one per vertex")
    return values[triangles].mean(axis=1)
