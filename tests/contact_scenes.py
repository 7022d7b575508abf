"""Scenes with contact, runs of them through the program, and exact checks of every frame."""
import csv
import dataclasses
import math
import os
import pathlib
import subprocess
import time

import contact_shapes as shapes
import exact_surfaces as exact

ASPIC = os.environ.get("ASPIC", "aspic")
SUCCESS = {"start", "converged", "round_off"}


@dataclasses.dataclass
class Case:
    """One run. `codes`: expected exit codes. `check`: returns the faults of a run with any exit code."""
    name: str
    scene: str
    files: dict = dataclasses.field(default_factory=dict)
    codes: tuple = (0,)
    limit: float = 600  # s, of a run that hangs
    check: object = None
    planes: tuple = ()  # pairs of origin and normal
    obstacles: tuple = ()  # names of OBJ files
    words: tuple = ()  # must be in the message of a run with exit code 3


@dataclasses.dataclass
class Outcome:
    faults: list
    code: object = None
    seconds: float = 0
    rows: list = dataclasses.field(default_factory=list)
    frames: list = dataclasses.field(default_factory=list)  # surfaces of the bodies
    message: str = ""
    note: str = ""  # of the case's check

    def line(self):
        total = lambda key: sum(int(r[key]) for r in self.rows)
        if not self.rows:
            return f"exit {self.code}, {self.seconds:.1f} s: {self.message.strip()[:150]}"
        gaps = [float(r["min_gap"]) for r in self.rows if int(r["contacts"])]
        most = max(self.rows, key=lambda r: int(r["iterations"]))
        return (f"exit {self.code}, {self.seconds:.1f} s, {len(self.rows) - 1} steps, {total('iterations')} iterations (most "
                f"{most['iterations']} in step {most['step']}), {total('friction_passes')} passes, smallest gap "
                f"{min(gaps, default=math.nan):.2g}, " + " ".join(sorted({r['status'] for r in self.rows} - {'start'}) + [self.note]))


def body(name, mesh, young=1e5, poisson=.4, density=1000, more=""):
    return (f'[[body]]\nname = "{name}"\nmesh = "{name}.mesh"\n{more}\nmaterial = {{ young = {young:g}, poisson = {poisson}, '
            f'density = {density:g} }}\n', {f"{name}.mesh": shapes.tet_text(mesh)})


def pin(where='"all"', motion=""):
    return f"[[body.pin]]\nwhere = {where}\n" + (f"motion = {motion}\n" if motion else "")


def case(name, bodies, obstacles=(), planes=(), h=.005, steps=20, contact="", gravity=(0, -9.81, 0), **rest):
    """`bodies`: results of body(), or pairs of such a result and text to append. `obstacles`: name, OBJ text and perhaps motion."""
    text = (f"gravity = [{gravity[0]}, {gravity[1]}, {gravity[2]}]\n[time]\nstep = {h!r}\nduration = {h * steps!r}\n"
            f"[output]\nreport = false\nusd = false\npc2 = false\n[contact]\n{contact}\n")
    files = {}
    for part, own in bodies:
        text += part
        files.update(own)
    for obstacle, surface, *motion in obstacles:
        text += f'[[obstacle]]\nname = "{obstacle}"\nmesh = "{obstacle}.obj"\n' + "".join(f"motion = {m}\n" for m in motion)
        files[obstacle + ".obj"] = surface
    for origin, normal in planes:
        text += f"[[obstacle]]\nplane = {{ origin = {list(origin)}, normal = {list(normal)} }}\n"
    return Case(name, text, files, planes=tuple(planes), obstacles=tuple(o[0] for o in obstacles), **rest)


def ledger_faults(rows):
    """The energies of the ledger balance up to round-off of its largest term, and no step gains energy."""
    faults = []
    for row in rows[1:]:
        terms = [abs(float(row[k])) for k in row if k in ("kinetic", "damping_loss", "numerical_loss", "pin_work",
                                                           "residual_work") or k.startswith("potential_")]
        if not abs(float(row["ledger_error"])) <= 1e-9 * max(terms):
            faults.append(f"step {row['step']}: ledger error {row['ledger_error']}, largest term {max(terms):.3g}")
        if row["energy_bound"] == "broken":
            faults.append(f"step {row['step']}: energy above its bound by {row['energy_slack']}")
    return faults[:3]


def surface_faults(frames, obstacles, planes):
    """Returns intersections, and pairs of surfaces of which one is inside the other. `obstacles`: their surfaces, or a list of
    them for each frame."""
    faults, first, is_closed = [], None, {}

    def closed(number, b, part):
        if number == 0:
            is_closed[b] = exact.is_closed(part)
        return is_closed[b]

    for number, bodies in enumerate(frames):
        surfaces = bodies + (obstacles[number] if obstacles and isinstance(obstacles[0], list) else obstacles)
        found = exact.intersections(surfaces)
        if found:
            faults.append(f"frame {number}: {len(found)} intersections, for example {found[0]}")
        for origin, normal in planes:
            for surface in bodies:
                if exact.behind_plane(surface, origin, normal):
                    faults.append(f"frame {number}: {surface.name} is behind a plane")
        parts = [part for surface in surfaces for part in exact.components(surface)]
        inside = {(a, b): exact.is_inside(parts[a].points[parts[a].triangles[0][0]], parts[b])
                  for a in range(len(parts)) for b in range(len(parts))
                  if a != b and not (parts[a].is_obstacle and parts[b].is_obstacle) and closed(number, b, parts[b])}
        first = first or inside
        faults += [f"frame {number}: {parts[a].name} has changed sides of {parts[b].name}"
                   for (a, b), now in inside.items() if now != first[a, b]]
    return faults[:5]


def run(case, folder, aspic=None):
    """Runs a case in an empty folder and checks the properties of every run."""
    folder = pathlib.Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    for name, text in {"scene.toml": case.scene, **case.files}.items():
        (folder / name).write_text(text)
    start = time.monotonic()
    command = [aspic or ASPIC, "run", "scene.toml", "--out", "run", "--quiet", "--force"]
    try:
        done = subprocess.run(command, cwd=folder, capture_output=True, text=True, timeout=case.limit)
    except subprocess.TimeoutExpired:
        outcome = read_run(case, folder, Outcome([f"busy after {case.limit} s"]))
        outcome.code, outcome.seconds = "none", case.limit
        return outcome
    outcome = Outcome([], done.returncode, time.monotonic() - start, message=done.stderr)
    if done.returncode not in case.codes:
        outcome.faults.append(f"exit code {done.returncode}: {done.stderr.strip()[-300:]}")
    if done.returncode in (0, 3, 4):
        read_run(case, folder, outcome)
    elif done.returncode == 2 and not done.stderr.strip():
        outcome.faults.append("no message")
    if done.returncode == 3:
        outcome.faults += [f"no '{word}' in: {done.stderr.strip()[:300]}" for word in case.words if word not in done.stderr]
    return outcome


def read_run(case, folder, outcome):
    try:
        with open(folder / "run/steps.csv", newline="") as file:
            outcome.rows = list(csv.DictReader(file))
    except OSError:
        return outcome
    failed = [r for r in outcome.rows if r["status"] not in SUCCESS]
    if outcome.code == 0 and failed:
        outcome.faults.append(f"exit code 0 with status {failed[0]['status']}")
    if outcome.code == 0:
        outcome.faults += ledger_faults(outcome.rows)
    outcome.frames = [exact.body_surfaces(p) for p in sorted((folder / "run/frames").glob("body_*.vtu"))]
    obstacles = [exact.Surface(o, *exact.read_obj(folder / (o + ".obj")), True) for o in case.obstacles]
    moving = [[exact.read_surface(p)] for p in sorted((folder / "run/frames").glob("obstacles_*.vtu"))]
    obstacles = moving[:len(outcome.frames)] or obstacles
    outcome.faults += surface_faults(outcome.frames, obstacles, case.planes)
    if case.check and outcome.frames:
        outcome.faults += case.check(outcome)
    return outcome


def heights(surface):
    return [surface.points[c][1] for t in surface.triangles for c in t]


def stays_above(height, index=0):
    """Returns a check that all points of a body stay above a height in all frames."""
    def check(outcome):
        low = [min(heights(frame[index])) for frame in outcome.frames]
        return [] if min(low) > height else [f"a point at height {min(low):.6g}, below {height}"]
    return check


def touches(outcome):
    return [] if any(int(r["contacts"]) for r in outcome.rows) else ["nothing has touched"]
