"""Archives of numpy: positions (frames, points, 3), and optionally names, times [s] and unit. NaN means not seen."""
import ast
import io
import math
import os
import struct
import warnings
import zipfile
import zlib

import numpy as np

from .recording import InvalidInput, Recording, length_unit, printable

LARGEST_RATIO = 1032  # of deflate [zlib technical details]
MANY_BYTES, COPIES = 1 << 26, 4  # copies: unpacked, as numbers, as points
TYPES = {"f4", "f8", "i4", "i8"}


def free_memory():
    return os.sysconf("SC_AVPHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")


def parse_npz(file, contents):
    return _Reader(file, contents).read()


class _Reader:
    def __init__(self, file, contents):
        self.file, self.size = file, len(contents)
        wanted = {f"{name}.npy" for name in ("positions", "names", "times", "unit")}
        self.entries = {}
        try:
            with zipfile.ZipFile(io.BytesIO(contents)) as archive:
                infos = [info for info in archive.infolist() if info.filename in wanted]
                self.require_modest(infos)
                for info in infos:
                    self.entries[info.filename] = archive.read(info)
        except InvalidInput:
            raise
        except RuntimeError:  # of zipfile, for passwords
            self.fail("is encrypted; export it without a password")
        except (zipfile.BadZipFile, zlib.error, NotImplementedError, EOFError, OSError, ValueError, struct.error, IndexError,
                UnicodeError, OverflowError) as error:
            self.fail(f"the archive is damaged ({printable(error)}); get another copy")

    def fail(self, message):
        raise InvalidInput(f"{self.file}: {message}")

    def require_modest(self, infos):
        """Each name once, and no more bytes than the archive can hold."""
        names = [info.filename for info in infos]
        for name in names:
            if names.count(name) > 1:
                self.fail(f"'{name}' is there twice; remove one of them")
        if sum(info.compress_size for info in infos) > self.size:
            self.fail("the files of the archive overlap; it is damaged, get another copy")
        for info in infos:
            if info.compress_type not in (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED):
                self.fail(f"'{info.filename}' is packed by method {info.compress_type}; store or deflate it")
            if info.file_size > LARGEST_RATIO * info.compress_size:
                self.fail(f"'{info.filename}' claims {info.file_size} bytes, more than its {info.compress_size} deflated bytes can "
                          "hold; the archive is damaged")

        unpacked = sum(info.file_size for info in infos)
        if unpacked > MANY_BYTES and unpacked > (available := free_memory() // COPIES):
            self.fail(f"unpacks to {unpacked} bytes; there is memory for {available}. Save fewer frames or points")

    def array(self, name):
        """None if it is missing."""
        data = self.entries.get(name + ".npy")
        return None if data is None else parse_npy(f"{self.file}: {name}.npy", data)

    def read(self):
        positions = self.array("positions")
        if positions is None:
            self.fail("has no array 'positions' of the shape (frames, points, 3)")
        if positions.ndim != 3 or positions.shape[2] not in (2, 3) or positions.size == 0 or positions.dtype.kind == "U":
            self.fail(f"positions has the shape {positions.shape}; it must be (frames, points, 3), or 2 for an image")
        frames, points, axes = positions.shape
        names = self.texts("names", points)
        infinite = np.argwhere(np.isinf(positions))
        if len(infinite):
            f, i, axis = infinite[0]
            self.fail(f"positions[{f}, {i}, {axis}] of '{names[i]}' is infinite; write NaN where a point was not seen")
        whole = np.zeros((frames, points, 3))
        whole[..., :axes] = positions
        where = [f"{self.file}: frame {f}" for f in range(frames)]
        return Recording(self.file, names, whole, list(range(frames)), where, self.times(frames), axes == 2, self.unit()).checked(
            max(self.size, positions.size))

    def texts(self, name, count):
        array = self.array(name)
        if array is None:
            return [str(i) for i in range(count)]
        if array.dtype.kind != "U" or array.size != count:
            self.fail(f"{name} has {array.size if array.dtype.kind == 'U' else 0} texts, but positions has {count} points")
        return [printable(text) for text in array.ravel()]

    def times(self, count):
        array = self.array("times")
        if array is None:
            return None
        if array.dtype.kind == "U" or array.size != count:
            self.fail(f"times has {array.size} values, but positions has {count} frames")
        times = [float(t) for t in array.ravel()]
        if not all(map(math.isfinite, times)):
            self.fail("times has a value that is not finite; give each frame its time")
        return times

    def unit(self):
        array = self.array("unit")
        if array is None:
            return None
        unit = length_unit(str(array.ravel()[0])) if array.dtype.kind == "U" and array.size == 1 else None
        if unit is None:
            self.fail("unit must be a text: m, cm, mm, um or in")
        return unit


def parse_npy(file, data):
    """An array of floats or texts [NEP 1]."""

    def fail(message):
        raise InvalidInput(f"{file}: {message}")

    if not data.startswith(b"\x93NUMPY"):
        fail("is no array of numpy; save it by numpy.save or numpy.savez")
    if len(data) < 12:
        fail("ends in its head; it is cut short, get a complete copy")
    begin, length = (10, struct.unpack_from("<H", data, 8)[0]) if data[6] == 1 else (12, struct.unpack_from("<I", data, 8)[0])
    begin, head = begin + length, data[begin:begin + min(length, 10_000)]
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            found = ast.literal_eval(head.decode("latin-1").strip())
        kind, is_fortran, shape = found["descr"], found["fortran_order"], found["shape"]
        count = math.prod(shape)
        is_whole = isinstance(shape, tuple) and len(shape) <= 8 and all(type(n) is int and n >= 0 for n in shape)
    except (ValueError, SyntaxError, TypeError, KeyError, MemoryError, RecursionError, OverflowError):
        is_whole = False
    if not is_whole:
        fail("the head of the array is damaged; get another copy")
    known = isinstance(kind, str) and (kind[1:] in TYPES or (kind[1:2] in ("U", "S") and kind[2:].isdecimal() and
                                                             0 < int(kind[2:7]) and len(kind) < 7))
    if not known or kind[0] not in "<>|=":
        fail(f"the type of the array is {printable(kind)!r}; known are float32, float64, int32, int64 and texts. Convert numbers by "
             "astype(float), texts by astype(str)")
    dtype = np.dtype(kind)
    if count * dtype.itemsize > len(data) - begin:
        fail(f"the number of values is {count}, but the rest of the file has {max(len(data) - begin, 0)} bytes; it is damaged")
    array = np.frombuffer(data, dtype, count, begin) if count else np.zeros(0, dtype)
    array = array.reshape(shape, order="F" if is_fortran else "C")
    if dtype.kind == "S":
        return np.char.decode(array, "latin-1")
    if dtype.kind == "U":
        try:
            array.tolist()
        except (ValueError, SystemError):
            fail("a text has a character that does not exist; the array is damaged")
        return array
    return array.astype(float)
