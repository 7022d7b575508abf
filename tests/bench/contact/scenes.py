"""Scenes of contact with their meshes, as plain files: NAME/scene.toml, NAME/*.mesh (Medit: vertices, tets), NAME/*.obj (obstacles)
and NAME/parameters.json, so that other programs can run the same problems."""
import json
import math


def grid(cells, lower, upper, place=lambda x: x):
    """Nodes and tets of a box of cells, six tets each."""
    n = [c + 1 for c in cells]
    number = lambda i, j, k: (i * n[1] + j) * n[2] + k
    nodes = [place([lower[a] + (upper[a] - lower[a]) * at[a] / cells[a] for a in range(3)])
             for at in ((i, j, k) for i in range(n[0]) for j in range(n[1]) for k in range(n[2]))]
    tets = []
    for i in range(cells[0]):
        for j in range(cells[1]):
            for k in range(cells[2]):
                for order in ((0, 1, 2), (1, 2, 0), (2, 0, 1), (0, 2, 1), (2, 1, 0), (1, 0, 2)):
                    corner, path = [i, j, k], [(i, j, k)]
                    for axis in order:
                        corner[axis] += 1
                        path.append(tuple(corner))
                    tet = [number(*p) for p in path]
                    even = order in ((0, 1, 2), (1, 2, 0), (2, 0, 1))
                    tets.append(tet if even else [tet[1], tet[0], tet[2], tet[3]])
    return nodes, tets


def ball(cells, radius, center=(0, 0, 0)):
    """A cube with its edges and corners rounded; those of a true ball would have flat tets."""
    def place(u):
        size = math.hypot(*u)
        scale = (max(map(abs, u)) / size) ** .7 if size else 0
        return [center[a] + radius * scale * u[a] for a in range(3)]
    return grid((cells,) * 3, (-1, -1, -1), (1, 1, 1), place)


def sheet(width, height, size):
    """Nodes and nearly equilateral triangles of a rectangle in the plane y = 0."""
    columns, rows = round(width / size), round(height / size / math.sqrt(.75))
    nodes, triangles, last = [], [], []
    for r in range(rows + 1):
        along = list(range(columns + 1)) if r % 2 == 0 else [0] + [c + .5 for c in range(columns)] + [columns]
        row = [(len(nodes) + i, a) for i, a in enumerate(along)]
        nodes += [[width * (a / columns - .5), 0, height * (r / rows - .5)] for a in along]
        i = j = 0
        while last and (i + 1 < len(last) or j + 1 < len(row)):
            low = j + 1 == len(row) or (i + 1 < len(last) and abs(last[i + 1][1] - row[j][1]) <= abs(last[i][1] - row[j + 1][1]))
            triangles.append((last[i][0], row[j][0], last[i + 1][0] if low else row[j + 1][0]))
            i, j = i + low, j + (not low)
        last = row
    return nodes, triangles


def mesh_text(nodes, tets):
    return ("MeshVersionFormatted 2\nDimension 3\nVertices\n%d\n" % len(nodes) + "".join("%.9g %.9g %.9g 0\n" % tuple(x) for x in nodes) +
            "Tetrahedra\n%d\n" % len(tets) + "".join("%d %d %d %d 0\n" % tuple(v + 1 for v in t) for t in tets) + "End\n")


def obj_text(nodes, triangles):
    return "".join("v %.9g %.9g %.9g\n" % tuple(x) for x in nodes) + "".join("f %d %d %d\n" % tuple(v + 1 for v in t) for t in triangles)


def revolved(profile, around=48):
    """Triangles of a closed profile of (radius, height) about the y axis."""
    nodes = [(r * math.cos(2 * math.pi * k / around), y, r * math.sin(2 * math.pi * k / around)) for r, y in profile for k in range(around)]
    triangles, rows = [], len(profile)
    for i in range(rows):
        for k in range(around):
            a, b = i * around + k, i * around + (k + 1) % around
            c, d = (i + 1) % rows * around + k, (i + 1) % rows * around + (k + 1) % around
            triangles += [(a, b, d), (a, d, c)]
    return nodes, triangles


def prism(profile, z):
    """A closed prism of a convex profile in the xy plane between -z and z."""
    n = len(profile)
    nodes = [(x, y, -z) for x, y in profile] + [(x, y, z) for x, y in profile]
    triangles = [(0, k + 1, k) for k in range(1, n - 1)] + [(n, n + k, n + k + 1) for k in range(1, n - 1)]
    for k in range(n):
        a, b = k, (k + 1) % n
        triangles += [(a, b, b + n), (a, b + n, a + n)]
    return nodes, triangles


def roller(radius, half, around=32):
    return prism([(radius * math.cos(2 * math.pi * k / around), radius * math.sin(2 * math.pi * k / around)) for k in range(around)], half)


class Problem:
    """h [s], E [Pa], rho [kg/m^3]; `bodies`: meshes with further keys; `obstacles`: surfaces with keys, or keys alone."""

    def __init__(self, h, E, nu, rho, mu, steps, gravity=-9.81):
        self.given = {"time_step_s": h, "young_Pa": E, "poisson": nu, "density_kg_m3": rho, "friction": mu, "steps": steps,
                      "gravity_y_m_s2": gravity, "tolerance": 1e-4, "material": "Neo-Hookean"}
        self.bodies, self.obstacles, self.more = [], [], ""  # more: further text of the scene

    def write(self, folder):
        g = self.given
        folder.mkdir(parents=True, exist_ok=True)
        text = (f"gravity = [0, {g['gravity_y_m_s2']}, 0]\n[time]\nstep = {g['time_step_s']}\nduration = {g['time_step_s'] * g['steps']}\n"
                f"[output]\nevery = {g['time_step_s'] * 10}\n[solver]\ntolerance = {g['tolerance']}\n"
                f"[contact]\nfriction = {g['friction']}\n")
        written = {}
        for number, (mesh, keys) in enumerate(self.bodies):
            is_sheet = len(mesh[1][0]) == 3
            name = written.setdefault(id(mesh), f"body{number}." + ("obj" if is_sheet else "mesh"))
            (folder / name).write_text(obj_text(*mesh) if is_sheet else mesh_text(*mesh))
            text += (f"[[body]]\nname = \"body{number}\"\nmesh = \"{name}\"\nmaterial = {{ model = \"neo_hookean\", young = {g['young_Pa']}, "
                     f"poisson = {g['poisson']}, density = {g['density_kg_m3']} }}\n{keys}")
        for number, (surface, keys) in enumerate(self.obstacles):
            text += "[[obstacle]]\n"
            if surface:
                (folder / f"obstacle{number}.obj").write_text(obj_text(*surface))
                text += f"mesh = \"obstacle{number}.obj\"\n"
            text += keys
        (folder / "scene.toml").write_text(text + self.more)
        g["vertices"] = sum(len(mesh[0]) for mesh, _ in self.bodies)
        (folder / "parameters.json").write_text(json.dumps(g, indent=1) + "\n")


def chute(cells=13, steps=66):
    p = Problem(1 / 60, 5e4, .4, 1000, .3, steps)
    p.bodies = [(ball(cells, .1), "translate = [-0.2, 0.43, 0]\n")]
    p.obstacles = [(None, "plane = {}\n"),
                   (None, "shape = { box = { lower = [-0.3, -0.01, -0.2], upper = [0.3, 0.01, 0.2], cells = [2, 1, 2] } }\n"
                          "rotate = { axis = [0, 0, 1], angle_deg = -30 }\ntranslate = [0, 0.16, 0]\n")]
    return p


def knives(steps=50):
    p = Problem(.02, 2e4, .4, 1000, 0, steps)
    p.bodies = [(grid((40, 3, 19), (-.5, 0, -.25), (.5, .06, .25)), "translate = [0, 0.05, 0]\n")]
    p.obstacles = [(prism([(x - .01, -.3), (x + .01, -.3), (x, 0)], .4), "") for x in (-.25, 0, .25)]
    return p


def funnel(steps=50):
    p = Problem(.02, 1e5, .4, 1000, .1, steps, gravity=0.)
    p.bodies = [(ball(19, .2, (0, .35, 0)), '[[body.pin]]\nwhere = { lowest = 0.03 }\n'
                 'motion = { linear = { velocity = [0, -0.6, 0] } }\n')]
    p.obstacles = [(revolved([(.5, .4), (.13, 0), (.13, -.4), (.16, -.4), (.16, -.02), (.53, .38)]), "")]
    return p


def rollers(steps=50):
    p = Problem(.02, 5e5, .4, 1000, .5, steps)
    p.bodies = [(ball(18, .2), "translate = [0, 0.42, 0]\n")]
    p.obstacles = [(roller(.2, .4), f"translate = [{x}, 0, 0]\nmotion = {{ rotate = {{ axis = [0, 0, 1], rate_deg = {rate} }} }}\n")
                   for x, rate in ((-.3, -90), (.3, 90))]
    return p


def twist(cells=149, steps=50):
    p = Problem(.04, 2e4, .4, 1000, 0, steps, gravity=0.)
    ends = "".join(f"[[body.pin]]\nwhere = \"{where}\"\nmotion = {{ rotate = {{ axis = [1, 0, 0], center = [0, 0, 0], rate_deg = {rate} }} }}\n"
                   for where, rate in (("X < -0.4999", -72), ("X > 0.4999", 72)))
    p.bodies = [(grid((cells, 1, cells), (-.5, -.5 / cells, -.5), (.5, .5 / cells, .5)), ends)]
    return p


def boxes(steps=100):
    p = Problem(.01, 1e5, .4, 1000, .3, steps)
    mesh = grid((4, 4, 4), (-.05, -.05, -.05), (.05, .05, .05))
    for k in range(100):
        layer, place = divmod(k, 9)
        shift = .01 * (-1) ** layer
        x, z = (place % 3 - 1) * .13 + shift, (place // 3 - 1) * .13 - shift
        p.bodies.append((mesh, f"rotate = {{ axis = [{1 + k % 3}, 1, {k % 2}], angle_deg = {7 * (k % 5)} }}\n"
                               f"translate = [{x}, {.1 + .17 * layer:.3f}, {z}]\n"))
    walls = (("0, 0, 0", "0, 1, 0"), ("-0.25, 0, 0", "1, 0, 0"), ("0.25, 0, 0", "-1, 0, 0"), ("0, 0, -0.25", "0, 0, 1"), ("0, 0, 0.25", "0, 0, -1"))
    p.obstacles = [(None, f"plane = {{ origin = [{origin}], normal = [{normal}] }}\n") for origin, normal in walls]
    return p


def slab(cells=34, steps=50):
    """One layer of tets falls onto a sphere and drapes over it."""
    p = Problem(.01, 1e5, .3, 1000, .3, steps)
    p.bodies = [(grid((cells, 1, cells), (-.5, 0, -.5), (.5, .01, .5)), "translate = [0, 0.31, 0]\n")]
    p.obstacles = [(None, "sphere = { center = [0, 0, 0], radius = 0.3 }\n")]
    return p


SHELL = "shell = { thickness = 1e-3, moment = 1e-5 }\n"


def hanging(size=.0107, steps=60):
    """A cloth of 1 m hangs from two corners, without contact."""
    p = Problem(1 / 60, 1e6, .3, 200, 0, steps)
    p.bodies = [(sheet(1, 1, size), SHELL + '[[body.pin]]\nwhere = "abs(X) > 0.499 && Z < -0.499"\n')]
    return p


def draped(size=.0107, steps=60):
    """The same cloth falls onto a ball."""
    p = Problem(1 / 60, 1e6, .3, 200, .3, steps)
    p.bodies = [(sheet(1, 1, size), SHELL + "translate = [0.01, 0.31, 0.02]\n")]
    p.obstacles = [(None, "sphere = { center = [0, 0, 0], radius = 0.3 }\n")]
    return p


def stack(size=.031, steps=200):
    """Eight cloths fall onto each other and a floor."""
    p = Problem(1 / 60, 1e6, .3, 200, .3, steps)
    mesh = sheet(1, 1, size)
    p.bodies = [(mesh, SHELL + f"rotate = {{ axis = [0, 1, 0], angle_deg = {11 * k} }}\ntranslate = [0, {.02 + .02 * k}, 0]\n") for k in range(8)]
    p.obstacles = [(None, "plane = {}\n")]
    return p


def cape(size=.0089, steps=60):
    """A cape on a moving capsule in wind."""
    p = Problem(1 / 60, 1e6, .3, 300, .3, steps)
    walk = 'motion = { displacement = [0, 0, "t - 0.5 * (1 - exp(-2 * t))"] }\n'
    p.bodies = [(sheet(1.1, 1.3, size), SHELL + "rotate = { axis = [1, 0, 0], angle_deg = -90 }\ntranslate = [0, 0.85, -0.2]\n"
                 f'[[body.pin]]\nwhere = "Y > 1.499 && abs(X) < 0.17"\n{walk}')]
    p.obstacles = [(None, f"capsule = {{ from = [0, 0.6, 0], to = [0, 1.42, 0], radius = 0.17 }}\n{walk}")]
    p.more = '[wind]\nvelocity = ["sin(2 * t)", 0, "-1 - 1.5 * sin(5 * t + 2 * x)"]\n'
    return p


def tablecloth(size=.0152, steps=40, speed=2.):
    """A cloth is pulled from under three boxes."""
    p = Problem(1 / 60, 1e6, .3, 200, .3, steps)
    box = grid((4, 4, 4), (-.06, 0, -.06), (.06, .12, .06))
    p.bodies = [(sheet(1, 1, size), SHELL + 'translate = [0, 0.005, 0]\n[[body.pin]]\nwhere = "X > 0.499"\n'
                 f'motion = {{ displacement = ["{speed} * max(0, t - 0.1)", 0, 0] }}\n')]
    p.bodies += [(box, f"translate = [{x}, 0.015, {z}]\n") for x, z in ((-.2, -.2), (.2, 0), (-.2, .2))]
    p.obstacles = [(None, "plane = {}\n")]
    return p


PROBLEMS = {"chute": chute, "knives": knives, "funnel": funnel, "rollers": rollers, "twist": twist, "boxes": boxes, "slab": slab,
            "slab_fine": lambda: slab(70), "hanging": hanging, "draped": draped, "draped_coarse": lambda: draped(.052), "stack": stack,
            "cape": cape, "tablecloth": tablecloth}
