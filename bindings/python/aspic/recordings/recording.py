"""The type of measured motions, its checks, and tools that all readers share."""
import dataclasses
import math
import re

import numpy as np

from .._aspic import InvalidInput

UNITS = {"m": 1.0, "meters": 1.0, "cm": 1e-2, "centimeters": 1e-2, "mm": 1e-3, "millimeters": 1e-3, "um": 1e-6,
         "micrometers": 1e-6, "in": 0.0254, "inches": 0.0254}
NUMBER = re.compile(r"[+-]?(?:(?:\d+\.?\d*|\.\d+)(?:e[+-]?\d+)?|nan|inf(?:inity)?)", re.ASCII | re.IGNORECASE)


@dataclasses.dataclass
class Recording:
    """Positions of points in each frame, in `unit`."""
    file: str  # name for messages
    names: list  # of the points; unique
    positions: np.ndarray  # (frames, points, 3); NaN: not seen
    numbers: list  # as the file counts frames
    where: list  # places of the frames for messages: "walk.trc:12"
    times: list | None = None  # of the frames [s]; None: the file has none
    is_planar: bool = False  # two coordinates were measured; z is 0
    unit: float | None = None  # stated unit of length [m]
    notes: list = dataclasses.field(default_factory=list)  # assumptions of the reader

    def checked(self, size):
        """Names points apart. Raises InvalidInput unless there are points, and frames in ascending order, that fit into
        `size` bytes of files."""
        if not self.names:
            raise InvalidInput(f"{self.file}: has no points; export the trajectories of the markers")
        if not self.numbers:
            raise InvalidInput(f"{self.file}: has no frames; export the recorded range")
        require_density(len(self.numbers), len(self.names), size, self.file)
        self._name_apart()
        for f in range(1, len(self.numbers)):
            if self.numbers[f] <= self.numbers[f - 1]:
                raise InvalidInput(f"{self.where[f]}: frame {self.numbers[f]} follows frame {self.numbers[f - 1]}; sort "
                                   "the frames, each with its own number")
            if self.times is not None and not self.times[f] > self.times[f - 1]:
                raise InvalidInput(f"{self.where[f]}: time = {self.times[f]:.6g} s follows {self.times[f - 1]:.6g} s; "
                                   "times must ascend")
        self.positions[~np.isfinite(self.positions).all(axis=2)] = np.nan
        return self

    def _name_apart(self):
        used, renamed = set(), 0
        for i, name in enumerate(self.names):
            unique, copy = name, 2
            while unique in used:
                unique, copy = f"{name} ({copy})", copy + 1
            used.add(unique)
            renamed += unique != name
            self.names[i] = unique
        if renamed:
            self.notes.append(f"{self.file}: {renamed} points share their name with another one; a number was appended")

    def frame_numbered(self, number):
        """The index of the frame with this number."""
        if number not in self.numbers:
            raise InvalidInput(f"frame {number} is not in {self.file}, which has the frames {self.numbers[0]} to "
                               f"{self.numbers[-1]}")
        return self.numbers.index(number)

    def frame_at(self, time):
        """The index of the frame closest to a time, at most half the frame interval away."""
        if self.times is None:
            raise InvalidInput(f"{self.file} has no times; select frames by the column frame instead of time")
        best = int(np.argmin(np.abs(np.asarray(self.times) - time)))
        count = len(self.times) - 1
        interval = (self.times[-1] - self.times[0]) / count if count else math.inf
        if not abs(self.times[best] - time) <= 0.5 * interval:
            raise InvalidInput(f"time = {time:.6g} s is not in {self.file}, which lasts from {self.times[0]:.6g} s to "
                               f"{self.times[-1]:.6g} s")
        return best


class Sequence:
    """Frames in files of their own: points get their index when a file first names them."""

    def __init__(self):
        self.index, self.frames, self.size = {}, [], 0

    def point(self, name):
        return self.index.setdefault(name, len(self.index))

    def add(self, frame, size, where):
        """`frame`: {index of a point: position}."""
        self.frames.append(frame)
        self.size += size
        require_density(len(self.frames), len(self.index), self.size, where)

    def positions(self):
        array = np.full((len(self.frames), len(self.index), 3), np.nan)
        for f, frame in enumerate(self.frames):
            if frame:
                array[f, list(frame)] = list(frame.values())
        return array


def require_density(frames, points, size, where):
    """Raises InvalidInput if frames with this many points take far more memory than `size` bytes of files."""
    if points > 0 and frames > size // points:
        raise InvalidInput(f"{where}: {frames} frames of {points} points do not fit into {size} bytes; most points would "
                           "never be seen. Export the points that were tracked")


def printable(text):
    """The text with control characters and invalid bytes as \\xNN."""
    if isinstance(text, bytes):
        text = text.decode("utf-8", "backslashreplace")
    return "".join(c if c.isprintable() else c.encode("unicode_escape").decode("ascii") for c in str(text))


def shown(text):
    """A word for a message."""
    text = printable(text)
    return f"'{text if len(text) <= 40 else text[:37] + '...'}'"


def number_of(text):
    """None if the text is no number, or too large for one."""
    value = float(text) if NUMBER.fullmatch(text) else None
    return None if value in (math.inf, -math.inf) and "n" not in text.lower() else value


def length_unit(text):
    """The unit [m]; None if the text names none."""
    return UNITS.get("".join(text.replace("\0", "").split()).lower())


def read_bytes(path):
    try:
        return path.read_bytes()
    except OSError as error:
        raise InvalidInput(f"{printable(path)}: cannot be read: {error.strerror}") from None
