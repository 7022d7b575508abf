"""Meshes for the tests of contact: degenerate shapes of Erleben, "Methodology for assessing mesh-based contact point
methods", ACM Transactions on Graphics 37(3), 2018, as tets and as surfaces."""
import itertools
import math

from exact_surfaces import boundary, determinant


def lattice(nodes, place=lambda x: x, keep=lambda cell: True):
    """Cells between the given coordinates on each axis, cut into six tets each. `place` moves their corners."""
    index, points, tets = {}, [], []

    def number(at):
        if at not in index:
            index[at] = len(points)
            points.append(tuple(map(float, place(tuple(n[i] for n, i in zip(nodes, at))))))
        return index[at]

    for cell in itertools.product(*(range(len(n) - 1) for n in nodes)):
        if not keep(cell):
            continue
        for path in itertools.permutations(range(3)):
            at, corners = list(cell), [number(cell)]
            for axis in path:
                at[axis] += 1
                corners.append(number(tuple(at)))
            tets.append(corners)
    return points, oriented(points, tets)


def oriented(points, tets):
    """Positive volumes; flat tets, of corners that `place` merged, are omitted."""
    found = []
    for t in tets:
        a, b, c, d = (points[v] for v in t)
        volume = determinant(*[[x - y for x, y in zip(p, a)] for p in (b, c, d)])
        if abs(volume) > 1e-14:
            found.append(tuple(t) if volume > 0 else (t[0], t[1], t[3], t[2]))
    return found


def pyramid(base, apex):
    """A base around y = 0 with a diagonal, and an apex."""
    return base + [apex], oriented(base + [apex], [(0, 1, 2, 4), (0, 2, 3, 4)])


def spike():
    return pyramid([(-.5, 0., -.5), (.5, 0., -.5), (.5, 0., .5), (-.5, 0., .5)], (0., 3., 0.))


def wedge():
    points = [(-.5, 0., -1.), (.5, 0., -1.), (0., 3., -1.), (-.5, 0., 1.), (.5, 0., 1.), (0., 3., 1.)]
    return points, oriented(points, [(0, 1, 2, 3), (1, 2, 3, 4), (2, 3, 4, 5)])


def cliff():
    """A frustum: the upper side is smaller than the lower one."""
    return lattice([(-.75, .75), (0, 1), (-.75, .75)], lambda x: (x[0] * (1 - x[1] / 3), x[1], x[2] * (1 - x[1] / 3)))


def crack():
    """A block with a V notch along z."""
    return lattice([(-1, -.1, 0, .1, 1), (0, 1), (-1, 1)], lambda x: (x[0], .5 if x[0] == 0 and x[1] == 1 else x[1], x[2]))


def hole():
    sides = (-1.5, -.5, .5, 1.5)
    return lattice([sides, (0, 1), sides], keep=lambda cell: cell[0] != 1 or cell[2] != 1)


def internal_edges():
    """A box whose upper side has many edges."""
    return lattice([[x / 4 for x in range(-4, 5)], (0, 1), [z / 4 for z in range(-4, 5)]])


def box(lower=(-.5, 0, -.5), upper=(.5, 1, .5), cells=(1, 1, 1)):
    return lattice([[lo + (hi - lo) * i / n for i in range(n + 1)] for lo, hi, n in zip(lower, upper, cells)])


def sliver_box(factor):
    """Triangles with sides of ratio `factor`."""
    return box((-.5, 0, -.5), (.5, .2, .5), (1, 1, factor))


SHAPES = {"spike": spike, "wedge": wedge, "cliff": cliff, "crack": crack, "hole": hole, "internal edges": internal_edges}


def placed(mesh, move=(0, 0, 0), flip=False, turn_deg=0, scale=1, tilt_deg=0):
    """Turned upside down, about the vertical, tilted about z, then moved."""
    c, s = math.cos(math.radians(turn_deg)), math.sin(math.radians(turn_deg))
    tc, ts = math.cos(math.radians(tilt_deg)), math.sin(math.radians(tilt_deg))
    points = []
    for x, y, z in mesh[0]:
        x, y, z = (scale * v for v in ((x, -y, -z) if flip else (x, y, z)))
        x, z = c * x + s * z, c * z - s * x
        x, y = tc * x - ts * y, tc * y + ts * x
        points.append((x + move[0], y + move[1], z + move[2]))
    return points, mesh[1]


def tet_text(mesh):
    points, tets = mesh
    lines = ["MeshVersionFormatted 2", "Dimension 3", "Vertices", str(len(points))]
    lines += ["%r %r %r 0" % p for p in points]
    lines += ["Tetrahedra", str(len(tets))] + ["%d %d %d %d 0" % tuple(v + 1 for v in t) for t in tets] + ["End", ""]
    return "\n".join(lines)


def obj_text(points, triangles):
    return "".join("v %r %r %r\n" % tuple(map(float, p)) for p in points) + "".join(
        "f %d %d %d\n" % tuple(v + 1 for v in t) for t in triangles)


def surface_text(mesh):
    return obj_text(mesh[0], boundary(mesh[1]))
