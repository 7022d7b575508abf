"""Tables of comma-separated values of other programs, and those of image correlation, recognized by their columns."""
import csv
import dataclasses
import math

import numpy as np

from .recording import InvalidInput, Recording, Sequence, number_of, printable, read_bytes, shown


class Table:
    """Rows of cells. Cells are separated by commas, semicolons (with decimal commas or points) or tabs, with blanks around
    them. Empty lines, lines that begin with # and lines above the header that begin with *** (DICe) are skipped."""

    def __init__(self, path):
        self.path, self.file = path, printable(path)
        contents = read_bytes(path)
        self.size = len(contents)
        text = contents.removeprefix(b"\xef\xbb\xbf").decode("utf-8", "backslashreplace")
        self._lines = enumerate(text.split("\n"), 1)
        self.line, self.separator, self.columns = 0, ",", None
        head = self._next()
        if head is None:
            raise InvalidInput(f"{self.file}: is empty; a table begins with its column names")
        while len(head) > 1 and not head[-1]:
            head.pop()  # a separator at the end of the header names no column
        self.columns = head

    @property
    def where(self):
        return f"{self.file}:{self.line}"

    def _next(self):
        for self.line, line in self._lines:
            if line.strip(" \t\r") and not line.startswith("#") and not (self.columns is None and line.startswith("***")):
                break
        else:
            return None
        if self.columns is None:
            self.separator = next((c for c in ",;\t" if c in line), ",")
        if '"' in line:
            csv.field_size_limit(len(line) + 1)
            cells = next(csv.reader([line.replace("\r", "").replace("\0", "\\0")], delimiter=self.separator))
        else:
            cells = line.split(self.separator)
        return [printable(cell.strip(" \t\r")) for cell in cells]

    def rows(self):
        """Yields {column: text}."""
        while (cells := self._next()) is not None:
            while len(cells) > len(self.columns) and not cells[-1]:
                cells.pop()
            if len(cells) != len(self.columns):
                raise InvalidInput(f"{self.where}: has {len(cells)} cells; the header has {len(self.columns)} (is the row torn, "
                                   "or a separator inside a text without quotes?)")
            yield dict(zip(self.columns, cells))

    def number(self, text):
        """None if it is no number."""
        return number_of(text if self.separator == "," else text.replace(",", "."))


@dataclasses.dataclass(frozen=True)
class Dialect:
    """Columns of a program. Coordinates and displacements are three columns, or two of an image."""
    program: str
    coordinates: tuple
    displacements: tuple
    name: str = ""  # column with the name of a point
    failed: str = ""  # column that is negative, or 0 for `is_flag`, where the correlation failed; may be missing
    is_flag: bool = False
    is_current: bool = False  # the coordinates are those after the displacement
    unit: float | None = None  # [m]


DIALECTS = (  # the more specific ones come first
    Dialect("DICe (stereo)", tuple(f"MODEL_COORDINATES_{a}" for a in "XYZ"), tuple(f"MODEL_DISPLACEMENT_{a}" for a in "XYZ"),
            "SUBSET_ID", "SIGMA"),
    Dialect("DICe (2D)", ("COORDINATE_X", "COORDINATE_Y"), ("DISPLACEMENT_X", "DISPLACEMENT_Y"), "SUBSET_ID", "SIGMA"),
    Dialect("pyvale (stereo)", tuple(f"stereo_{a}_mm" for a in "xyz"), tuple(f"stereo_disp_{a}_mm" for a in "uvw"),
            failed="stereo_converged", is_flag=True, is_current=True, unit=1e-3),
    Dialect("pyvale (2D)", ("subset_x", "subset_y"), ("disp_u", "disp_v"), failed="converged", is_flag=True),
    Dialect("pyvale (2D, displacement_u)", ("subset_x", "subset_y"), ("displacement_u", "displacement_v"), failed="converged",
            is_flag=True),  # earlier versions
    Dialect("x, y, z, ux, uy, uz", ("x", "y", "z"), ("ux", "uy", "uz"), "id"),
    Dialect("muDIC", ("x", "y"), ("ux", "uy"), "id", is_current=True),
    Dialect("X, Y, Z, U, V, W", ("X", "Y", "Z"), ("U", "V", "W"), "id", "sigma"),
)


def dialect_of(table):
    required = {d: [c for c in d.coordinates + d.displacements if c not in table.columns] for d in DIALECTS}
    for dialect, missing in required.items():
        if not missing:
            return dialect
    common = {d: len(d.coordinates + d.displacements) - len(missing) for d, missing in required.items()}
    nearest = max(DIALECTS, key=common.get)
    lacks = f"; for a table of {nearest.program} it lacks {', '.join(required[nearest])}" if common[nearest] else ""
    raise InvalidInput(f"{table.where}: is no table of image correlation{lacks}; known are those of DICe, pyvale and muDIC, and "
                       "tables with the columns X, Y, Z, U, V, W")


def read_correlation(files):
    """One table per frame, counted from 1. Frame 0 is the reference."""
    file, sequence, first = printable(files[0]), Sequence(), None
    sequence.add({}, 0, file)
    for path in files:
        table = Table(path)
        dialect = dialect_of(table)
        first = first or dialect
        if dialect is not first:
            raise InvalidInput(f"{table.file}:1: has the columns of {dialect.program}, but the first file those of "
                               f"{first.program}; export all frames alike")
        sequence.add(_frame(table, dialect, sequence), table.size, table.file)
    notes = [f"{file}: results of {first.program}; frame 0 is the reference"]
    where = [f"{file} (reference)", *map(printable, files)]
    return Recording(file, list(sequence.index), sequence.positions(), list(range(len(where))), where,
                     is_planar=len(first.coordinates) == 2, unit=first.unit, notes=notes).checked(sequence.size)


def _frame(table, dialect, sequence):
    rest, now = sequence.frames[0], {}
    for row, cells in enumerate(table.rows(), 1):
        name = _name(table, cells.get(dialect.name, str(row)))
        at_rest, here = _positions(table, cells, dialect)
        point = sequence.point(name)
        if not np.isnan(now.get(point, math.nan)).any():
            raise InvalidInput(f"{table.where}: the point '{name}' is there twice; remove one")
        if np.isnan(rest.get(point, math.nan)).any():
            rest[point] = at_rest
        now[point] = here
    return now


def _name(table, text):
    """DICe writes whole numbers as 1.000E+00."""
    number = table.number(text) if any(c in text for c in ".eE") else None
    return str(int(number)) if number is not None and abs(number) < 2e9 and number == int(number) else text


def _positions(table, cells, dialect):
    """At rest and in this frame; NaN if the correlation failed."""

    def number(column):
        value = table.number(cells[column]) if cells[column] else math.nan
        if value is None:
            raise InvalidInput(f"{table.where}: {column} = {shown(cells[column])} is not a number; leave the cell blank if the "
                               "point was lost")
        return value if math.isfinite(value) else math.nan

    def vector(columns):
        return np.array([*map(number, columns), 0.0][:3])

    stated, u, lost = vector(dialect.coordinates), vector(dialect.displacements), np.full(3, np.nan)
    quality = number(dialect.failed) if dialect.failed in cells else 1.0
    has_failed = not (quality > 0 if dialect.is_flag else quality >= 0)
    if has_failed or np.isnan(stated + u).any():
        return lost if dialect.is_current or np.isnan(stated).any() else stated, lost
    return (stated - u, stated) if dialect.is_current else (stated, stated + u)
