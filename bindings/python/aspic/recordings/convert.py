"""Writes recordings as the tables that Aspic reads."""
import csv
import os
import pathlib
import tomllib

import numpy as np

from .read import read_recording
from .recording import InvalidInput, length_unit, printable
from .tables import Table

NOT_MEASURED = 1e3  # standard deviation of a coordinate that was not measured, over the extent of the points
TABLES = {"markers": "markers.csv", "cases": "cases.csv", "positions": "positions.csv"}


def write_table(path, rows, separator=","):
    """Replaces the file when all is written."""
    temporary = path.with_name(path.name + ".part")
    with open(temporary, "w", newline="", encoding="utf-8") as file:
        csv.writer(file, delimiter=separator, lineterminator="\n").writerows(rows)
    os.replace(temporary, path)


def unit_of(text):
    """A unit by its name, or its size in m."""
    try:
        unit = length_unit(str(text)) or float(text)
    except ValueError:
        unit = 0
    if not 0 < unit < float("inf"):
        raise InvalidInput(f"unit = {text}: give m, cm, mm, um, in, or the size of the unit (of a pixel) in m")
    return unit


def to_motion(recording, table, unit=None, force=False):
    """Writes a table for aspic fit-motion: time [s] since the first frame, marker, x, y, z [m]. Returns notes."""
    r, table = read_recording(recording), pathlib.Path(table)
    notes = list(r.notes)
    if table.exists() and not force:
        raise InvalidInput(f"{printable(table)}: exists; choose another name, or overwrite it with --force")
    if r.times is None:
        raise InvalidInput(f"{r.file}: has no times, which a motion needs; give each frame its time")
    if r.is_planar:
        raise InvalidInput(f"{r.file}: has two coordinates per point; fit-motion needs three")
    scale = unit_of(unit) if unit else r.unit or 1.0
    if not unit and not r.unit:
        notes.append(f"{r.file}: states no unit of length; positions count as meters")
    if r.times[0] != 0:
        notes.append(f"{r.file}: the first frame, at {r.times[0]:.9g} s, is the time 0")
    is_seen = ~np.isnan(r.positions[..., 0])
    used = np.flatnonzero(is_seen[0])
    if len(used) < len(r.names):
        notes.append(f"{r.file}: {len(r.names) - len(used)} markers were not seen in the first frame, which places them on the "
                     "body; they are not used")
    if len(used) == 0:
        raise InvalidInput(f"{r.file}: no marker was seen in the first frame; remove leading frames")
    rows = [("time", "marker", "x", "y", "z")]
    for i in used:
        for f in np.flatnonzero(is_seen[:, i]):
            rows.append((r.times[f] - r.times[0], r.names[i], *(float(scale * x) for x in r.positions[f, i])))
    write_table(table, rows)
    return notes


def to_data_set(recording, folder, unit=None, rest_frame=None, force=False):
    """Writes the positions of the cases of a data set, and the markers at rest, to its tables. Returns notes.

    The columns frame or time [s] of the table of cases select a frame for each. `rest_frame` shows the body at rest; default:
    the first. Without a table of markers, all points that it shows are markers; otherwise those of the table, whose rows need
    a name only. `unit`: of the recording; default: units.recording of capture.toml, that of the file, or units.length.
    """
    return _DataSet(recording, pathlib.Path(folder)).convert(unit, rest_frame, force)


class _DataSet:
    def __init__(self, recording, folder):
        self.source, self.folder = pathlib.Path(recording), folder
        self.settings = self.read_settings()
        self.recording = read_recording(recording)
        self.notes = list(self.recording.notes)

    def read_settings(self):
        path = self.folder / "capture.toml"
        try:
            settings = tomllib.loads(path.read_text(encoding="utf-8"))
        except (OSError, ValueError) as error:
            raise InvalidInput(f"{printable(path)}: cannot be read: {printable(error)}; a data set is a folder with a "
                               "capture.toml") from None
        for key in ("units", "columns", "deviation"):
            if not isinstance(settings.setdefault(key, {}), dict):
                raise InvalidInput(f"{printable(path)}: {key} is no table; see inverse/docs/capture_format.md")
        return settings

    def path(self, table):
        """The file of a table. One of positions never replaces a recording."""
        name = self.settings.get(table, TABLES[table])
        if table == "positions" and (not str(name).endswith(".csv") or "*" in name or self.is_source(self.folder / name)):
            name = TABLES[table]
        return self.folder / str(name)

    def is_source(self, path):
        return path.exists() and self.source.exists() and path.samefile(self.source)

    def columns(self, table):
        """Names of columns as the table of the data set writes them."""
        columns = self.settings["columns"]
        own = columns.get(table, {})
        written = {**columns, **(own if isinstance(own, dict) else {})}
        return lambda name: str(written.get(name, name))

    def scale(self, unit):
        """From the recording to units.length."""
        units = self.settings["units"]
        length = unit_of(units.get("length", "m"))
        given = unit or units.get("recording")
        if given:
            return unit_of(given) / length
        if self.recording.is_planar and not self.recording.unit:
            raise InvalidInput(f"{self.recording.file}: has two coordinates per point, in pixels; state the size of a pixel in m, "
                               "such as --unit 1e-4")
        return (self.recording.unit or length) / length

    def convert(self, unit, rest_frame, force):
        target = self.path("positions")
        if self.is_source(target):
            raise InvalidInput(f"{printable(target)}: is the recording itself; give it another name than that of the table")
        if target.exists() and not force:
            raise InvalidInput(f"{printable(target)}: exists; overwrite it with --force")
        r = self.recording
        self.factor = self.scale(unit)
        self.rest = r.positions[r.frame_numbered(rest_frame) if rest_frame is not None else 0]
        if r.is_planar:
            self.notes.append(f"{r.file}: has two coordinates per point; z was not measured and counts as unknown")
        frames = self.frames_of_cases()
        markers = self.write_markers()
        columns = self.columns("positions")
        rows = [[columns(name) for name in ("case", "marker", "x", "y", "z")]]
        sd = self.deviations()
        rows[0] += [columns(f"sd_{axis}") for axis in "xyz"] if sd else []
        for case, f in frames:
            for name, i in markers:
                if not np.isnan(r.positions[f, i, 0]):
                    rows.append([case, name, *self.position(r.positions[f, i]), *sd])
        write_table(target, rows)
        self.notes.append(f"wrote {printable(target)}: {len(rows) - 1} positions of {len(markers)} markers in {len(frames)} cases")
        if self.settings.get("positions", target.name) != target.name:
            self.notes.append(f"capture.toml: remove the key positions, or set positions = \"{target.name}\"")
        return self.notes

    def position(self, p):
        return [float(self.factor * x) for x in p]

    def deviations(self):
        """Those of each row, if one coordinate was not measured."""
        if not self.recording.is_planar:
            return []
        stated = self.settings["deviation"].get("position")
        if not isinstance(stated, (int, float)) or not stated > 0:
            raise InvalidInput(f"{printable(self.folder / 'capture.toml')}: give deviation = {{ position = ... }}, the standard "
                               "deviation of the measured coordinates")
        extent = np.linalg.norm(np.nanmax(self.rest, axis=0) - np.nanmin(self.rest, axis=0))
        return [stated, stated, float(NOT_MEASURED * max(self.factor * extent, stated))]

    def frames_of_cases(self):
        """[(case, index of its frame)]. Completes the times of the cases for a series of forces."""
        table = Table(self.path("cases"))
        column, cases, errors, rows, completed = self.columns("cases"), [], [], [], 0
        needs_times = "forces" in self.settings and self.settings.get("steady") != "history" and self.recording.times is not None
        for cells in table.rows():
            number, time = cells.get(column("frame"), ""), cells.get(column("time"), "")
            try:
                f = self.frame(table, number, time)
                cases.append((cells.get(column("case")) or f"case {len(rows) + 1}", f))
                if needs_times and not time:
                    cells[column("time")] = repr(self.recording.times[f])
                    completed += 1
            except InvalidInput as error:
                errors.append(f"{table.where}: {error}")
            rows.append(cells)
        if errors:
            raise InvalidInput("\n".join(errors))
        if completed:
            self.rewrite(table, rows, [column("time")])
            self.notes.append(f"{printable(self.path('cases'))}: wrote the times of {completed} frames, for the series of forces")
        return cases

    def frame(self, table, number, time):
        if number:
            value = table.number(number)
            if value is None or value != round(value):
                raise InvalidInput(f"frame = {printable(number)} is not a whole number")
            return self.recording.frame_numbered(int(value))
        if not time:
            raise InvalidInput(f"frame and time are blank; one of them selects the frame of {self.recording.file}")
        if (value := table.number(time)) is None:
            raise InvalidInput(f"time = {printable(time)} is not a number")
        return self.recording.frame_at(value)

    def rewrite(self, table, rows, added):
        """Writes a table with further columns."""
        columns = [*table.columns, *(name for name in added if name not in table.columns)]
        write_table(pathlib.Path(table.path), [columns, *([cells.get(name, "") for name in columns] for cells in rows)],
                    table.separator)

    def write_markers(self):
        """[(name, index of the point)]. Completes the table of markers by positions at rest."""
        path = self.path("markers")
        index = {name: i for i, name in enumerate(self.recording.names)}
        is_seen = ~np.isnan(self.rest[:, 0])
        if not is_seen.any():
            raise InvalidInput(f"{self.recording.file}: no point was seen; choose another rest_frame")
        if path.exists():
            return self.complete_markers(path, index, is_seen)
        if not is_seen.all():
            self.notes.append(f"{self.recording.file}: {int((~is_seen).sum())} points were not seen at rest, where they are placed "
                              "on the body; they are not used")
        column = self.columns("markers")
        used = [(name, i) for name, i in index.items() if is_seen[i]]
        write_table(path, [[column(name) for name in ("marker", "x", "y", "z")],
                           *([name, *self.position(self.rest[i])] for name, i in used)])
        return used

    def complete_markers(self, path, index, is_seen):
        table, column = Table(path), self.columns("markers")
        axes, rows, used, completed = [column(axis) for axis in "xyz"], [], [], 0
        for cells in table.rows():
            name = cells.get(column("marker")) or str(len(rows))
            if (i := index.get(name)) is not None:
                used.append((name, i))
                is_placed = cells.get(column("corner_1")) or any(cells.get(axis) for axis in axes)
                if not is_placed and is_seen[i]:
                    cells.update(zip(axes, map(repr, self.position(self.rest[i]))))
                    completed += 1
            rows.append(cells)
        if rows and not used:
            name = rows[0].get(column("marker")) or "0"
            raise InvalidInput(f"{self.recording.file}: has no point '{name}', nor any other marker of {printable(path)}; its points "
                               f"are {', '.join(self.recording.names[:8])}")
        if completed:
            self.rewrite(table, rows, axes)
        return used
