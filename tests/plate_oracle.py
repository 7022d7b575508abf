#!/usr/bin/python3
"""Compares a cantilever plate of mid_edge bending with dolfinx: two deflections within 1 %.

Usage: plate_oracle.py ASPIC. Exit code 77: a package is missing.

A square of 1 m, nu = 0.3, is clamped along x = 0 and bends under its weight. dolfinx solves the same problem of a thin
plate by a C0 interior penalty method with quadratic triangles (Brenner and Sung, 2005).
"""
import os
import pathlib
import subprocess
import sys
import tempfile

os.environ["OMP_NUM_THREADS"] = "1"
try:
    import dolfinx
    import meshio
    import numpy as np
    import ufl
    from mpi4py import MPI
    from petsc4py import PETSc
except ImportError as error:
    print(f"skipped: {error} (Debian packages python3-dolfinx and python3-meshio)")
    sys.exit(77)

NU, MOMENT, WEIGHT = 0.3, 1.0, 1e-3  # [1], [N m], [N/m^2]
PLACES = ((1, 0), (1, 0.5))  # a corner and the middle of the free edge opposite to the clamped one
CELLS = 32
SCENE = f"""gravity = [0, 0, {-WEIGHT}]
time = {{ step = 1, duration = 1, integrator = "quasi_static" }}
output = {{ precision = "double", report = false }}
solver = {{ tolerance = 1e-8 }}
[[body]]
name = "plate"
mesh = "plate.obj"
shell = {{ thickness = 0.01, bending = "mid_edge", moment = {MOMENT} }}
material = {{ young = 1e6, poisson = {NU}, density = 100 }}
[[body.pin]]
where = "X < 1e-9"
"""


def write_plate(path):
    """An irregular grid, with a column of triangles beyond the clamped edge that hold its slope."""
    rng = np.random.default_rng(3)
    i, j = np.meshgrid(np.arange(-1, CELLS + 1), np.arange(CELLS + 1), indexing="ij")
    inside_x, inside_y = (i > 0) & (i < CELLS), (j > 0) & (j < CELLS)
    x = (i + inside_x * rng.uniform(-.2, .2, i.shape)) / CELLS
    y = (j + inside_y * rng.uniform(-.2, .2, i.shape)) / CELLS
    index = np.arange(i.size).reshape(i.shape) + 1
    with open(path, "w") as file:
        for a, b in zip(x.flat, y.flat):
            file.write(f"v {a:.17g} {b:.17g} 0\n")
        for a, b, c, d in zip(index[:-1, :-1].flat, index[1:, :-1].flat, index[1:, 1:].flat, index[:-1, 1:].flat):
            file.write(f"f {a} {b} {c}\nf {a} {c} {d}\n" if rng.random() < .5 else f"f {a} {b} {d}\nf {b} {c} {d}\n")


def by_aspic(aspic):
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        write_plate(folder / "plate.obj")
        (folder / "plate.toml").write_text(SCENE)
        subprocess.run([aspic, "run", folder / "plate.toml", "--out", folder / "out", "--quiet"], check=True)
        mesh = meshio.read(sorted((folder / "out/frames").glob("*.vtu"))[-1])
    u = mesh.point_data["displacement"]
    rest = mesh.points - u
    return np.array([u[np.hypot(rest[:, 0] - x, rest[:, 1] - y).argmin(), 2] for x, y in PLACES])


def by_dolfinx(cells=32):
    mesh = dolfinx.mesh.create_unit_square(MPI.COMM_SELF, cells, cells)
    V = dolfinx.fem.FunctionSpace(mesh, ("CG", 2))
    w, v = ufl.TrialFunction(V), ufl.TestFunction(V)
    n, h = ufl.FacetNormal(mesh), ufl.CellDiameter(mesh)
    clamped = dolfinx.mesh.locate_entities_boundary(mesh, 1, lambda x: np.isclose(x[0], 0))
    tags = dolfinx.mesh.meshtags(mesh, 1, np.sort(clamped), np.ones(len(clamped), np.int32))
    ds = ufl.Measure("ds", mesh, subdomain_data=tags)(1)
    hessian = lambda u: ufl.grad(ufl.grad(u))
    moments = lambda u: MOMENT * ((1 - NU) * hessian(u) + NU * ufl.tr(hessian(u)) * ufl.Identity(2))
    across = lambda u: ufl.inner(moments(u) * n, n)
    slope = lambda u: ufl.dot(ufl.grad(u), n)
    jump = lambda u: ufl.jump(ufl.grad(u), n)
    mean = lambda u: ufl.avg(across(u))
    a = ufl.inner(moments(w), hessian(v)) * ufl.dx
    a += (-mean(w) * jump(v) - jump(w) * mean(v) + 8 * MOMENT / ufl.avg(h) * jump(w) * jump(v)) * ufl.dS
    a += (-across(w) * slope(v) - slope(w) * across(v) + 16 * MOMENT / h * slope(w) * slope(v)) * ds
    load = dolfinx.fem.Constant(mesh, PETSc.ScalarType(-WEIGHT)) * v * ufl.dx
    held = dolfinx.fem.locate_dofs_topological(V, 1, clamped)
    pin = dolfinx.fem.dirichletbc(PETSc.ScalarType(0), held, V)
    solution = dolfinx.fem.petsc.LinearProblem(a, load, [pin], petsc_options={"ksp_type": "preonly", "pc_type": "lu"}).solve()
    X = V.tabulate_dof_coordinates()
    return np.array([solution.x.array[np.hypot(X[:, 0] - x, X[:, 1] - y).argmin()] for x, y in PLACES])


def main():
    found, expected = by_aspic(sys.argv[1]), by_dolfinx()
    for place, a, b in zip(PLACES, found, expected):
        print(f"deflection at {place}: {a:.6g} m, dolfinx {b:.6g} m, {100 * (a / b - 1):+.2f} %")
    assert np.all(np.abs(found / expected - 1) < .01)


main()
