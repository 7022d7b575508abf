"""Exact tests of surfaces for intersections, in Python with integers. Shares no code with Aspic: reads the frames
of a run as VTK files, extracts the surfaces, and compares edges with triangles."""
import base64
import collections
import functools
import pathlib
import re
import struct
import zlib

Surface = collections.namedtuple("Surface", "name points triangles is_obstacle")


def data_array(text, name):
    """The numbers of a compressed DataArray."""
    kind, encoded = re.search(rf'<DataArray type="(\w+)" Name="{name}"[^>]*>\s*([^<]*?)\s*<', text).groups()
    blocks, = struct.unpack("<I", base64.b64decode(encoded[:8])[:4])
    if blocks == 0:
        return []
    size = (4 * (3 + blocks) + 2) // 3 * 4
    lengths = struct.unpack(f"<{3 + blocks}I", base64.b64decode(encoded[:size])[:4 * (3 + blocks)])[3:]
    data, raw, at = base64.b64decode(encoded[size:]), b"", 0
    for length in lengths:
        raw += zlib.decompress(data[at:at + length])
        at += length
    code = {"Float64": "d", "Float32": "f", "Int32": "i", "Int64": "q", "UInt8": "B"}[kind]
    return struct.unpack(f"<{len(raw) // struct.calcsize(code)}{code}", raw)


def read_frame(path):
    """Points, triangles and tets of 4 or 10 nodes, and the body of each."""
    text = pathlib.Path(path).read_text()
    numbers, corners, ends = (data_array(text, name) for name in ("Points", "connectivity", "offsets"))
    return list(zip(*[iter(numbers)] * 3)), [corners[a:b] for a, b in zip((0, *ends), ends)], data_array(text, "body")


def boundary(tets):
    """The faces of exactly one tet, as a tuple; four triangles for a face with nodes in its edges. Triangles are surface themselves."""
    faces, triangles = {}, [tuple(t) for t in tets if len(t) == 3]
    for a, b, c, d, *mids in (t for t in tets if len(t) > 3):
        mid = dict(zip((frozenset(e) for e in ((a, b), (b, c), (a, c), (a, d), (b, d), (c, d))), mids))
        for face in ((a, c, b), (a, b, d), (a, d, c), (b, c, d)):
            key = tuple(sorted(face))
            faces[key] = None if key in faces else (face, mid)
    for (a, b, c), mid in filter(None, faces.values()):
        ab, bc, ca = (mid.get(frozenset(e)) for e in ((a, b), (b, c), (c, a)))
        triangles += [(a, ab, ca), (b, bc, ab), (c, ca, bc), (ab, bc, ca)] if mid else [(a, b, c)]
    return tuple(triangles)


@functools.lru_cache(maxsize=4)
def boundaries(tets, body):
    """{body: its boundary}, equal in all frames of a run."""
    owned = collections.defaultdict(list)
    for tet, owner in zip(tets, body):
        owned[owner].append(tet)
    return {owner: boundary(tets) for owner, tets in sorted(owned.items())}


def body_surfaces(path):
    points, tets, body = read_frame(path)
    return [Surface(f"body {b}", points, triangles, False) for b, triangles in boundaries(tuple(tets), body).items()]


def read_surface(path):
    """The obstacles of a frame."""
    text = pathlib.Path(path).read_text()
    triples = lambda a: list(zip(*[iter(a)] * 3))
    return Surface("obstacles", triples(data_array(text, "Points")), triples(data_array(text, "connectivity")), True)


def read_obj(path):
    points, triangles = [], []
    for line in pathlib.Path(path).read_text().splitlines():
        words = line.split()
        if words[:1] == ["v"]:
            points.append(tuple(map(float, words[1:4])))
        elif words[:1] == ["f"]:
            corners = [int(w.split("/")[0]) - 1 for w in words[1:]]
            triangles += [(corners[0], b, c) for b, c in zip(corners[1:], corners[2:])]
    return points, triangles


def sign(x):
    return (x > 0) - (x < 0)


def determinant(u, v, w):
    return (u[0] * (v[1] * w[2] - v[2] * w[1]) + u[1] * (v[2] * w[0] - v[0] * w[2]) + u[2] * (v[0] * w[1] - v[1] * w[0]))


def integers(points):
    """The points times a power of two, exactly."""
    ratios = [[x.as_integer_ratio() for x in p] for p in points]
    scale = max(below for p in ratios for _, below in p)
    return [[above * (scale // below) for above, below in p] for p in ratios]


def side(a, b, c, d):
    """The exact sign of det [a - d, b - d, c - d]."""
    rows = [[p[k] - d[k] for k in range(3)] for p in (a, b, c)]
    size = 1.0
    for row in rows:
        size *= max(map(abs, row))
    value = determinant(*rows)
    if 1e-290 < size and abs(value) > 1e-14 * size:  # 6 products, each with an error below 8 rounding units of size
        return sign(value)
    exact = integers((a, b, c, d))
    return sign(determinant(*[[p[k] - exact[3][k] for k in range(3)] for p in exact[:3]]))


def side_in_plane(a, b, c, axes):
    """The exact sign of the area of a triangle in the plane of two axes."""
    (ax, ay), (bx, by), (cx, cy) = integers([[p[k] for k in axes] for p in (a, b, c)])
    return sign((ax - cx) * (by - cy) - (ay - cy) * (bx - cx))


def coplanar_meet(p, q, triangle):
    for axes in ((0, 1), (1, 2), (2, 0)):
        orientation = side_in_plane(*triangle, axes)
        if orientation:
            break
    else:
        return False  # a degenerate triangle: its edges are tested with the triangles around it
    inside = lambda x: all(side_in_plane(triangle[k], triangle[k - 2], x, axes) * orientation >= 0 for k in range(3))
    if inside(p) or inside(q):
        return True
    for k in range(3):
        a, b = triangle[k], triangle[k - 2]
        if (side_in_plane(p, q, a, axes) * side_in_plane(p, q, b, axes) <= 0 and
                side_in_plane(a, b, p, axes) * side_in_plane(a, b, q, axes) <= 0 and
                all(min(p[i], q[i]) <= max(a[i], b[i]) and min(a[i], b[i]) <= max(p[i], q[i]) for i in axes)):
            return True  # the last condition decides for edges on one line
    return False


def edge_meets_triangle(p, q, triangle):
    """Whether the closed sets have a common point."""
    above, below = side(*triangle, p), side(*triangle, q)
    if above * below > 0:
        return False
    if above == below == 0:
        return coplanar_meet(p, q, triangle)
    signs = {side(p, q, triangle[k], triangle[k - 2]) for k in range(3)}
    return not {1, -1} <= signs


def boxes(sets):
    return [tuple((min(p[k] for p in points), max(p[k] for p in points)) for k in range(3)) for points in sets]


def overlaps(first, second):
    """Pairs of boxes that overlap, by a grid."""
    if not first or not second:
        return
    cell = []
    for k in range(3):
        sizes = sorted(box[k][1] - box[k][0] for box in second)
        whole = max(box[k][1] for box in second) - min(box[k][0] for box in second)
        cell.append(max(2 * sizes[len(sizes) // 2], whole / 1000) or 1.0)
    large, grid = [], collections.defaultdict(list)
    span = lambda box: [range(int(lo // c), int(hi // c) + 1) for (lo, hi), c in zip(box, cell)]
    count = lambda s: len(s[0]) * len(s[1]) * len(s[2])
    for j, box in enumerate(second):
        s = span(box)
        if count(s) > 200:
            large.append(j)
        else:
            for key in ((x, y, z) for x in s[0] for y in s[1] for z in s[2]):
                grid[key].append(j)
    for i, box in enumerate(first):
        s = span(box)
        if count(s) > 2000:
            near = range(len(second))
        else:
            near = set(large).union(*(grid.get((x, y, z), ()) for x in s[0] for y in s[1] for z in s[2]))
        for j in near:
            if all(box[k][0] <= second[j][k][1] and second[j][k][0] <= box[k][1] for k in range(3)):
                yield i, j


@functools.lru_cache(maxsize=64)
def edges_of(triangles):
    return {tuple(sorted((t[k], t[k - 2]))) for t in triangles for k in range(3)}


def intersections(surfaces):
    """Descriptions of all pairs of an edge and a triangle that meet without a common corner. Pairs of two obstacles do
    not count."""
    edges, triangles = [], []
    for s, surface in enumerate(surfaces):
        edges += [(s, *e) for e in edges_of(tuple(surface.triangles))]
        triangles += [(s, *t) for t in surface.triangles]
    at = lambda s, *corners: [surfaces[s].points[c] for c in corners]
    found = []
    for i, j in overlaps(boxes([at(*e) for e in edges]), boxes([at(*t) for t in triangles])):
        (s, *edge), (r, *triangle) = edges[i], triangles[j]
        if surfaces[s].is_obstacle and surfaces[r].is_obstacle or s == r and set(edge) & set(triangle):
            continue
        if edge_meets_triangle(*at(s, *edge), at(r, *triangle)):
            found.append(f"edge {edge} of {surfaces[s].name} meets triangle {triangle} of {surfaces[r].name}")
    return found


def components(surface):
    """The connected parts of a surface, such as the outside of a body and the wall of its cavity."""
    return [surface._replace(triangles=triangles) for triangles in parts_of(tuple(surface.triangles))]


@functools.lru_cache(maxsize=64)
def parts_of(triangles):
    root = {c: c for t in triangles for c in t}

    def find(c):
        while root[c] != c:
            root[c] = c = root[root[c]]
        return c

    for a, b, c in triangles:
        root[find(b)] = root[find(c)] = find(a)
    parts = collections.defaultdict(list)
    for t in triangles:
        parts[find(t[0])].append(t)
    return list(parts.values())


def is_inside(point, surface):
    """Whether a closed surface surrounds the point, by the parity of crossings of a ray."""
    used = [surface.points[c] for c in {c for t in surface.triangles for c in t}]
    if not all(min(p[k] for p in used) <= point[k] <= max(p[k] for p in used) for k in range(3)):
        return False
    high = [max(p[k] for p in surface.points) + 1.0 for k in range(3)]
    for attempt in range(1, 20):
        far = (high[0] + 0.37 * attempt, high[1] + 0.71 * attempt ** 2, high[2] + 0.13 * attempt)
        count = 0
        for t in surface.triangles:
            corners = [surface.points[c] for c in t]
            ends = side(*corners, point), side(*corners, far)
            if ends[0] == 0 or ends[0] == ends[1]:  # the point lies in the plane, but not in the triangle
                continue
            sides = {side(point, far, corners[k], corners[k - 2]) for k in range(3)}
            if ends[1] == 0 or 0 in sides and not {1, -1} <= sides:
                count = None
                break
            count += len(sides) == 1
        if count is not None:
            return count % 2 == 1
    raise RuntimeError("no ray passes between the edges")


def is_closed(surface):
    edges = collections.Counter(tuple(sorted((t[k], t[k - 2]))) for t in surface.triangles for k in range(3))
    return all(n == 2 for n in edges.values())


def behind_plane(surface, origin, normal):
    """Points that are not in the open half-space."""
    n, = integers([normal])

    def is_behind(x):
        products = [float(a) * (b - float(d)) for a, b, d in zip(normal, x, origin)]
        if sum(products) > 1e-14 * sum(abs(a) * (abs(b) + abs(d)) for a, b, d in zip(normal, x, origin)):
            return False  # by more than the rounding errors
        return sum(a * (b - d) for a, b, d in zip(n, *integers((x, origin)))) <= 0

    return [c for c in sorted({c for t in surface.triangles for c in t}) if is_behind(surface.points[c])]
