"""Hard cases of contact: degenerate shapes, extreme numbers, bad surfaces. `long` cases have more steps."""
import itertools
import math
import random
import re

from contact_scenes import body, case, heights, pin, stays_above, touches
from contact_shapes import (SHAPES, box, crack, hole, internal_edges, lattice, obj_text, placed, sliver_box, spike,
                            surface_text)

TOP = {"spike": 3, "wedge": 3, "cliff": 1, "crack": .5, "hole": -1.85, "internal edges": 1}
FLOOR = [((0, 0, 0), (0, 1, 0))]


def sheet(half=2.0, y=0.0, cells=1):
    """An open square of triangles."""
    grid = [(-half + 2 * half * i / cells, y, -half + 2 * half * k / cells) for i in range(cells + 1) for k in range(cells + 1)]
    at = lambda i, k: i * (cells + 1) + k
    triangles = [t for i in range(cells) for k in range(cells)
                 for t in ((at(i, k), at(i, k + 1), at(i + 1, k)), (at(i + 1, k), at(i, k + 1), at(i + 1, k + 1)))]
    return obj_text(grid, triangles)


def all_of(*checks):
    return lambda outcome: [fault for check in checks for fault in check(outcome)]


def degenerate_shapes(steps):
    """An inverted shape falls onto an obstacle."""
    pairs = [("spike", "spike", {}), ("spike", "wedge", {}), ("spike", "crack", {}), ("spike", "hole", {}),
             ("wedge", "wedge", {}), ("wedge", "wedge", {"turn_deg": 90}), ("wedge", "crack", {}), ("cliff", "cliff", {}),
             ("cliff", "internal edges", {}), ("spike", "internal edges", {})]
    for upper, lower, turn in pairs:
        height = TOP[upper] + TOP[lower] + .02
        mesh = placed(SHAPES[upper](), (0, height, 0), flip=True, **turn)
        yield case(f"{upper} on {lower}{' crossed' if turn else ''}", [body("upper", mesh, more="velocity = [0, -1, 0]")],
                   obstacles=[("lower", surface_text(SHAPES[lower]()))], steps=steps, contact="friction = 0.2",
                   check=touches, codes=(0, 3))
    for cells in (3, 8):
        fine = placed(box((-.5, 0, -.5), (.5, .5, .5), (cells, cells // 2, cells)), (.013, 3.02, .027))
        yield case(f"box of {cells} cells on spike", [body("box", fine, more="velocity = [0, -1, 0]")],
                   obstacles=[("spike", surface_text(spike()))], steps=min(steps, 25), check=gap_above(1e-6))
    yield case("box slides over internal edges",
               [body("slider", placed(box((-.25, 0, -.25), (.25, .5, .25), (2, 2, 2)), (-.5, 1.02, 0)), more="velocity = [2, -0.5, 0]")],
               obstacles=[("lower", surface_text(internal_edges()))], steps=steps, check=straight)


def gap_above(least):
    def check(outcome):
        gaps = [float(r["min_gap"]) for r in outcome.rows if int(r["contacts"])]
        return [] if gaps and min(gaps) > least else [f"smallest gap {min(gaps, default=0):.2g} m, below {least}"]
    return check


def straight(outcome):
    """A body that slides over inner edges of a flat side must not turn."""
    rows = [[surface.points[c] for c in range(len(surface.points))] for surface, in outcome.frames]
    across = max(abs(sum(p[2] for p in points) / len(points)) for points in rows)
    return [] if across < 1e-3 else [f"moved sideways by {across:.2g}"]


def bullets(steps):
    """Fast bodies and thin plates."""
    bullet = placed(box((-.05, 0, -.05), (.05, .1, .05)), (0, .05, 0))
    for speed in (10, 1000):
        plate = body("plate", placed(box((-.5, 0, -.5), (.5, .01, .5)), (0, 0, 0)), young=1e7, more="")[0] + pin()
        files = body("plate", box((-.5, 0, -.5), (.5, .01, .5)))[1]
        yield case(f"bullet {speed} m/s on pinned plate", [(plate, files), body("bullet", bullet, young=1e6, more=f"velocity = [0, {-speed}, 0]")],
                   h=1e-3, steps=steps, check=all_of(touches, stays_above(.01, 1)), codes=(0, 3))
        yield case(f"bullet {speed} m/s on sheet", [body("bullet", bullet, young=1e6, more=f"velocity = [0, {-speed}, 0]")],
                   obstacles=[("sheet", sheet())], h=1e-3, steps=steps, check=stays_above(0), codes=(0, 3))
        yield case(f"bullet {speed} m/s on free plate", [body("plate", box((-.5, 0, -.5), (.5, .01, .5)), young=1e7),
                   body("bullet", bullet, young=1e6, more=f"velocity = [0, {-speed}, 0]")], h=1e-3, steps=steps, codes=(0, 3), gravity=(0, 0, 0))


def impact(seed):
    """Two random bodies collide at up to three times the speed of sound."""
    chance = random.Random(seed)
    young, density = [10 ** chance.uniform(3, 7) for _ in range(2)], [10 ** chance.uniform(2, 4) for _ in range(2)]
    speed = 10 ** chance.uniform(-2, .5) * min(math.sqrt(E / rho) for E, rho in zip(young, density))
    parts, size = [], 0
    for number, sign in enumerate((-1, 1)):
        kind = chance.choice(sorted(SHAPES) + ["box"] * 3)
        mesh = box(cells=(chance.randint(1, 3), chance.randint(1, 2), 1)) if kind == "box" else SHAPES[kind]()
        mesh = placed(mesh, flip=chance.random() < .5, turn_deg=chance.uniform(0, 360), tilt_deg=chance.uniform(0, 360),
                      scale=10 ** chance.uniform(-.5, .5))
        middle = [sum(p[k] for p in mesh[0]) / len(mesh[0]) for k in range(3)]
        mesh = placed(mesh, [-x for x in middle])
        reach = max(math.hypot(*p) for p in mesh[0])
        mesh = placed(mesh, (sign * (reach + .01), chance.uniform(-.1, .1) * reach, chance.uniform(-.1, .1) * reach))
        size = max(size, reach)
        parts.append(body("right" if number else "left", mesh, young=young[number], poisson=chance.choice([0, .3, .45]),
                          density=density[number], more=f"velocity = [{-sign * speed:.3g}, 0, 0]\n"
                          f"angular_velocity = [0, {chance.uniform(-1, 1) * speed / size:.2g}, {speed / size:.2g}]"))
    steps = chance.choice([6, 20])
    return case(f"impact {seed}", parts, h=2 * size / speed / steps, steps=steps, gravity=(0, 0, 0),
                contact=f"friction = {chance.choice([0, 0, .3, 1])}", codes=(0, 3))


def blow(seed):
    """A random body hits a thin sheet, or the wall of the hollow body around it."""
    chance = random.Random(seed)
    young, density = 10 ** chance.uniform(3, 7), 10 ** chance.uniform(2, 4)
    speed = 10 ** chance.uniform(-2, 1) * math.sqrt(young / density)
    mesh = placed(SHAPES[chance.choice(sorted(SHAPES))](), flip=chance.random() < .5, turn_deg=chance.uniform(0, 360),
                  tilt_deg=chance.uniform(0, 360))
    middle = [sum(p[k] for p in mesh[0]) / len(mesh[0]) for k in range(3)]
    mesh = placed(mesh, [-x for x in middle])
    reach = max(math.hypot(*p) for p in mesh[0]) + .01
    flying = body("flying", placed(mesh, (0, reach, 0)), young=young, density=density, more=f"velocity = [0, {-speed:.3g}, 0]")
    rest = dict(h=reach / speed / chance.choice([1, 4]), steps=6, gravity=(0, 0, 0), contact=f"friction = {chance.choice([0, .3])}", codes=(0, 3))
    if chance.random() < .5:
        return case(f"blow {seed}", [flying], obstacles=[("sheet", sheet(20, cells=chance.randint(1, 5)))], check=stays_above(0), **rest)
    wall = chance.choice([.05, .5])
    nodes = (-reach - wall, -reach, reach, reach + wall)
    shell = lattice([nodes] * 3, lambda x: (x[0], x[1] + reach, x[2]), keep=lambda cell: cell != (1, 1, 1))
    return case(f"blow {seed}", [flying, body("shell", shell, young=10 ** chance.uniform(3, 7))], **rest)


def thing(chance, size):
    """A random shape, turned, with its center at the origin and its points within `size` of it. Half of them are thin."""
    side = lambda thin: 10 ** chance.uniform(-1.7, -.7) if thin else chance.uniform(.5, 1)
    kind = chance.choice(["spike", "wedge", "cliff", "crack", "hole"] + ["box"] * 5)
    sides = [side(thin) for thin in chance.choice(((0, 0, 0), (0, 0, 1), (0, 0, 1), (0, 1, 1)))]
    mesh = box((0, 0, 0), sides, [chance.randint(1, 2) for _ in sides]) if kind == "box" else SHAPES[kind]()
    mesh = placed(mesh, flip=chance.random() < .5, turn_deg=chance.uniform(0, 360), tilt_deg=chance.uniform(0, 360))
    middle = [sum(p[k] for p in mesh[0]) / len(mesh[0]) for k in range(3)]
    mesh = placed(mesh, [-x for x in middle])
    return placed(mesh, scale=size / max(math.hypot(*p) for p in mesh[0]))


def room(half):
    """Planes around -half < x, z < half and 0 < y < 2 half."""
    axis = lambda k, length: tuple(length * (i == k) for i in range(3))
    return [(tuple(x + y for x, y in zip((0, half, 0), axis(k, sign * half))), axis(k, -sign)) for k in range(3) for sign in (-1, 1)]


def crowd(seed):
    """Two to six random bodies and up to three obstacles fly towards the center of a room, at up to a third of the speed of sound."""
    chance = random.Random(seed)
    half, balls, parts, obstacles = chance.uniform(1, 1.5), [], [], []
    materials = [dict(young=10 ** chance.uniform(4, 6), poisson=chance.choice([0, .3, .45]), density=10 ** chance.uniform(2, 4))
                 for _ in range(chance.randint(2, 6))]
    speed = 10 ** chance.uniform(-2, -.5) * min(math.sqrt(m["young"] / m["density"]) for m in materials)
    steps, h = 20, chance.choice((.05, .1)) / speed
    for number in range(len(materials) + chance.randint(0, 3)):
        for _ in range(1000):
            size, center = chance.uniform(.15, .5), [chance.uniform(-half, half) for _ in range(3)]
            if max(map(abs, center)) + size < half and all(math.dist(center, c) > size + r + 1e-3 for c, r in balls):
                break
        else:
            break
        balls.append((center, size))
        mesh = placed(thing(chance, size), (center[0], center[1] + half, center[2]))
        velocity, spin = [speed * (chance.uniform(-.5, .5) - x) for x in center], [chance.uniform(-2, 2) * speed for _ in range(3)]
        if number < len(materials):
            parts.append(body(f"body{number}", mesh, more=f"velocity = {velocity}\nangular_velocity = {spin}\nfriction = {chance.choice([0, .3, 1])}",
                              **materials[number]))
        else:
            path = ", ".join(f"'{.1 / h / steps * v / speed!r} * t'" for v in velocity)
            obstacles.append((f"solid{number}", surface_text(mesh), *[f"{{ displacement = [{path}] }}"] * chance.randint(0, 1)))
    one = case(f"crowd {seed}", parts, obstacles, room(half), h, steps, gravity=(0, chance.choice([0, -.1 * speed / h / steps]), 0), codes=(0, 3))
    one.scene = one.scene.replace("[time]", "[time]\n" + integrator(chance))
    return one


def integrator(chance):
    return f'integrator = "{chance.choice(["backward_euler", "bdf2"])}"\n'


def impacts(rows):
    """Beginnings of contact of a body on which no other forces act."""
    names = [k[:-2] for k in rows[0] if re.match("body_(?!moment_).*_x", k)]
    forces = [[max(abs(float(row[f"{n}_{axis}"])) for axis in "xyz") for n in names] for row in rows[1:]]
    least = 1e-9 * max(map(max, forces))
    return sum(before <= least < now for old, new in zip(forces, forces[1:]) for before, now in zip(old, new))


def loses_energy(outcome):
    """A step in which edges pass each other may gain energy, but none exceeds the energy at the start."""
    energy = [float(row["kinetic"]) + float(row["potential_total"]) for row in outcome.rows]
    gain = max(after / before for before, after in zip(energy, energy[1:])) - 1
    outcome.note = f"{impacts(outcome.rows)} impacts, largest gain {gain:.2g}, {energy[-1] / energy[0]:.2g} left"
    return ["more energy than at the start"] * (max(energy[1:]) > energy[0]) + ["few impacts"] * (impacts(outcome.rows) < 10)


def tumble(seed, steps=300):
    """Eight boxes fly and bounce in a closed room without gravity."""
    chance = random.Random(seed)
    young, mu, h = 10 ** chance.uniform(4.5, 6), chance.choice([0, .1, .5]), chance.choice([.002, .005])
    parts = []
    for number in range(8):
        place = [(.36 if number >> k & 1 else .12) - .24 * (k != 1) for k in range(3)]
        mesh = placed(box((-.05, -.05, -.05), (.05, .05, .05)), place, turn_deg=chance.uniform(0, 360), tilt_deg=chance.uniform(0, 360))
        parts.append(body(f"body{number}", mesh, young, .3, more=f"velocity = {[chance.uniform(-2, 2) for _ in range(3)]}\n"
                          f"angular_velocity = {[chance.uniform(-20, 20) for _ in range(3)]}"))
    one = case(f"tumble {seed}", parts, planes=room(.24), h=h, steps=steps, gravity=(0, 0, 0), contact=f"friction = {mu}", check=loses_energy)
    one.scene = one.scene.replace("[time]", "[time]\n" + integrator(chance)).replace("[output]", f"[output]\nevery = {5 * h}")
    return one


def bad_surfaces(steps):
    falling = body("falling", placed(box(cells=(2, 2, 2)), (0, .05, 0)), more="velocity = [0, -2, 0]")
    fan = obj_text([(0, 0, -2), (0, 0, 2), (2, 0, 0), (-2, 0, 0), (0, -2, 0)], [(0, 1, 2), (0, 1, 3), (0, 1, 4)])
    repeated = obj_text([(-2, 0, -2), (2, 0, -2), (0, 0, 2)], [(0, 1, 2), (0, 1, 2), (2, 1, 0)])
    crossing = obj_text([(-2, 0, -2), (2, 0, -2), (0, 0, 2), (0, -1, -1), (0, -1, 1), (0, -.01, 0), (-2, -.5, -2), (2, -.5, -2), (0, 0, 2)],
                        [(0, 1, 2), (3, 4, 5), (6, 7, 8)])
    flat = obj_text([(-2, 0, -2), (2, 0, -2), (0, 0, 2), (0, 0, 0), (0, 0, 0), (1, 0, 0)], [(0, 1, 2), (3, 4, 5), (0, 0, 1)])
    for name, surface in (("open sheet", sheet()), ("fan of three", fan), ("repeated triangles", repeated),
                          ("crossing obstacle", crossing), ("degenerate triangles", flat)):
        yield case(name, [falling], obstacles=[("lower", surface)], h=.01, steps=steps, check=all_of(touches, stays_above(0)), codes=(0, 2))
    for name, gap in (("coincident faces", 0.0), ("touching within round-off", 1e-16)):
        yield case(name, [body("lower", box()), body("upper", placed(box(), (0, 1 + gap, 0)))], h=.01, steps=2, codes=(0,))
    yield case("shared vertex", [body("lower", spike()), body("upper", placed(spike(), (0, 6, 0), flip=True))], h=.01, steps=2, codes=(0,))
    shell = lattice([(-1, -.8, .8, 1)] * 3, keep=lambda cell: cell != (1, 1, 1))
    yield case("nested bodies", [body("shell", placed(shell, (0, 1.01, 0))), body("core", placed(box(), (0, .52, 0)))], planes=FLOOR,
               h=.01, steps=steps, check=touches, codes=(0, 3))


def slivers(steps):
    for factor in (30, 1000):
        yield case(f"triangles of 1:{factor} onto sheet", [body("sliver", placed(sliver_box(factor), (0, .02, 0)), more="velocity = [0, -1, 0]")],
                   obstacles=[("sheet", sheet())], steps=steps, check=all_of(touches, stays_above(0)), codes=(0, 3))
    needle = obj_text([(-1000, 0, 0), (1000, 0, -.5), (1000, 0, .5), (-1000, 0, 1)], [(0, 2, 1), (0, 3, 2)])
    yield case("needle triangles as obstacle", [body("falling", placed(box(cells=(2, 2, 2)), (0, .05, .2)))], obstacles=[("needle", needle)],
               h=.01, steps=steps, codes=(0, 3))


def pinned(steps):
    """Bodies whose pins pull them against an obstacle."""
    strip = placed(lattice([[x / 4 for x in range(-4, 5)], (0, .1), (0, .2)]), (0, .05, 0))
    for name, speed in (("hangs on both sides", 0), ("pulled over an edge", 3)):
        motion = f'{{ displacement = [0, "-{speed} * t", 0] }}'
        ends = pin('"X < -0.99"', motion) + pin('"X > 0.99"', motion)
        text, files = body("strip", strip)
        ridge = obj_text([(0, 0, -1), (0, 0, 1), (.3, -2, 0), (-.3, -2, 0)], [(0, 1, 2), (1, 0, 3)])
        yield case(name, [(text + ends, files)], obstacles=[("ridge", ridge)], h=.01, steps=steps, codes=(0, 3), check=touches)
    cube = body("cube", placed(box(cells=(2, 2, 2)), (0, .01, 0)))
    squeeze = pin('{ highest = 0.01 }', '{ displacement = [0, "-0.6 * t / 0.1", 0] }')
    yield case("squeezed onto a sheet", [(cube[0] + squeeze, cube[1])], obstacles=[("sheet", sheet())], h=.01, steps=10, codes=(0, 3),
               check=all_of(touches, stays_above(0)))


def moving(steps):
    """Obstacles that squeeze bodies to nothing, jump into them, or pull pinned ones apart."""
    cube, down = body("cube", placed(box(cells=(2, 2, 2)), (0, .01, 0))), '{ displacement = [0, "-20 * t", 0] }'
    floor, lid = ("floor", sheet(5)), sheet(3, 1.03)
    yield case("press without end", [cube], obstacles=[floor, ("press", lid, down)], h=.01, steps=steps, codes=(3,), check=touches,
               words=("cube", "press"))
    jaws = [("left", plate((-.8, .51, 0)), '{ displacement = ["10 * t", 0, 0] }'),
            ("right", plate((.8, .51, 0)), '{ displacement = ["-10 * t", 0, 0] }')]
    yield case("jaws that close", [cube], obstacles=jaws, h=.01, steps=steps, gravity=(0, 0, 0), codes=(3,), words=("cube",))
    for name, motion in (("into the body", '{ displacement = [0, "t < 0.025 ? 0 : -1.5", 0] }'),
                         ("to the other side", '{ displacement = [0, "t < 0.025 ? 0 : -9", 0] }'),
                         ("back and forth", '{ displacement = [0, "t > 0.025 && t < 0.045 ? -1.5 : 0", 0] }')):
        yield case(f"obstacle jumps {name}", [cube], obstacles=[floor, ("lid", lid, motion)], h=.01, steps=steps, codes=(0, 3),
                   check=stays_above(0), words=("lid and cube",))
    strip = placed(lattice([[x / 4 for x in range(-4, 5)], (0, .1), (0, .2)]), (0, .05, 0))
    text, files = body("strip", strip)
    ridge = lambda tip, foot: obj_text([(0, tip, -1), (0, tip, 1), (.3, foot, 0), (-.3, foot, 0)], [(0, 1, 2), (1, 0, 3)])
    up, back = '{ displacement = [0, "6 * t", 0] }', '{ displacement = [0, "-6 * t", 0] }'
    for name, obstacles in (("pushed from below", [("lower", ridge(0, -2), up)]),
                            ("squeezed from both sides", [("lower", ridge(0, -2), up), ("upper", ridge(.2, 2.2), back)])):
        yield case(f"pinned strip {name}", [(text + pin('"X < -0.99"') + pin('"X > 0.99"'), files)], obstacles=obstacles, h=.01, steps=steps,
                   codes=(0, 3), check=touches, words=("strip",))


def plate(x):
    """An open square across the x axis."""
    return obj_text([(x[0], x[1] + y, x[2] + z) for y in (-2, 2) for z in (-2, 2)], [(0, 1, 2), (1, 3, 2)])


def driven(steps):
    """Pins and springs that move through an obstacle within a step: the body must stay on its side."""
    text, files = body("cube", placed(box(cells=(3, 3, 3)), (0, .02, 0)))
    down = '{ displacement = [0, "-100 * t", 0] }'
    spring = f"[[body.spring]]\nwhere = {{ lowest = 0.01 }}\nstiffness = 1e7\nmotion = {down}\n"
    turn = '{ rotate = { axis = [0, 0, 1], rate_deg = 3000.0 } }'
    for name, pull in (("pins", pin("{ highest = 0.01 }", down)), ("one pin", pin("{ vertices = [0] }", down)), ("springs", spring),
                       ("turning pins", pin("{ highest = 0.01 }", turn))):
        for integrator in ("backward_euler", "quasi_static"):
            if (name, integrator) == ("springs", "quasi_static"):
                continue  # nothing else holds the body
            one = case(f"{name} through a sheet, {integrator}", [(text + pull, files)], obstacles=[("sheet", sheet(5))], h=.01, steps=steps,
                       codes=(0, 3), check=stays_above(0))
            one.scene = one.scene.replace("[time]\n", f'[time]\nintegrator = "{integrator}"\n')
            yield one


def numbers(steps):
    ball = placed(box(cells=(2, 2, 2)), (0, .01, 0))
    for h in (1e-4, 1e-2, 1e-1, 1.0):
        yield case(f"h = {h}", [body("falling", ball)], planes=FLOOR, h=h, steps=steps, check=stays_above(0), contact="friction = 0.3")
        yield case(f"h = {h}, two boxes on sheet", [body("lower", ball), body("upper", placed(box(cells=(2, 2, 2)), (.2, 1.1, .1), turn_deg=20))],
                   obstacles=[("sheet", sheet(5))], h=h, steps=steps, check=stays_above(0), contact="friction = 0.3")
    for lower, upper in ((1e2, 1e12), (1e12, 1e2)):
        yield case(f"E = {lower:g} below {upper:g}", [body("lower", placed(box(cells=(2, 2, 2)), (0, .01, 0)), young=lower, density=1),
                   body("upper", placed(box(cells=(2, 2, 2)), (.1, 1.05, 0)), young=upper, density=1)], planes=FLOOR, h=.01, steps=steps,
                   check=all_of(touches, stays_above(0)), codes=(0, 3))
    for mu in (0, .1, 1, 10):
        yield case(f"mu = {mu}", [body("falling", ball, more="velocity = [1, -1, 0]")], planes=FLOOR, h=.01, steps=steps,
                   contact=f"friction = {mu}", check=all_of(touches, stays_above(0)))


def sliding_edges(steps):
    """Sharp edges that slide along each other, parallel."""
    prism = placed(SHAPES["wedge"](), (0, 6.01, 0), flip=True, scale=1)
    yield case("parallel edges", [body("upper", prism, more="velocity = [0, -0.5, 1]")], obstacles=[("lower", surface_text(SHAPES["wedge"]()))],
               steps=steps, codes=(0, 3))
    slider = placed(box((-.1, 0, -.1), (.1, .2, .1)), (0, .01, -2))
    rails = [("rail", surface_text(placed(lattice([(-.1, .1), (-1, 0), (-9, 9)]), (0, 0, 0))))]
    yield case("box on a rail of its width", [body("slider", slider, more="velocity = [0, 0, 0.5]")], obstacles=rails, h=.01, steps=steps,
               check=all_of(touches, stays_above(0)))


GROUPS = {"shapes": degenerate_shapes, "bullets": bullets, "surfaces": bad_surfaces, "slivers": slivers, "pins": pinned, "driven": driven, "moving": moving,
          "numbers": numbers, "edges": sliding_edges, "crowds": lambda count: map(crowd, range(count)), "tumbles": lambda count: map(tumble, range(count)),
          "impacts": lambda count: (make(seed) for seed in range(count) for make in (impact, blow))}
LONG = {"shapes": 100, "bullets": 20, "surfaces": 30, "slivers": 10, "pins": 30, "driven": 6, "moving": 15, "numbers": 30, "edges": 1000, "crowds": 1000, "tumbles": 100, "impacts": 500}
