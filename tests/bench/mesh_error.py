#!/usr/bin/python3
"""The estimate of the mesh error against refined solutions, in problems beyond those of `aspic verify`.

tests/bench/mesh_error.py [--aspic build/release/bin/aspic] [--only REGEX]

Truth: order = 2 on meshes of twice the cells. `energy`: k from the potential energies, as in the estimate. `force`: k from
the reaction of a pin that moves. `frequency`: k of the two lowest modes, of which the motion is a sum, against the least
and the largest estimate. With the Debian package
python3-dolfinx, a beam is also compared with a solution of another program.
"""
import argparse
import csv
import math
import pathlib
import re
import subprocess
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]

BOX = 'shape = {{ box = {{ upper = {upper}, cells = {cells} }} }}\norder = {order}\n'
STATIC = '[time]\nintegrator = "quasi_static"\nstep = {step}\nduration = 1.0\n'
DYNAMIC = '[time]\nstep = 0.01\nduration = {duration}\n'
SOLVER = '[solver]\ntolerance = 1e-8\n[output]\nreport = false\nusd = false\npc2 = false\nvtu = false\n'
HARD = 'material = {{ model = "neo_hookean", young = 1e5, poisson = {nu}, density = 1000 }}\n'
WALL = '[[body.pin]]\nname = "wall"\nwhere = "x < 1e-6"\n'


def body(name, upper, cells, order, rest):
    return f'[[body]]\nname = "{name}"\n' + BOX.format(upper=upper, cells=cells, order=order) + rest


def swinging(n, order):
    return ('gravity = [0, 0, 0]\n' + DYNAMIC.format(duration=3.0) + SOLVER.replace("[output]", 'mesh_error = "frames"\n[output]\nevery = 0.1') +
            body("beam", [1, .1, .1], [10 * n, n, n], order, HARD.format(nu=.4) + 'velocity = [0, "0.1 * X^2", 0]\n' + WALL))


def pressed(n, order, friction=.5):
    return ('gravity = [0, 0, 0]\n' + STATIC.format(step=.1) + SOLVER + f'[contact]\nfriction = {friction}\n[[obstacle]]\nplane = {{ origin = [0, -0.0005, 0] }}\n' +
            body("block", [.1, .1, .1], [2 * n] * 3, order, HARD.format(nu=.3) +
                 '[[body.pin]]\nname = "top"\nwhere = "y > 0.1 - 1e-6"\nmotion = { displacement = [0, "-0.02 * t", 0] }\n'))


def buckled(n, order):
    return ('gravity = [0, 0, 0]\n' + STATIC.format(step=.05) + SOLVER +
            body("column", [1, .1, .1], [10 * n, n, n], order, HARD.format(nu=.3) + WALL +
                 '[[body.pin]]\nname = "end"\nwhere = "x > 1 - 1e-6"\nmotion = { displacement = ["-0.08 * t", "0.002 * t", 0] }\n'))


def fibres(n, order):
    return ('gravity = [0, -2, 0]\n' + STATIC.format(step=1.0) + SOLVER +
            body("beam", [.6, .1, .1], [6 * n, n, n], order, HARD.format(nu=.3) + '[[body.fibre]]\ndirection = [1, 0, 0]\nstiffness = 2e5\n' + WALL))


def branches(n, order):
    return ('gravity = [0, -2, 0]\n' + DYNAMIC.format(duration=3.0) + SOLVER +
            body("beam", [.6, .1, .1], [6 * n, n, n], order, HARD.format(nu=.3) + 'damping = { mass = 5 }\n[[body.viscoelastic]]\nshear = 2e4\nrelaxation_time = 0.1\n' + WALL))


def two_bodies(n, order):
    clamp = lambda x: f'[[body.pin]]\nname = "wall"\nwhere = "x < {x} + 1e-6"\n'
    return ('gravity = [0, -2, 0]\n' + STATIC.format(step=1.0) + SOLVER +
            body("soft", [.6, .1, .1], [6 * n, n, n], order, HARD.format(nu=.3) + clamp(0)) +
            body("stiff", [.3, .2, .2], [3 * n, 2 * n, 2 * n], order, HARD.format(nu=.3).replace("1e5", "1e6") + 'translate = [2, 0, 0]\n' + clamp(2)))


def settled(n, order):
    return ('gravity = [0, -2, 0]\n' + DYNAMIC.format(duration=3.0) + SOLVER +
            body("beam", [.6, .1, .1], [6 * n, n, n], order, HARD.format(nu=.3) + 'damping = { mass = 5 }\n' + WALL))


CASES = {"block pressed on a floor, mu = 0.5": (pressed, "force"),
         "block pressed on a floor, no friction": (lambda n, order: pressed(n, order, 0), "force"),
         "column beyond buckling": (buckled, "energy"), "beam with fibres": (fibres, "energy"), "damped beam, at rest": (settled, "energy"),
         "beam with a Maxwell branch, relaxed": (branches, "energy"), "two bodies": (two_bodies, "energy")}


class Runner:
    def __init__(self, aspic):
        self.aspic, self.folder = aspic, pathlib.Path(tempfile.mkdtemp(prefix="aspic_mesh_error_"))

    def run(self, text):
        scene = self.folder / "scene.toml"
        scene.write_text(text)
        done = subprocess.run([self.aspic, "run", scene, "--out", self.folder / "run", "--force", "--quiet", "--allow-unconverged"],
                              capture_output=True, text=True)
        if done.returncode:
            raise SystemExit(text + done.stderr)
        return list(csv.DictReader(open(self.folder / "run/steps.csv", newline="")))[-1]

    def frequencies(self, text):
        scene = self.folder / "scene.toml"
        scene.write_text(text)
        out = subprocess.run([self.aspic, "modes", scene, "--out", self.folder / "modes", "--force"], capture_output=True, text=True, check=True).stdout
        return [float(f) for f in re.findall(r"^ +[12] +(\S+)", out, re.M)]


def swing(runner):
    """The estimates of a beam that swings in its two lowest modes, and k of both."""
    runner.run(swinging(2, 1))
    rows = list(csv.DictReader(open(runner.folder / "run/steps.csv", newline="")))
    estimates = [float(row["mesh_stiffness"]) for row in rows if row["mesh_error"]]
    true = [(f / g) ** 2 - 1 for f, g in zip(runner.frequencies(swinging(2, 1)), runner.frequencies(swinging(4, 2)))]
    for name, of in (("least", min), ("most", max)):
        print(f"| swinging beam, {name} of {len(estimates)} times | frequency | {100 * of(true):.1f} | {100 * of(estimates):.1f} | "
              f"{of(estimates) / of(true):.2f} | |", flush=True)


def truth(runner, make, kind, row):
    fine = runner.run(make(4, 2))
    if fine["status"] not in ("converged", "round_off"):
        print("  reference:", fine["status"])
    if kind == "force":
        force = lambda r: float(r[next(key for key in r if key.startswith("reaction_") and key.endswith("top_y"))])
        return force(row) / force(fine) - 1
    elastic = lambda r: sum(float(r[key]) for key in r if key.startswith("potential_") and not re.search("total|gravity|visco", key))
    total = lambda r: float(r["potential_total"])
    return (total(row) - total(fine)) / min(elastic(row), elastic(fine))


def with_dolfinx(runner):
    """A clamped beam under a traction, small strains: compliance of linear tets by Aspic, and by quadratic tets of dolfinx."""
    import logging
    import numpy as np
    import dolfinx
    import ufl
    from mpi4py import MPI
    from petsc4py import PETSc
    logging.disable(logging.INFO)
    print("\nBeam of 6 x 1 x 1 m, traction on its end, by dolfinx with quadratic tets of 1/4 m (linear elasticity):")
    for nu in (.3, .45):
        mesh = dolfinx.mesh.create_box(MPI.COMM_SELF, [[0, 0, 0], [6., 1., 1.]], [24, 4, 4])
        V = dolfinx.fem.VectorFunctionSpace(mesh, ("CG", 2))
        u, v = ufl.TrialFunction(V), ufl.TestFunction(V)
        mu, la = 1e5 / 2 / (1 + nu), 1e5 * nu / (1 + nu) / (1 - 2 * nu)
        eps = lambda w: ufl.sym(ufl.grad(w))
        a = ufl.inner(2 * mu * eps(u) + la * ufl.tr(eps(u)) * ufl.Identity(3), eps(v)) * ufl.dx
        end = dolfinx.mesh.locate_entities_boundary(mesh, 2, lambda x: np.isclose(x[0], 6))
        tags = dolfinx.mesh.meshtags(mesh, 2, np.sort(end), np.full(len(end), 1, np.int32))
        traction = dolfinx.fem.Constant(mesh, PETSc.ScalarType((0, 0, -2)))
        load = ufl.inner(traction, v) * ufl.Measure("ds", mesh, subdomain_data=tags)(1)
        wall = dolfinx.fem.locate_dofs_geometrical(V, lambda x: np.isclose(x[0], 0))
        clamp = dolfinx.fem.dirichletbc(np.zeros(3, PETSc.ScalarType), wall, V)
        solution = dolfinx.fem.petsc.LinearProblem(a, load, [clamp], petsc_options={"ksp_type": "preonly", "pc_type": "cholesky"}).solve()
        work = dolfinx.fem.assemble_scalar(dolfinx.fem.form(ufl.inner(traction, solution) * ufl.Measure("ds", mesh, subdomain_data=tags)(1)))
        for cells in (2, 3):
            row = runner.run('gravity = [0, 0, 0]\n' + STATIC.format(step=1.0) + SOLVER + body(
                "beam", [6, 1, 1], [6 * cells, cells, cells], 1, HARD.format(nu=nu) + WALL +
                '[[body.traction]]\nwhere = "x > 6 - 1e-6"\nvalue = [0, 0, -2]\n'))
            true = work / 2 / float(row["potential_elasticity"]) - 1
            print(f"  nu = {nu}, {cells} cells: truth {100 * true:.1f} %, estimate {100 * float(row['mesh_stiffness']):.1f} %, "
                  f"ratio {float(row['mesh_stiffness']) / true:.3f}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--aspic", default=ROOT / "build/release/bin/aspic")
    parser.add_argument("--only", default="")
    given = parser.parse_args()
    runner = Runner(given.aspic)
    print("| problem, 2 cells across | truth by | true k [%] | estimate [%] | ratio | |\n|---|---|---|---|---|---|")
    if re.search(given.only, "swinging beam"):
        swing(runner)
    for name, (make, kind) in CASES.items():
        if not re.search(given.only, name):
            continue
        row = runner.run(make(2, 1))
        estimate = float(row["mesh_stiffness"])
        true = truth(runner, make, kind, row)
        note = "" if row["status"] in ("converged", "round_off") else row["status"]
        if "Unreliable" in row["mesh_error"]:
            note += " unreliable"
        if row["mesh_error"].startswith("no estimate"):
            note += row["mesh_error"]
        print(f"| {name} | {kind} | {100 * true:.1f} | {100 * estimate:.1f} | {estimate / true if true else math.nan:.2f} | {note} |", flush=True)
    if re.search(given.only, "dolfinx"):
        try:
            with_dolfinx(runner)
        except ImportError:
            print("dolfinx is not installed")


if __name__ == "__main__":
    main()
