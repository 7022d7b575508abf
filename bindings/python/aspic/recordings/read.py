"""Selects the reader of a file, and the files of a sequence."""
import os
import pathlib
import re

from .c3d import parse_c3d
from .npz import parse_npz
from .recording import InvalidInput, printable, read_bytes
from .surfaces import read_surfaces
from .tables import read_correlation
from .trc import parse_trc

PARSERS = {".trc": parse_trc, ".c3d": parse_c3d, ".npz": parse_npz}


def natural(name):
    """A key that sorts runs of digits as numbers: "scan_2.ply" before "scan_10.ply"."""
    return [(0, int(part), "") if part.isdecimal() else (1, 0, part) for part in re.findall(r"[0-9]+|[^0-9]+", name)], name


def matching_files(pattern):
    if "*" not in pattern.name:
        return [pattern]
    glob = re.compile(".*".join(map(re.escape, pattern.name.split("*"))), re.DOTALL)
    try:
        names = [name for name in os.listdir(pattern.parent) if glob.fullmatch(name)]
    except OSError as error:
        raise InvalidInput(f"{printable(pattern.parent)}: cannot be listed: {error.strerror}") from None
    if not names:
        raise InvalidInput(f"{printable(pattern)}: no file matches; * matches any characters of a file's name")
    return [pattern.parent / name for name in sorted(names, key=natural)]


def read_recording(path):
    """Reads .trc, .c3d, .npz, .ply, .obj, or tables of image correlation. Raises InvalidInput with file, line or byte, value and
    remedy."""
    path = pathlib.Path(path)
    files, extension = matching_files(path), path.suffix.lower()
    if extension in PARSERS:
        if len(files) > 1:
            raise InvalidInput(f"{printable(path)}: matches {len(files)} files, but {extension} files hold all frames; name one of "
                               "them")
        return PARSERS[extension](printable(path), read_bytes(files[0]))
    recording = read_surfaces(files) if extension in (".ply", ".obj") else read_correlation(files)
    if "*" in path.name:
        note_numbers(files, recording)
    return recording


def note_numbers(files, recording):
    """Frames of a sequence are counted from 1, whatever the numbers in the names of its files."""

    def frame(i):
        return f"frame {i + 1} = {printable(files[i].name)}"

    for i, file in enumerate(files):
        digits = re.findall(r"[0-9]+", file.stem)
        if digits and int(digits[-1][-18:]) != i + 1:
            last = f" to {frame(len(files) - 1)}" if len(files) > 1 else ""
            recording.notes.append(f"frames count the files from 1: {frame(0)}{last}")
            return
