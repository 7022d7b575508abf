"""Measurements for `aspic fit` whose truth is known, by quadratic_fem.py: motions of grips, indentations, gravity.

Each Truth holds noise-free readings. write() adds noise and writes a data set with a mesh for the fit, which shares no
vertices with that of the truth but the corners of the body.
"""
import csv
import dataclasses
import itertools

import numpy as np

import quadratic_fem as fem
from polar_box import polar_box

PENALTY = 4000  # stiffness of the penalty of an indenter, relative to E / radius


@dataclasses.dataclass
class Reading:
    columns: dict        # of cases.csv, without force and torque
    markers: np.ndarray  # positions [m]
    force: np.ndarray    # on the body [N]
    torque: np.ndarray = None  # about the moved center of the grip [N m]; None: not measured


@dataclasses.dataclass
class Truth:
    name: str
    size: tuple          # of the body, from the origin [m]
    cells: tuple         # of the mesh of the fit
    markers: np.ndarray  # at rest
    readings: list
    settings: str        # of capture.toml
    young: object        # a number, or a function of points
    poisson: float
    layers: tuple = ()   # heights between regions of the mesh of the fit
    scan: np.ndarray = None  # vertices of the mesh of the fit, in the order of kuhn_box; None: those of the box

    def with_first_markers(self, count):
        readings = [dataclasses.replace(r, markers=r.markers[:count]) for r in self.readings]
        return dataclasses.replace(self, markers=self.markers[:count], readings=readings)

    def largest(self):
        motion = max(np.linalg.norm(r.markers - self.markers, axis=1).max() for r in self.readings)
        force = max(np.linalg.norm(r.force) for r in self.readings)
        torque = max((max(np.linalg.norm(r.torque), 0.2 * self.size[0] * np.linalg.norm(r.force))
                      for r in self.readings if r.torque is not None), default=0)
        return motion, force, torque


def on_sides(size, count, seed, keep=lambda p: True):
    """Points on the four vertical faces and the top, away from edges."""
    random, points = np.random.default_rng(seed), []
    while len(points) < count:
        p = random.uniform(0.05, 0.95, 3) * size
        axis, side = random.integers(5) // 2, random.integers(2)
        p[axis] = size[axis] if axis == 2 else side * size[axis]
        if keep(p):
            points.append(p)
    return np.array(points)


def graded(length, cells, ratio):
    """Planes that are denser at both ends."""
    t = np.linspace(-1, 1, cells + 1)
    return length / 2 * (1 + t * (1 + ratio * (1 - t ** 2) / 2))


def grip_readings(solid, markers, motions, gravity=None):
    """The bottom is held; the top of the box is moved by (name, group, displacement, rotation vector) about its center.
    A motion of None leaves the top free."""
    X = solid.mesh.X
    height = X[:, 2].max()
    bottom, top = X[:, 2] < 1e-9, X[:, 2] > height - 1e-9
    center = np.array([X[:, 0].max() / 2, X[:, 1].max() / 2, height])
    read, readings = fem.Interpolation(solid.mesh, markers), []
    for name, group, move, turn in motions:
        columns = {"case": name, "group": group}
        if gravity is not None:
            columns.update({"gravity_" + a: g for a, g in zip("xyz", gravity)})
        if move is None:
            x = solid.solve(X.ravel(), np.repeat(bottom, 3))
            readings.append(Reading(columns, read(x), np.zeros(3)))
            continue
        R, move = fem.rotation(turn), np.asarray(move, float)
        s = X[:, 2:] / height
        moved = center + (X - center) @ fem.rotation(turn).T + move
        start = X + s * (moved - X)
        start[top] = center + (X[top] - center) @ R.T + move
        x = solid.solve(start.ravel(), np.repeat(bottom | top, 3))
        f = solid.evaluate(x)[1].reshape(-1, 3)[top]
        arms = x.reshape(-1, 3)[top] - (center + move)
        columns.update({"move_" + a: d for a, d in zip("xyz", move)})
        columns.update({"rotation_" + a: d for a, d in zip("xyz", turn)})
        readings.append(Reading(columns, read(x), f.sum(0), np.cross(arms, f).sum(0)))
    return readings


def uniform(value):
    return lambda points: value + 0 * points[..., 0]


GRIPPED = """fixed = "z < 1e-6"
[[grip]]
name = "top"
where = "z > {height} - 1e-6"
"""


def block(cells=7, young=2e4, poisson=0.45):
    size = np.array([0.04, 0.04, 0.04])
    planes = graded(0.04, cells, 0.3)
    solid = fem.Solid(fem.box(planes, planes, planes), uniform(young), poisson)
    markers = on_sides(size, 80, 1, lambda p: p[2] < 0.04)
    motions = [("pull", "pull", (0, 0, 2e-3), (0, 0, 0)), ("press", "press", (0, 0, -2e-3), (0, 0, 0)),
               ("shear", "shear", (4e-3, 0, 0), (0, 0, 0)), ("twist", "twist", (0, 0, 0), (0, 0, 0.15))]
    return Truth("block", size, (4, 4, 4), markers, grip_readings(solid, markers, motions), GRIPPED.format(height=0.04),
                 young, poisson)


def tensile(cells=5, young=6e4, poisson=0.4):
    size = np.array([0.02, 0.02, 0.08])
    planes = graded(0.02, cells, 0.2)
    solid = fem.Solid(fem.box(planes, planes, graded(0.08, 2 * cells + 2, 0.4)), uniform(young), poisson)
    markers = on_sides(size, 60, 2, lambda p: p[2] < 0.08)
    motions = [(f"{1000 * d:g} mm", f"{1000 * d:g} mm", (0, 0, d), (0, 0, 0)) for d in (1.5e-3, 3e-3, 4.5e-3)]
    return Truth("tensile", size, (3, 3, 10), markers, grip_readings(solid, markers, motions),
                 GRIPPED.format(height=0.08), young, poisson)


def weight(cells=7, young=5e3, poisson=0.45):
    """A soft block under its own weight in all cases; at rest there is none."""
    size, gravity = np.array([0.04, 0.04, 0.04]), (0, 0, -9.81)
    planes = graded(0.04, cells, 0.3)
    solid = fem.Solid(fem.box(planes, planes, planes), uniform(young), poisson, weight=1000 * np.array(gravity))
    markers = on_sides(size, 80, 3, lambda p: p[2] < 0.04)
    motions = [("stand", "stand", None, None), ("press", "press", (0, 0, -2e-3), (0, 0, 0)),
               ("shear", "shear", (4e-3, 0, 0), (0, 0, 0))]
    return Truth("weight", size, (4, 4, 4), markers, grip_readings(solid, markers, motions, gravity),
                 GRIPPED.format(height=0.04), young, poisson)


def standing(gravity=(0, 0, -9.81), cells=5):
    """A soft block that is held below, under gravity."""
    size, planes = np.array([0.04, 0.04, 0.04]), graded(0.04, cells, 0.3)
    solid = fem.Solid(fem.box(planes, planes, planes), uniform(5e3), 0.4, weight=1000 * np.array(gravity))
    return solid, size, on_sides(size, 60, 3, lambda p: p[2] < 0.04)


MESH_GRAVITY = "mesh_gravity = [0, 0, 9.81]\n"


def scan(cells=9):
    """A block that hung from its lower side during the scan, and is measured while it stands, when its motion is twice
    the sag, and while it lies. On 5 instead of 9 cells the motions are 0.2 % too large."""
    def equilibrium(*gravity):
        solid, size, points = standing(gravity, cells)
        read = fem.Interpolation(solid.mesh, np.concatenate([kuhn_box(size, (3, 3, 3))[0], points]))
        return read(solid.solve(solid.mesh.X.ravel(), np.repeat(solid.mesh.X[:, 2] < 1e-9, 3)))

    hanging, size = equilibrium(0, 0, 9.81), np.array([0.04, 0.04, 0.04])
    corners = len(kuhn_box(size, (3, 3, 3))[0])
    readings = []
    for name, g in (("stand", (0.0, 0.0, -9.81)), ("lie", (9.81, 0.0, 0.0))):
        columns = {"case": name, "group": name, **{"gravity_" + a: v for a, v in zip("xyz", g)}}
        readings.append(Reading(columns, equilibrium(*g)[corners:], np.zeros(3)))
    return Truth("scan", size, (3, 3, 3), hanging[corners:], readings, MESH_GRAVITY + 'fixed = "z < 1e-6"\n', 5e3, 0.4,
                 scan=hanging[:corners])


def stiffening(strain, b=1.0, cells=3, young=2e4, poisson=0.45):
    """A bar whose law is Yeoh's with b2 = b: pulled, pressed, and twisted while it is pulled, in three steps each."""
    size, length, steps = np.array([0.02, 0.02, 0.06]), 0.06, (1 / 3, 2 / 3, 1)
    planes = graded(0.02, cells, 0.2)
    solid = fem.Solid(fem.box(planes, planes, graded(length, 3 * cells, 0.4)), uniform(young), poisson, b)
    markers = on_sides(size, 40, 6, lambda p: p[2] < length)
    kinds = (("pull", length * strain, 0), ("press", -0.3 * length * strain, 0), ("twist", 0.2 * length * strain, 3 * strain))
    motions = [(f"{name} {k}", name, (0, 0, part * move), (0, 0, part * turn))
               for name, move, turn in kinds for k, part in enumerate(steps)]
    return Truth("stiffening", size, (2, 2, 6), markers, grip_readings(solid, markers, motions),
                 GRIPPED.format(height=length), young, poisson)


FIBRE_RATIO, FIBRE_EXPONENT = 4.0, 1.0


def axis(azimuth, elevation):
    """Unit vector of two angles in degrees."""
    a, e = np.radians([azimuth, elevation])
    return np.array([np.cos(a) * np.cos(e), np.sin(a) * np.cos(e), np.sin(e)])


def fibrous(axes, cells=4, young=2e4, poisson=0.45, only_press=False):
    """A block of layers of equal height with fibres along one axis each, pulled, sheared, twisted and bent."""
    size, height, a = np.array([0.04, 0.04, 0.04]), 0.04, 4e-3
    interfaces = tuple(height * (k + 1) / len(axes) for k in range(len(axes) - 1))
    direction = lambda points: np.array(axes)[np.searchsorted(interfaces, points[..., 2])]
    planes, up = graded(height, cells, 0.3), np.linspace(0, height, cells + 1)
    solid = fem.Solid(fem.box(planes, planes, up), uniform(young), poisson, b=0,
                      fibres=fem.Fibres(direction, FIBRE_RATIO, FIBRE_EXPONENT))
    markers = on_sides(size, 80, 8, lambda p: p[2] < height)
    motions = [("pull", "pull", (0, 0, a), (0, 0, 0)), ("shear x", "shear x", (a, 0, 0), (0, 0, 0)),
               ("shear y", "shear y", (0, a, 0), (0, 0, 0)), ("twist", "twist", (0, 0, 0), (0, 0, 0.2)),
               ("bend", "bend", (0, 0, 0), (0.1, 0, 0))]
    if only_press:
        motions = [(f"press {k}", f"press {k}", (0, 0, -k * 1e-3), (0, 0, 0)) for k in (1, 2)]
    return Truth("fibrous", size, (3, 3, 2 * len(axes) if len(axes) > 1 else 3), markers,
                 grip_readings(solid, markers, motions), GRIPPED.format(height=height), young, poisson, interfaces)


BALL = np.array([0.034, 0.027, 0.035]), 0.015, 1e4, 3e4  # center, radius, E outside and inside
INTERFACE, LOWER, UPPER, LAYERS_POISSON = 0.024, 45e3, 15e3, 0.45  # of two layers
FIELDS = {
    "ball": lambda points: np.where(((points - BALL[0]) ** 2).sum(-1) < BALL[1] ** 2, BALL[3], BALL[2]),
    "layers": lambda points: np.where(points[..., 2] < INTERFACE, LOWER, UPPER),
}


def ball(cells=11, poisson=0.45, field=FIELDS["ball"]):
    size, planes = np.array([0.06] * 3), graded(0.06, cells, 0.4)
    solid = fem.Solid(fem.box(planes, planes, planes), field, poisson)
    markers = on_sides(size, 3000, 4, lambda p: p[2] < 0.06)
    a = 4e-3
    motions = [("pull", "pull", (0, 0, a), (0, 0, 0)), ("press", "press", (0, 0, -a), (0, 0, 0)),
               ("shear x", "shear x", (1.5 * a, 0, 0), (0, 0, 0)), ("shear y", "shear y", (0, 1.5 * a, 0), (0, 0, 0)),
               ("twist", "twist", (0, 0, 0), (0, 0, 0.2)), ("bend", "bend", (0, 0, 0), (0.12, 0, 0))]
    return Truth("ball", size, (6, 6, 6), markers, grip_readings(solid, markers, motions), GRIPPED.format(height=0.06),
                 field, poisson)


TIPS = """fixed = "z < 1e-6"
[[tip]]
name = "disc"
shape = "disc"
radius = {disc}
rim = {rim}
[[tip]]
name = "sphere"
shape = "sphere"
radius = {sphere}
"""


DISC, SPHERE = 0.012, 0.016  # radii of the indenters of the layers


def graded_between(knots, sizes):
    """Planes whose distances are about `sizes` at the knots, which are planes. Sizes vary linearly in between."""
    planes = [knots[0]]
    for a, b, first, last in zip(knots, knots[1:], sizes, sizes[1:]):
        growth = last / first
        cells = max(1, round((b - a) / first * (np.log(growth) / (growth - 1) if growth != 1 else 1)))
        s = np.arange(1, cells + 1) / cells
        planes.extend(a + (b - a) * (s if growth == 1 else (growth ** s - 1) / (growth - 1)))
    return np.array(planes)


def layers_mesh(tip, fine):
    """A quarter of the body around the axis of the indenter; cells are small at the rim of the disc and below the tip."""
    mm, size = 1e-3, 1e-3 / fine
    if tip == "disc":
        rings, widths = [4, 8, 10.4, 11.2, 12.6, 28, 40], [3.5, 2.5, 1.2, 0.7, 0.7, 4, 3]
        below, heights = [0, 1, 16], [0.7, 0.8, 3.5]
    else:
        rings, widths = [4, 9, 14, 28, 40], [1.7, 1.2, 1.7, 4, 3]
        below, heights = [0, 16], [0.9, 3.5]
    spread = lambda knots, sizes: graded_between(mm * np.array(knots), size * np.array(sizes))
    planes = np.concatenate([spread([0, 24], [2.5, 4])[:-1], 0.04 - spread(below, heights)[::-1]])
    return polar_box(spread(rings, widths), (8 * mm, 16 * mm), planes, round(4 * fine))


def indenter(tip, top, depth, stiffness):
    """The tip after it has moved down by depth from the height `top`, which it touched."""
    end = np.array([0, 0, top - depth])
    return (fem.Disc(end, 0.9 * DISC, 0.1 * DISC, stiffness) if tip == "disc" else
            fem.Indenter(end + [0, 0, SPHERE], 0, SPHERE, stiffness))


def close_to(tip, X, depth):
    """Nodes X, moved down as far as the tip pushes them, or nearly."""
    radial, x = np.hypot(X[:, 0], X[:, 1]), X.copy()
    push = (depth / (1 + np.maximum(radial / DISC - 1, 0) * 4) ** 1.5 if tip == "disc" else
            np.maximum(depth - radial ** 2 / (2 * SPHERE), 0))
    x[:, 2] -= push * (X[:, 2] / X[:, 2].max()) ** 1.5
    return x.ravel()


def indented(tip, depths, markers, fine=1, penalty=PENALTY):
    """Positions of markers and force [N] of a tip at each depth [m]. The markers' origin is on the axis of the tip."""
    mesh = layers_mesh(tip, fine)
    solid, X = fem.Solid(mesh, FIELDS["layers"], LAYERS_POISSON), mesh.X
    held = np.stack([X[:, 0] < 1e-9, X[:, 1] < 1e-9, np.zeros(len(X), bool)], 1)
    held[X[:, 2] < 1e-9] = True
    read, found = fem.Interpolation(mesh, np.column_stack([np.abs(markers[:, :2]), markers[:, 2]])), []
    x, last = close_to(tip, X, depths[0]), depths[0]
    for depth in depths:
        further = X.ravel() + depth / last * (x - X.ravel())
        x, last = further if np.isfinite(solid.evaluate(further)[0]) else x, depth
        solid.indenter = indenter(tip, X[:, 2].max(), depth, penalty * UPPER / DISC)
        # Far from equilibrium, the curvature of the indenter makes matrices indefinite.
        for solid.indenter.is_curved, tolerance in ((False, 0.03), (True, 1e-7)):
            x = solid.solve(x, held.ravel(), tolerance=tolerance)
        positions = read(x)
        positions[:, :2] *= np.where(markers[:, :2] < 0, -1, 1)
        found.append((positions, 4 * solid.contact(x)[3][2]))
    return found


def layers(fine=1):
    """15 kPa above 45 kPa, pressed in the middle: a quarter of the body is solved."""
    size, half = np.array([0.08, 0.08, 0.04]), 0.04
    away = lambda p: p[2] < 0.04 or np.hypot(*(p[:2] - half)) > 0.018
    markers, readings, middle = on_sides(size, 120, 5, away), [], np.array([half, half, 0])
    for tip, depths in (("disc", (1.5e-3, 3e-3)), ("sphere", (2e-3, 4e-3))):
        for depth, (positions, force) in zip(depths, indented(tip, depths, markers - middle, fine)):
            columns = {"case": f"{tip} {1000 * depth:g} mm", "group": tip, "tip": tip, "touch_x": half, "touch_y": half,
                       "touch_z": 0.04 + (0 if tip == "disc" else SPHERE), "axis_x": 0, "axis_y": 0, "axis_z": -1,
                       "depth": depth}
            readings.append(Reading(columns, positions + middle, np.array([0, 0, force])))
    return Truth("layers", size, (8, 8, 5), markers, readings, TIPS.format(disc=DISC, rim=0.064 * DISC, sphere=SPHERE), FIELDS["layers"],
                 LAYERS_POISSON, (INTERFACE,))


TRUTHS = {"block": block, "tensile": tensile, "weight": weight, "scan": scan, "layers": layers, "ball": ball}


def kuhn_box(size, cells):
    """Vertices and tets of a regular mesh: six tets per cell around its diagonal."""
    n = [c + 1 for c in cells]
    X = np.stack(np.meshgrid(*(np.linspace(0, s, m) for s, m in zip(size, n)), indexing="ij"), -1).reshape(-1, 3)
    index, tets = np.arange(len(X)).reshape(n), []
    base = np.stack(np.meshgrid(*(np.arange(c) for c in cells), indexing="ij"), -1).reshape(-1, 3)
    for path in itertools.permutations(range(3)):
        corner = base.copy()
        nodes = [index[tuple(corner.T)]]
        for axis in path:
            corner[:, axis] += 1
            nodes.append(index[tuple(corner.T)])
        odd = sum(path[i] > path[j] for i in range(3) for j in range(i + 1, 3)) % 2
        tets.append(np.stack([nodes[k] for k in ((0, 2, 1, 3) if odd else (0, 1, 2, 3))], 1))
    return X, np.stack(tets, 1).reshape(-1, 4)


def write_gmsh(path, X, tets, regions):
    with open(path, "w") as file:
        file.write(f"$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n{len(X)}\n")
        file.writelines(f"{i + 1} {x:.17g} {y:.17g} {z:.17g}\n" for i, (x, y, z) in enumerate(X))
        file.write(f"$EndNodes\n$Elements\n{len(tets)}\n")
        file.writelines(f"{i + 1} 4 2 {r} {r} {a} {b} {c} {d}\n"
                        for i, ((a, b, c, d), r) in enumerate(zip(tets + 1, regions)))
        file.write("$EndElements\n")


def write_vtu(path, X, tets, fields):
    text = lambda values: " ".join(f"{v:.9g}" for v in np.ravel(values))
    array = lambda name, kind, values, more="": f'<DataArray type="{kind}" Name="{name}" {more}format="ascii">{text(values)}</DataArray>\n'
    path.write_text(
        '<VTKFile type="UnstructuredGrid" version="0.1" byte_order="LittleEndian"><UnstructuredGrid>\n'
        f'<Piece NumberOfPoints="{len(X)}" NumberOfCells="{len(tets)}"><Points>\n'
        + array("Points", "Float64", X, 'NumberOfComponents="3" ') + "</Points><Cells>\n"
        + array("connectivity", "Int64", tets) + array("offsets", "Int64", 4 * np.arange(1, len(tets) + 1))
        + array("types", "UInt8", np.full(len(tets), 10)) + "</Cells><CellData>\n"
        + "".join(array(name, "Float64", values) for name, values in fields.items())
        + "</CellData></Piece></UnstructuredGrid></VTKFile>\n")


def write_table(path, rows):
    names = list(dict.fromkeys(name for row in rows for name in row))
    with open(path, "w", newline="") as file:
        writer = csv.DictWriter(file, names)
        writer.writeheader()
        writer.writerows({k: f"{v:.17g}" if isinstance(v, float) else v for k, v in row.items()} for row in rows)


def write(truth, folder, noise, seed, settings="", cells=None):
    """Writes a data set. Noise: standard deviation relative to the largest motion, force and torque."""
    folder.mkdir(parents=True, exist_ok=True)
    random = np.random.default_rng(seed)
    X, tets = kuhn_box(truth.size, cells or truth.cells)
    heights = X[tets][:, :, 2].mean(1)
    write_gmsh(folder / "rest.msh", X if truth.scan is None else truth.scan, tets, 1 + np.searchsorted(truth.layers, heights))
    motion, force, torque = (noise * v for v in truth.largest())
    (folder / "capture.toml").write_text(
        f'version = 1\nmesh = "rest.msh"\n{settings and settings + chr(10)}deviation = {{ position = {motion or 1e-7:.6g}, '
        f'force = {force or 1e-5:.6g}, torque = {torque or 1e-7:.6g} }}\n{truth.settings}')
    disturbed = lambda values, sd: values + sd * random.normal(size=np.shape(values))
    write_table(folder / "markers.csv", [{"marker": m, **dict(zip("xyz", map(float, p)))} for m, p in enumerate(truth.markers)])
    cases, positions = [], []
    for r in truth.readings:
        row = dict(r.columns)
        if "gravity_z" not in row or "move_x" in row:
            row.update({"force_" + a: v for a, v in zip("xyz", disturbed(r.force, force))})
        if r.torque is not None:
            row.update({"torque_" + a: v for a, v in zip("xyz", disturbed(r.torque, torque))})
        cases.append(row)
        positions += [{"case": row["case"], "marker": m, **dict(zip("xyz", p))}
                      for m, p in enumerate(disturbed(r.markers, motion))]
    write_table(folder / "cases.csv", cases)
    write_table(folder / "positions.csv", positions)
    if callable(truth.young):
        X, tets = kuhn_box(truth.size, (20, 20, 20))
        values = truth.young(X[tets].mean(1))
        write_vtu(folder / "truth.vtu", X, tets, {"young": values, "poisson": np.full(len(tets), truth.poisson)})
