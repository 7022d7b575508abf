"""Tables of measured curves."""
import math
import pathlib

import numpy as np

from .._aspic import InvalidInput
from ..recordings.tables import Table
from .fit import Curve, is_stretch, suggestion
from .homogeneous import DEFORMATIONS

UNITS = {"stress_Pa": 1.0, "stress_kPa": 1e3, "stress_MPa": 1e6}


def read_curves(path, tests=()):
    """Reads a table with the columns test, stretch (or amount of shear), and the nominal stress as stress_Pa, stress_kPa or
    stress_MPa. Returns a curve per test, in order of first appearance; `tests` selects some."""
    table = Table(pathlib.Path(path))
    for column in ("test", "stretch"):
        if column not in table.columns:
            raise InvalidInput(f"{table.file}:1: missing column '{column}'; expected test, stretch, and stress_Pa, stress_kPa or "
                               f"stress_MPa; found {', '.join(table.columns[:12])} (from a testing machine: stretch = 1 + strain, or "
                               "1 + strain / 100 of percent; stress = force / area at rest; test = uniaxial, equibiaxial, planar or "
                               "simple_shear)")
    units = [unit for unit in UNITS if unit in table.columns]
    if len(units) != 1:
        raise InvalidInput(f"{table.file}:1: has {'more than one' if units else 'no'} column of stresses; give the nominal stress in "
                           "one column stress_Pa, stress_kPa or stress_MPa")
    points = {}
    for cells in table.rows():
        test, stretch, stress = cells["test"], table.number(cells["stretch"]), table.number(cells[units[0]])
        if test not in DEFORMATIONS:
            raise InvalidInput(f"{table.where}: the test '{test}' is unknown{suggestion(test, DEFORMATIONS)}")
        if not is_stretch(test, stretch):
            raise InvalidInput(f"{table.where}: stretch = {cells['stretch']}; give length over rest length, 1 at rest")
        if stress is None or not math.isfinite(stress):
            raise InvalidInput(f"{table.where}: the stress {cells[units[0]]} is not a number; remove the row")
        points.setdefault(test, []).append((stretch, stress * UNITS[units[0]]))
    if not points:
        raise InvalidInput(f"{table.file}: has no rows; give one per measured point")
    for test in tests:
        if test not in points:
            raise InvalidInput(f"{table.file}: has no test '{test}'{suggestion(test, list(points))}")
    return [Curve(test, *np.array(p).T) for test, p in points.items() if not tests or test in tests]
