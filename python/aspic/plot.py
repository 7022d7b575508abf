"""Pictures with matplotlib. Every function draws into `ax`, or into new axes, and returns them."""
import numpy as np


def _axes(ax, **how):
    if ax is not None:
        return ax
    import matplotlib.pyplot as plt
    return plt.figure(figsize=how.pop("figsize", (6, 3.5))).add_subplot(**how)


def energies(run, ax=None):
    """Kinetic, potential and total energy over time. run: a Run or Reports."""
    ax, rows = _axes(ax), run.steps if hasattr(run, "steps") and not isinstance(run, list) else run
    time, kinetic, potential = rows["time"], rows["kinetic"], rows["potential_total"]
    for label, values in (("kinetic", kinetic), ("potential", potential), ("total", kinetic + potential)):
        ax.plot(time, values, label=label)
    ax.set(xlabel="time [s]", ylabel="energy [J]")
    ax.legend()
    return ax


def convergence(traces, ax=None):
    """|g| over iterations. traces: a Trace, or a dict of them by label."""
    ax = _axes(ax)
    for label, trace in (traces.items() if isinstance(traces, dict) else (("", traces),)):
        ax.semilogy(trace["index"], trace["gradient_norm"], ".-", label=label)
    ax.set(xlabel="iteration", ylabel="|g|")
    if isinstance(traces, dict):
        ax.legend()
    return ax


def line_search(curve, trials=None, ax=None):
    """E along a search direction with its quadratic model and the bound of the decrease test. curve: it.curve()."""
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


def landscape(plane, ax=None, levels=30):
    """Contours of E on the plane of the search direction. plane: it.slice()."""
    ax, value = _axes(ax, figsize=(5, 4)), np.ma.masked_invalid(plane["value"])
    picture = ax.contourf(plane["s"], plane["t"], value, levels)
    ax.figure.colorbar(picture, ax=ax, label="E")
    ax.plot([0, 1], [0, 0], "w.-")
    ax.set(xlabel="s: x + s d", ylabel="t: across d")
    return ax


def contours(f, lower, upper, path=None, ax=None, levels=30, samples=101):
    """Contours of a function of two variables, and the points that a minimizer visited, (k, 2)."""
    ax = _axes(ax, figsize=(5, 4))
    X, Y = np.meshgrid(np.linspace(lower[0], upper[0], samples), np.linspace(lower[1], upper[1], samples))
    Z = np.array([f(p) for p in np.column_stack([X.ravel(), Y.ravel()])]).reshape(X.shape)
    ax.contour(X, Y, np.log10(Z - Z.min() + 1e-6 * np.ptp(Z)), levels, linewidths=.7)
    if path is not None:
        ax.plot(*np.asarray(path).T, "k.-", linewidth=1)
    ax.set(xlabel="x", ylabel="y")
    return ax


def body(q, tets, values=None, ax=None, label=""):
    """The boundary of a body; values: one per tet or vertex, as colors."""
    from . import _aspic
    ax = _axes(ax, figsize=(5, 4), projection="3d")
    triangles = _aspic.boundary(q, tets)
    picture = ax.plot_trisurf(q[:, 0], q[:, 2], q[:, 1], triangles=triangles, linewidth=.1, edgecolor="k",
                              color=None if values is not None else "tab:blue", cmap="viridis")
    if values is not None:
        values = np.asarray(values)
        if len(values) == len(tets):
            total, count = np.zeros(len(q)), np.zeros(len(q))
            np.add.at(total, tets, values[:, None])
            np.add.at(count, tets, 1)
            values = total / np.maximum(count, 1)
        picture.set_array(values[triangles].mean(axis=1))
        ax.figure.colorbar(picture, ax=ax, label=label)
    ax.set_aspect("equal")
    ax.set(xlabel="x", ylabel="z", zlabel="y")
    return ax
