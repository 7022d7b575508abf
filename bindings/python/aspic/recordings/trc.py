"""Track row column files of Motion Analysis and OpenSim. Blank cells, NaN and 0 0 0 mean not seen."""
import math
import re

import numpy as np

from .recording import InvalidInput, Recording, length_unit, number_of, printable, require_density, shown


def cells_of(line):
    """Tabs separate cells, which may be blank; without tabs, blanks do."""
    if "\t" in line:
        return [cell.strip(" \r") for cell in line.split("\t")]
    return [cell for cell in (part.strip("\r") for part in line.split(" ")) if cell]


def parse_trc(file, contents):
    return _Reader(file, contents).read()


class _Reader:
    def __init__(self, file, contents):
        self.file, self.size = file, len(contents)
        self.lines = contents.decode("utf-8", "backslashreplace").split("\n")
        self.has_last_break = self.lines[-1] == ""
        if self.has_last_break:
            self.lines.pop()
        self.number, self.line = 0, ""
        self.stated = {}
        self.unit, self.notes = None, []
        self.at_origin = 0

    def next(self):
        if self.number == len(self.lines):
            return False
        self.line = self.lines[self.number]
        self.number += 1
        return True

    @property
    def where(self):
        return f"{self.file}:{max(self.number, 1)}"

    def fail(self, message):
        raise InvalidInput(f"{self.where}: {message}")

    def read(self):
        if not self.next() or not self.line.startswith("PathFileType"):
            self.fail("does not begin with 'PathFileType'; export a TRC file of marker positions")
        self.read_head()
        names = self.read_names()
        numbers, times, frames, where = [], [], [], []
        while self.next():
            if not self.line.strip(" \r") or (not frames and self.line.lstrip("\t ")[:1] in ("X", "x")):
                continue  # blank, or the axes "X1 Y1 Z1 X2 ..." below the names
            number, time, positions = self.read_frame(len(names), len(frames))
            numbers.append(number), times.append(time), frames.append(positions), where.append(self.where)
        if self.stated.get("NumFrames", len(frames)) != len(frames):
            self.notes.append(f"{self.file}: NumFrames is {self.stated['NumFrames']}, but the file has {len(frames)} frames; "
                              "these are used")
        if self.at_origin:
            self.notes.append(f"{self.file}: {self.at_origin} positions are exactly 0 0 0; these markers count as not seen")
        positions = np.array(frames).reshape(len(frames), len(names), 3)
        return Recording(self.file, names, positions, numbers, where, times, unit=self.unit, notes=self.notes).checked(self.size)

    def read_head(self):
        if not self.next():
            self.fail("ends before the line with DataRate and NumMarkers; get a complete copy")
        keys = cells_of(self.line)
        if not self.next():
            self.fail("ends before the values of DataRate and NumMarkers; get a complete copy")
        for key, value in zip(keys, cells_of(self.line)):
            if key in ("NumMarkers", "NumFrames"):
                self.stated[key] = self.integer(value, key)
            elif key == "Units":
                self.unit = length_unit(value)
                if self.unit is None:
                    self.notes.append(f"{self.where}: Units = {shown(value)} is no known unit (mm, cm, m, um, in); the unit of "
                                      "length of the data set applies")
        if "NumMarkers" not in self.stated:
            self.fail("has no value below NumMarkers; the third line holds the values of the second")

    def read_names(self):
        if not self.next():
            self.fail("ends before the names of the markers; get a complete copy")
        names = [printable(cell) for cell in cells_of(self.line)[2:] if cell]
        if len(names) != self.stated["NumMarkers"]:
            self.fail(f"names {len(names)} markers, but NumMarkers is {self.stated['NumMarkers']}; the file is cut short or "
                      "was edited")
        return names

    def read_frame(self, points, count):
        cells, whole = cells_of(self.line), 2 + 3 * points
        has_break = self.has_last_break or self.number < len(self.lines)
        if len(cells) < whole and not (has_break and "\t" in self.line):
            self.fail(f"has {len(cells)} cells; a frame of {points} markers has {whole} (is the file cut short?)")
        for cell in cells[whole:]:
            if cell:
                self.fail(f"{shown(cell)} follows the last marker; the line names fewer markers than it has")
        require_density(count + 1, points, self.size, self.where)
        number = self.integer(cells[0], "Frame#")
        time = self.value(cells[1]) if len(cells) > 1 else math.nan
        if not math.isfinite(time):
            self.fail("Time is blank or not finite; export the file again")
        positions = np.full(3 * points, np.nan)
        given = [self.value(cell) for cell in cells[2:whole]]
        positions[:len(given)] = given
        positions = positions.reshape(points, 3)
        at_origin = (positions == 0).all(axis=1)  # what several programs write for a marker that they did not see
        positions[at_origin] = np.nan
        self.at_origin += int(at_origin.sum())
        return number, time, positions

    def integer(self, cell, what):
        if not re.fullmatch(r"\d{1,10}", cell, re.ASCII) or int(cell) > 2**31 - 1:
            self.fail(f"{what} = {shown(cell)} is not a whole number")
        return int(cell)

    def value(self, cell):
        if not cell:
            return math.nan
        value = number_of(cell)
        if value is None:
            self.fail(f"{shown(cell)} is not a number; leave the cell blank if the marker was not seen")
        return value if math.isfinite(value) else math.nan
