"""Writers of TRC, C3D, tables of image correlation, NPZ, PLY and OBJ by the specifications of their formats, for tests.

Positions are dictionaries {point: (x, y, z)} per frame; a point that is missing was not seen."""
import struct
import zipfile


def write_trc(path, names, frames, rate=50, unit="mm"):
    """`frames`: a list of positions in `unit`."""
    lines = [f"PathFileType\t4\t(X/Y/Z)\t{path.name}",
             "DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\tOrigDataStartFrame\tOrigNumFrames",
             f"{rate}\t{rate}\t{len(frames)}\t{len(names)}\t{unit}\t{rate}\t1\t{len(frames)}",
             "Frame#\tTime\t" + "\t\t\t".join(names) + "\t\t",
             "\t\t" + "\t".join(f"{axis}{i + 1}" for i in range(len(names)) for axis in "XYZ"), ""]
    for f, positions in enumerate(frames):
        cells = [str(f + 1), repr(f / rate)]
        for name in names:
            cells += [repr(float(x)) for x in positions[name]] if name in positions else ["", "", ""]
        lines.append("\t".join(cells))
    path.write_text("\r\n".join(lines) + "\r\n")


def vax_f(value):
    """The bytes of a VAX F number: 0.1m x 2^(e - 128), the word with sign and exponent first."""
    if value == 0:
        return b"\0\0\0\0"
    sign, value, exponent = int(value < 0), abs(value), 128
    while value >= 1:
        value, exponent = value / 2, exponent + 1
    while value < 0.5:
        value, exponent = value * 2, exponent - 1
    mantissa = round((value - 0.5) * 2**24)
    if mantissa == 2**23:
        mantissa, exponent = 0, exponent + 1
    return struct.pack("<HH", sign << 15 | exponent << 7 | mantissa >> 16, mantissa & 0xffff)


class C3dWriter:
    """Words and parameters of a C3D file for one processor: "intel", "dec" or "mips"."""

    def __init__(self, processor):
        self.code = {"intel": 84, "dec": 85, "mips": 86}[processor]
        self.order = ">" if processor == "mips" else "<"
        self.parameters = b"\x01\x50"

    def int16(self, value):
        return struct.pack(self.order + "h", value if value < 32768 else value - 65536)

    def real(self, value):
        return vax_f(value) if self.code == 85 else struct.pack(self.order + "f", value)

    def group(self, number, name):
        return struct.pack("bb", len(name), -number) + name.encode() + self.int16(3) + b"\0"

    def parameter(self, group, name, kind, sizes, data):
        body = struct.pack("bB", kind, len(sizes)) + bytes(sizes) + data + b"\0"
        return struct.pack("bb", len(name), group) + name.encode() + self.int16(len(body) + 2) + body

    def section(self, names, frames, rate, scale, unit):
        width = max(len(name) for name in names)
        entries = self.group(1, "POINT")
        entries += self.parameter(1, "USED", 2, [], self.int16(len(names)))
        entries += self.parameter(1, "SCALE", 4, [], self.real(scale))
        entries += self.parameter(1, "RATE", 4, [], self.real(rate))
        entries += self.parameter(1, "FRAMES", 2, [], self.int16(len(frames)))
        entries += self.parameter(1, "UNITS", -1, [len(unit)], unit.encode())
        for first, suffix in [(0, ""), (255, "2")]:
            part = names[first:first + 255]
            if part:
                entries += self.parameter(1, "LABELS" + suffix, -1, [width, len(part)],
                                          b"".join(name.ljust(width).encode() for name in part))
        blocks = -(-(len(entries) + 6) // 512)
        return (b"\x01\x50" + bytes([blocks, self.code]) + entries).ljust(512 * blocks, b"\0")

    def write(self, path, names, frames, rate=50, unit="mm", scale=None, analog=2):
        """`scale`: of integer points; None: floating point. Every frame has `analog` further values."""
        stated = scale or -1.0
        section = self.section(names, frames, rate, stated, unit)
        start = 2 + len(section) // 512
        head = bytes([2, 0x50]) + self.int16(len(names)) + self.int16(analog) + self.int16(1) + self.int16(len(frames))
        head += self.int16(0) + self.real(stated) + self.int16(start) + self.int16(1 if analog else 0) + self.real(rate)
        data = b""
        for positions in frames:
            for name in names:
                p = positions.get(name)
                if scale:
                    words = [round(x / scale) for x in p] + [0x0701] if p else [0, 0, 0, -1]
                    data += b"".join(self.int16(w) for w in words)
                else:
                    data += b"".join(self.real(float(x)) for x in (list(p) + [1.0] if p else [0, 0, 0, -1]))
            data += (self.int16(7) if scale else self.real(7.0)) * analog
        path.write_bytes((head.ljust(512, b"\0") + section + data))


def write_dice(path, ids, rest, positions):
    """Stereo results of DICe: coordinates at rest, displacements, sigma = -1 for a subset that failed."""
    rows = ["SUBSET_ID,COORDINATE_X,COORDINATE_Y,DISPLACEMENT_X,DISPLACEMENT_Y,MODEL_COORDINATES_X,MODEL_COORDINATES_Y,"
            "MODEL_COORDINATES_Z,MODEL_DISPLACEMENT_X,MODEL_DISPLACEMENT_Y,MODEL_DISPLACEMENT_Z,SIGMA,GAMMA,STATUS_FLAG"]
    for i, name in enumerate(ids):
        X, x = rest[name], positions.get(name)
        u = [b - a for a, b in zip(X, x)] if x else [0, 0, 0]
        rows.append(",".join(["%d" % i, "10", "20", "1", "2"] + [repr(float(v)) for v in [*X, *u]] +
                             (["0.01", "0.02", "4"] if x else ["-1", "-1", "11"])))
    path.write_text("\n".join(rows) + "\n")


def write_pyvale(path, ids, rest, positions):
    """Stereo results of pyvale: positions now and displacements [mm]; the header ends with a delimiter."""
    head = ["subset_x", "subset_y", "disp_u", "disp_v", "disp_mag", "converged", "cost_zncc", "ftol", "xtol", "num_iter",
            "stereo_disp_u_px", "stereo_disp_v_px", "stereo_disp_mag_px", "stereo_disp_u_mm", "stereo_disp_v_mm",
            "stereo_disp_w_mm", "stereo_x_mm", "stereo_y_mm", "stereo_z_mm", "stereo_converged", "stereo_cost_zncc",
            "stereo_ftol", "stereo_xtol", "stereo_num_iter"]
    rows = [",".join(f'"{name}"' for name in head) + ","]
    for i, name in enumerate(ids):
        X, x = rest[name], positions.get(name)
        values = [b - a for a, b in zip(X, x)] + list(x) if x else [float("nan")] * 6
        rows.append(",".join([f"{10 * i}", "20"] + ["0.5"] * 3 + ["1"] + ["0.9"] * 3 + ["5"] + ["0.1"] * 3 +
                             [repr(float(v)) for v in values] + ["1"] + ["0.9"] * 3 + ["5"]))
    path.write_text("\n".join(rows) + "\n")


def write_generic(path, ids, rest, positions):
    """X, Y, Z at rest and U, V, W, as MATLAB's writetable exports the points of MultiDIC."""
    rows = ["X,Y,Z,U,V,W"]
    for name in ids:
        X, x = rest[name], positions.get(name)
        u = [b - a for a, b in zip(X, x)] if x else [float("nan")] * 3
        rows.append(",".join(repr(float(v)) for v in [*X, *u]))
    path.write_text("\n".join(rows) + "\n")


def write_mudic(path, rest, now):
    """Results of muDIC: positions now and displacements [pixels]."""
    rows = ["id,x,y,ux,uy,true_strain_xx,true_strain_yy,true_strain_xy,eng_strain_xx,eng_strain_yy,eng_strain_xy"]
    for i, (X, x) in enumerate(zip(rest, now)):
        rows.append(",".join([str(i)] + [repr(float(v)) for v in [*x, x[0] - X[0], x[1] - X[1]]] + ["0.0"] * 6))
    path.write_text("\n".join(rows) + "\n")


def npy(values, shape, kind="<f8"):
    """The bytes of an array of floats in version 1.0 of numpy's format."""
    head = "{'descr': '%s', 'fortran_order': False, 'shape': %s, }" % (kind, shape)
    head = head.ljust(-(-(len(head) + 11) // 64) * 64 - 11) + "\n"
    code = {"<f8": "<d", ">f8": ">d", "<f4": "<f"}[kind]
    return b"\x93NUMPY\x01\x00" + struct.pack("<H", len(head)) + head.encode() + b"".join(
        struct.pack(code, v) for v in values)


def npy_texts(texts):
    width = max(map(len, texts))
    head = "{'descr': '<U%d', 'fortran_order': False, 'shape': (%d,), }" % (width, len(texts))
    head = head.ljust(-(-(len(head) + 11) // 64) * 64 - 11) + "\n"
    return b"\x93NUMPY\x01\x00" + struct.pack("<H", len(head)) + head.encode() + b"".join(
        text.ljust(width, "\0").encode("utf-32-le") for text in texts)


def write_npz(path, names, frames, rate=50, method=zipfile.ZIP_STORED):
    flat = [x for positions in frames for name in names for x in positions.get(name, [float("nan")] * 3)]
    with zipfile.ZipFile(path, "w", method) as archive:
        archive.writestr("positions.npy", npy(flat, (len(frames), len(names), 3)))
        archive.writestr("times.npy", npy([f / rate for f in range(len(frames))], f"({len(frames)},)"))
        archive.writestr("names.npy", npy_texts(names))


def write_ply(path, points, markers):
    """A point cloud whose property "marker" is the number of a marker, or -1."""
    head = ("ply\nformat binary_big_endian 1.0\nelement vertex %d\nproperty double x\nproperty double y\n"
            "property double z\nproperty int marker\nend_header\n" % len(points))
    path.write_bytes(head.encode() + b"".join(struct.pack(">dddi", *p, m) for p, m in zip(points, markers)))


def write_obj(path, names, positions):
    """Named objects of one point element each, which are the markers, after other vertices."""
    rows = ["v 0 0 0", "v 1 0 0", "v 0 1 0"]
    for name in names:
        if name in positions:
            rows += ["o " + name, "v %r %r %r" % tuple(map(float, positions[name])), "p -1"]
    path.write_text("\n".join(rows + ["f 1 2 3"]) + "\n")
