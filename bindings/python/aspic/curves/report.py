"""Tables and pictures of fits to curves."""
import math
import pathlib

import numpy as np

from .._aspic import InvalidInput
from ..recordings.tables import Table
from .fit import Curve, fit_curves
from .homogeneous import DEFORMATIONS, nominal_stress
from .table import read_curves


def markdown(fits):
    """A table of relative errors. fits: {(data, material): fit}."""
    lines = ["| data | material | parameters | uniaxial | equibiaxial | planar | all | R^2 |", "|---|---|---:|---:|---:|---:|---:|---:|"]
    for (data, material), fit in fits.items():
        errors = {e.name: f"{100 * e.relative:.1f} %" for e in fit.curves}
        free = sum(not p.is_held and not p.at_bound for p in fit.parameters)
        tests = " | ".join(errors.get(test, "") for test in DEFORMATIONS[:3])
        lines.append(f"| {data} | {material} | {free} | {tests} | {100 * fit.all.relative:.1f} % | {fit.all.r_squared:.5f} |")
    return "\n".join(lines)


def published(path, materials, **options):
    """A Markdown table of published errors and those of our fits to the same points, and whether all fits have converged."""
    table = Table(pathlib.Path(path))
    lines = [f"| data | tests | measure | published | of | {' | '.join(materials)} |", f"|---|---|---|---:|---|{'---:|' * len(materials)}"]
    converged = True
    for row in table.rows():
        curves = read_curves(pathlib.Path(path).parent / f"{row['data']}.csv", row["tests"].split())
        largest = [table.number(word) for word in row["largest_stretch"].split()]
        if None in largest:
            raise InvalidInput(f"{table.where}: '{row['largest_stretch']}' is no stretch; give one number per test, or leave it empty")
        least = table.number(row["least_stretch"])
        for k, c in enumerate(curves):
            kept = (c.stretch >= least) & (c.stretch <= (largest[k] if k < len(largest) else math.inf))
            curves[k] = Curve(c.deformation, c.stretch[kept], c.stress[kept])
        cells = [row["data"], row["tests"], row["measure"], f"{table.number(row['value']):.5g}", row["model"]]
        for material in materials:
            fit = fit_curves(curves, material, **options)
            converged &= fit.converged
            value = {"rms_MPa": 1e-6 * fit.all.rms, "rms_kPa": 1e-3 * fit.all.rms}.get(row["measure"], fit.all.r_squared)
            cells.append(f"{value:.5g}")
        lines.append(f"| {' | '.join(cells)} |")
    return "\n".join(lines), converged


def plot(fits, title="", axes=None):
    """Draws measured points and fitted lines of fits to the same curves. Returns the axes of matplotlib."""
    if axes is None:
        import matplotlib.pyplot as pyplot
        axes = pyplot.figure(figsize=(7, 4.5)).add_subplot()
    largest = max(np.abs(c.stress).max() for c in fits[0].data)
    unit, name = (1e6, "MPa") if largest >= 1e5 else (1e3, "kPa") if largest >= 1e2 else (1, "Pa")
    for k, c in enumerate(fits[0].data):
        axes.plot(c.stretch, c.stress / unit, "o", color=f"C{k}", markersize=4, label=c.deformation)
        l = np.linspace(c.stretch.min(), c.stretch.max(), 201)
        for a, fit in enumerate(fits):
            found = nominal_stress(fit.material, fit.theta, c.deformation, l, fit.incompressible)
            if found:
                axes.plot(l, found[0] / unit, "-" if a == 0 else "--", color=f"C{k}", label=fit.material if k == 0 else None)
    axes.set(xlabel="stretch, or amount of shear", ylabel=f"nominal stress [{name}]", title=title)
    axes.legend()
    return axes
