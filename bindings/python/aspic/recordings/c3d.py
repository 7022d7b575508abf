"""C3D files [c3d.org, user guide]: integer and floating-point points of Intel, DEC and MIPS processors. A negative residual
means not seen."""
import math
import struct

import numpy as np

from .recording import InvalidInput, Recording, length_unit, printable

BLOCK = 512
INTEL, DEC, MIPS = 84, 85, 86
COMPUTED = ("ANGLES", "FORCES", "MOMENTS", "POWERS", "SCALARS", "REACTIONS")


def parse_c3d(file, contents):
    return _Reader(_Bytes(file, contents)).read()


def vax_f(low, high):
    """VAX F from its two words: sign, exponent with the bias 128, and the fraction of a mantissa in [1/2, 1)."""
    bits = low.astype(np.uint32) << 16 | high
    exponent = (bits >> 23 & 0xff).astype(np.int64)
    mantissa = (1 + (bits & 0x7fffff) / 8388608.0) * np.where(bits >> 31, -1.0, 1.0)
    return np.where(exponent == 0, 0.0, np.ldexp(mantissa, exponent - 129))


class _Bytes:
    """Words of a file. Numbers have the order of `processor`."""

    def __init__(self, file, contents):
        self.file, self.contents, self.processor = file, contents, INTEL

    def fail(self, at, message):
        raise InvalidInput(f"{self.file}: byte {at}: {message}")

    def text(self, at, count):
        if at + count > len(self.contents):
            self.fail(len(self.contents), f"the file ends before byte {at + count}; it is cut short, get a complete copy")
        return self.contents[at:at + count]

    def byte(self, at):
        return self.text(at, 1)[0]

    def signed_byte(self, at):
        return struct.unpack("b", self.text(at, 1))[0]

    @property
    def order(self):
        return ">" if self.processor == MIPS else "<"

    def int16(self, at):
        return struct.unpack(self.order + "h", self.text(at, 2))[0]

    def uint16(self, at):
        return struct.unpack(self.order + "H", self.text(at, 2))[0]

    def real(self, at):
        return float(self.reals(self.text(at, 4))[0])

    def reals(self, data):
        """All numbers of 4 bytes in the data."""
        if self.processor == DEC:
            words = np.frombuffer(data, "<u2")
            return vax_f(words[0::2], words[1::2])
        with np.errstate(invalid="ignore"):  # signaling NaN
            return np.frombuffer(data, self.order + "f4").astype(float)


class _Parameters:
    """Groups of named values."""

    def __init__(self, data):
        self.data = data
        if data.byte(1) != 80:
            data.fail(1, f"is {data.byte(1)}; a C3D file has 80 there. Is this a C3D file?")
        if data.byte(0) < 2:
            data.fail(0, f"the parameters begin in block {data.byte(0)}; block 1 is the header")
        start = (data.byte(0) - 1) * BLOCK
        processor = data.byte(start + 3)
        if processor not in (INTEL, DEC, MIPS):
            data.fail(start + 3, f"the processor is {processor}; known are 84 (Intel), 85 (DEC) and 86 (MIPS). Export the "
                                 "file again")
        data.processor = processor
        self.groups, entries, at = {}, [], start + 4
        while at and at + 2 <= len(data.contents):
            at = self.read_entry(at, entries)
        self.found = {}
        for group, name, parameter in entries:
            self.found.setdefault(f"{self.groups.get(group, '')}:{name}", parameter)

    def read_entry(self, at, entries):
        """Length of the name (negative: locked), group (negative for a group), name, offset to the next: returns it."""
        data = self.data
        length, group = abs(data.signed_byte(at)), data.signed_byte(at + 1)
        if length == 0 or group == 0:
            return 0
        name = data.text(at + 2, length).decode("latin-1").upper()
        link = at + 2 + length
        offset = data.uint16(link)
        if group < 0:
            self.groups[-group] = name
        else:
            entries.append((group, name, self.parameter(name, link + 2)))
        if offset == 0:
            return 0
        if offset < 2:
            data.fail(link, f"the next parameter overlaps this one, '{printable(name)}'; the file is damaged")
        return link + offset

    def parameter(self, name, at):
        """Type (-1 text, 1 byte, 2 integer, 4 floating point), sizes of the dimensions, first byte and number of values."""
        data = self.data
        kind, dimensions = data.signed_byte(at), data.byte(at + 1)
        if abs(kind) not in (1, 2, 4):
            data.fail(at, f"the type of '{printable(name)}' is {kind}; known are -1, 1, 2 and 4. The file is damaged")
        sizes = list(data.text(at + 2, dimensions))
        count = math.prod(sizes)
        if count > len(data.contents):
            data.fail(at + 2, f"'{printable(name)}' has more values than the file has bytes; it is damaged")
        data.text(at + 2 + dimensions, count * abs(kind))
        return kind, sizes, at + 2 + dimensions, count

    def number(self, name, index=0):
        """None if it is missing."""
        kind, _, at, count = self.found.get(name, (0, [], 0, 0))
        if index >= count:
            return None
        read = {4: self.data.real, 2: self.data.int16, 1: self.data.byte}.get(kind)
        return read(at + kind * index) if read else None

    def unsigned(self, name, index=0):
        value = self.number(name, index)
        if value is None or not math.isfinite(value) or abs(value) > 1e9:
            return None
        return int(value) + 65536 if int(value) < 0 else int(value)

    def texts(self, name):
        kind, sizes, at, count = self.found.get(name, (0, [], 0, 0))
        length = sizes[0] if sizes else 1
        if kind != -1 or length == 0:
            return []
        parts = (self.data.text(i, length) for i in range(at, at + count - length + 1, length))
        return [printable(part.rstrip(b" \0").lstrip(b" ")) for part in parts]


class _Reader:
    def __init__(self, data):
        self.data, self.parameters = data, _Parameters(data)
        self.notes = []

    @staticmethod
    def word(n):
        """The header is words of two bytes, counted from 1 in the specification."""
        return 2 * (n - 1)

    def stated(self, name, otherwise):
        value = self.parameters.number(name)
        return otherwise if value is None else value

    def read(self):
        data, word = self.data, self.word
        points = data.uint16(word(2))
        used = self.parameters.unsigned("POINT:USED")
        if used not in (None, points):
            data.fail(word(2), f"the header has {points} points, but POINT:USED is {used}; the file is damaged")
        if points == 0:
            data.fail(word(2), "the file has no points; export the trajectories of the markers")
        self.scale = self.stated("POINT:SCALE", data.real(word(7)))
        if not math.isfinite(self.scale) or self.scale == 0:
            data.fail(word(7), f"the scale factor is {self.scale:.6g}; it must be finite and not 0")
        first, count = self.frames()
        positions = self.positions(points, count)
        columns, names = self.columns(points)
        rate = self.stated("POINT:RATE", data.real(word(11)))
        times = [f / rate for f in range(count)] if math.isfinite(rate) and rate > 0 else None
        if times is None:
            self.notes.append(f"{data.file}: the rate of frames is {rate:.6g} Hz; frames have no times")
        where = [f"{data.file}: byte {self.start + f * self.frame_bytes}" for f in range(count)]
        return Recording(data.file, names, positions[:, columns], list(range(first, first + count)), where, times, unit=self.unit(),
                         notes=self.notes).checked(len(data.contents))

    def frames(self):
        """First number and count. More than 65535 frames are counted by TRIAL, in two words each, or by
        POINT:LONG_FRAMES."""
        start, end = self.long_count("TRIAL:ACTUAL_START_FIELD"), self.long_count("TRIAL:ACTUAL_END_FIELD")
        if start is not None and end is not None and end >= start:
            return start, end - start + 1
        first, last = self.data.uint16(self.word(4)), self.data.uint16(self.word(5))
        many = self.parameters.number("POINT:LONG_FRAMES")
        if many is not None and 1 <= many < 1e9:
            return first, int(many)
        if last < first:
            self.data.fail(self.word(5), f"the last frame, {last}, is before the first, {first}; the file is damaged")
        return first, last - first + 1

    def long_count(self, name):
        low, high = self.parameters.unsigned(name, 0), self.parameters.unsigned(name, 1)
        return None if low is None or high is None else low + (high << 16)

    def columns(self, points):
        """Points that are positions, and their names: others are angles, forces and so on of the program that wrote the
        file."""
        labels = [label for part in ("LABELS", "LABELS2", "LABELS3", "LABELS4") for label in
                  self.parameters.texts("POINT:" + part)]
        computed = {name for kind in COMPUTED for name in self.parameters.texts("POINT:" + kind)}
        labels = [labels[i] if i < len(labels) else "" for i in range(points)]
        columns = [i for i, label in enumerate(labels) if not label or label not in computed]
        if not columns:
            self.data.fail(self.word(2), "the file has no positions, only computed quantities; export the trajectories of the "
                                         "markers")
        if len(columns) < points:
            self.notes.append(f"{self.data.file}: {points - len(columns)} points are angles, forces or other computed "
                              "quantities; they were skipped")
        return columns, [labels[i] or f"point {i + 1}" for i in columns]

    def unit(self):
        units = self.parameters.texts("POINT:UNITS")
        unit = length_unit(units[0]) if units else None
        if units and unit is None:
            self.notes.append(f"{self.data.file}: POINT:UNITS = '{units[0]}' is no known unit (mm, cm, m, um, in); the unit of "
                              "length of the data set applies")
        return unit

    def positions(self, points, count):
        data = self.data
        is_real = self.scale < 0
        width = 4 if is_real else 2
        self.frame_bytes = width * (4 * points + data.uint16(self.word(3)))
        block = self.parameters.unsigned("POINT:DATA_START")
        block = data.uint16(self.word(9)) if block is None else block
        if block < 2:
            data.fail(self.word(9), f"the data begin in block {block}, inside the header; the file is damaged")
        self.start = (block - 1) * BLOCK
        room = max(len(data.contents) - self.start, 0) // self.frame_bytes
        if count > room:
            data.fail(len(data.contents), f"the file ends after {room} of {count} frames; it is cut short, get a complete copy")
        raw = np.frombuffer(data.contents, np.uint8, count * self.frame_bytes, self.start).reshape(count, -1)
        raw = np.ascontiguousarray(raw[:, :width * 4 * points]).tobytes()
        values = data.reals(raw) if is_real else np.frombuffer(raw, data.order + "i2").astype(float)
        values = values.reshape(count, points, 4)
        positions = values[..., :3] if is_real else self.scale * values[..., :3]
        return np.where(values[..., 3:] < 0, np.nan, positions)
