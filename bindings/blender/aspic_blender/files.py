"""Files for the simulator, written and read by numpy."""
import os
import struct

import numpy as np

PC2_HEAD = struct.Struct("<12siiffi")


def write_ply(path, vertices, triangles, attributes=None):
    attributes = attributes or {}
    head = ["ply", "format binary_little_endian 1.0", f"element vertex {len(vertices)}"]
    head += [f"property double {name}" for name in ("x", "y", "z", *attributes)]
    head += [f"element face {len(triangles)}", "property list uchar int vertex_indices", "end_header", ""]
    rows = np.column_stack([vertices, *attributes.values()]).astype("<f8")
    faces = np.empty(len(triangles), dtype=[("count", "u1"), ("vertex", "<i4", 3)])
    faces["count"], faces["vertex"] = 3, triangles
    with open(path, "wb") as file:
        file.write("\n".join(head).encode() + rows.tobytes() + faces.tobytes())


def write_pc2(path, frames):
    """Positions (frames, points, 3). The file appears whole."""
    head = PC2_HEAD.pack(b"POINTCACHE2\0", 1, frames.shape[1], 0.0, 1.0, len(frames))
    with open(path + ".part", "wb") as file:
        file.write(head + np.ascontiguousarray(frames, dtype="<f4").tobytes())
    os.replace(path + ".part", path)


def read_pc2(path):
    """Positions (frames, points, 3); whole frames of a file that may still grow."""
    with open(path, "rb") as file:
        _, _, points, _, _, samples = PC2_HEAD.unpack(file.read(PC2_HEAD.size))
        values = np.frombuffer(file.read(12 * points * samples), "<f4")
    whole = len(values) // (3 * points) if points else 0
    return values[:3 * points * whole].reshape(whole, points, 3)


def toml(value):
    """A number, text, list, or inline table as TOML."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return '"' + value.replace("\\", "\\\\").replace('"', '\\"') + '"'
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{key} = {toml(v)}" for key, v in value.items()) + " }"
    if isinstance(value, (list, tuple, np.ndarray)):
        return "[" + ", ".join(toml(v) for v in value) + "]"
    return repr(float(value)) if isinstance(value, (float, np.floating)) else str(int(value))


def table(name, keys):
    return f"[{name}]\n" + "".join(f"{key} = {toml(value)}\n" for key, value in keys.items())
