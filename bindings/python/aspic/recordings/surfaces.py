"""PLY or OBJ files, one per frame, counted from 1. Points are the vertices whose property "marker" is a number from 0 (PLY),
those of point elements "p" in named objects (OBJ), or else all vertices."""
import re

import numpy as np

from .recording import InvalidInput, Recording, Sequence, number_of, printable, read_bytes, shown

SCALARS = {"char": "i1", "int8": "i1", "uchar": "u1", "uint8": "u1", "short": "i2", "int16": "i2", "ushort": "u2", "uint16": "u2",
           "int": "i4", "int32": "i4", "uint": "u4", "uint32": "u4", "float": "f4", "float32": "f4", "double": "f8",
           "float64": "f8"}
STATEMENTS = {"v", "vn", "vt", "vp", "f", "l", "p", "o", "g", "s", "mg", "usemtl", "mtllib"}  # of OBJ
ENCODINGS = {"ascii": "", "binary_little_endian": "<", "binary_big_endian": ">"}


def read_surfaces(files):
    sequence = Sequence()
    for path in files:
        file, contents = printable(path), read_bytes(path)
        points = points_of_obj(file, contents) if path.suffix.lower() == ".obj" else points_of_ply(file, contents)
        if not points:
            raise InvalidInput(f"{file}: has no vertices that are markers; number them from 0")
        frame = {}
        for name, position in points:
            point = sequence.point(name)
            if point in frame and not np.isnan(frame[point]).any():
                raise InvalidInput(f"{file}: the marker '{name}' is there twice; give each its own number or name")
            frame[point] = position
        sequence.add(frame, len(contents), file)
    where = [printable(path) for path in files]
    return Recording(where[0], list(sequence.index), sequence.positions(), list(range(1, len(files) + 1)), where).checked(
        sequence.size)


class _Header:
    """Elements of a PLY file above and including its vertices."""

    def __init__(self, file, contents):
        self.file = file
        match = re.match(rb"ply\s*\n.*?end_header\r?\n", contents, re.DOTALL)
        if not match:
            self.fail("is no PLY file with a whole header; export it again")
        self.end, self.elements, self.encoding = match.end(), [], None
        for number, line in enumerate(match[0].decode("latin-1").splitlines(), 1):
            words = line.split()
            if not words or words[0] in ("ply", "comment", "obj_info", "end_header"):
                continue
            if words[0] == "format" and len(words) > 1 and words[1] in ENCODINGS:
                self.encoding = ENCODINGS[words[1]]
            elif words[0] == "element" and len(words) == 3 and re.fullmatch(r"\d{1,15}", words[2], re.ASCII):
                self.elements.append((words[1], int(words[2]), []))
            elif words[0] == "property" and len(words) >= 3 and self.elements:
                self.elements[-1][2].append((words[-1], words[1]))
            else:
                raise InvalidInput(f"{file}:{number}: {shown(line)} is no statement of a PLY header; export the file again")
        if self.encoding is None:
            self.fail("has no known format; save it as ascii, binary_little_endian or binary_big_endian")
        if "vertex" not in [element[0] for element in self.elements]:
            self.fail("has no element 'vertex'; export the points")
        while self.elements[-1][0] != "vertex":
            self.elements.pop()

    def fail(self, message):
        raise InvalidInput(f"{self.file}: {message}")

    def types(self, name, properties):
        for property, kind in properties:
            if kind not in SCALARS:
                self.fail(f"the property '{printable(property)}' of '{printable(name)}' is a {printable(kind)}; vertices have numbers "
                          "only and come before other elements. Export the file again")
        if len({property for property, _ in properties}) < len(properties):
            self.fail(f"'{printable(name)}' has a property twice; remove one")
        return [(property, self.encoding + SCALARS[kind]) for property, kind in properties]


def _vertices(header, contents):
    """{property: values}."""
    rest = contents[header.end:]
    lines = None if header.encoding else rest.decode("latin-1").split()
    for name, count, properties in header.elements:
        types = header.types(name, properties)
        if lines is None:
            size = np.dtype(types).itemsize
            if count * size > len(rest):
                header.fail(f"ends after {len(rest) // max(size, 1)} of {count} entries of '{printable(name)}'; get a complete copy")
            entries, rest = rest[:count * size], rest[count * size:]
            table = np.frombuffer(entries, types) if entries else np.zeros(0, types)
            values = {property: table[property].astype(float) for property, _ in types}
        else:
            size = len(types)
            if count * size > len(lines):
                header.fail(f"ends after {len(lines) // max(size, 1)} of {count} entries of '{printable(name)}'; get a complete copy")
            numbers = [number_of(text) for text in lines[:count * size]]
            if None in numbers:
                header.fail(f"{shown(lines[numbers.index(None)])} is not a number; correct it")
            table = np.array(numbers, float).reshape(count, size)
            lines = lines[count * size:]
            values = {property: table[:, i] for i, (property, _) in enumerate(types)}
    return values


def points_of_ply(file, contents):
    header = _Header(file, contents)
    values = _vertices(header, contents)
    for axis in "xyz":
        if axis not in values:
            header.fail(f"vertices have no property '{axis}'; export their coordinates")
    points = np.stack([values[axis] for axis in "xyz"], axis=1)
    if not np.isfinite(points).all():
        header.fail(f"vertex {int(np.argwhere(~np.isfinite(points))[0][0])} has a coordinate that is not finite; leave it out")
    markers = values.get("marker", np.arange(len(points)))
    for v, number in enumerate(markers):
        if not abs(number) <= 2e9 or number != int(number):
            header.fail(f"vertex {v} has marker = {number:g}; it must be a whole number, negative for other vertices")
    return [(str(int(number)), points[v]) for v, number in enumerate(markers) if number >= 0]


def points_of_obj(file, contents):
    vertices, named, name = [], [], ""
    lines = contents.decode("utf-8", "backslashreplace").split("\n")
    seen = 0  # vertices above
    for number, line in enumerate(lines, 1):
        words = line.split("#")[0].split()
        if words and words[0] not in STATEMENTS:
            raise InvalidInput(f"{file}:{number}: unknown statement {shown(words[0])}; is this a Wavefront OBJ file?")
        if words[:1] == ["v"]:
            position = [number_of(word) for word in words[1:4]]
            if len(position) < 3 or None in position or not np.isfinite(position).all():
                raise InvalidInput(f"{file}:{number}: {shown(line.strip())} is no vertex of three finite numbers; correct it")
            vertices.append(np.array(position))
    for number, line in enumerate(lines, 1):
        words = line.split("#")[0].split()
        seen += words[:1] == ["v"]
        if words[:1] in (["o"], ["g"]) and len(words) > 1:
            name = printable(words[1])
        for word in words[1:] if words[:1] == ["p"] else []:
            given = int(word) if re.fullmatch(r"[+-]?\d{1,15}", word, re.ASCII) else 0
            vertex = given - 1 if given > 0 else seen + given
            if given == 0 or not 0 <= vertex < len(vertices):
                raise InvalidInput(f"{file}:{number}: a point names vertex {printable(word)} of {len(vertices)}")
            named.append((name or str(vertex), vertices[vertex]))
    return named or [(str(v), position) for v, position in enumerate(vertices)]
