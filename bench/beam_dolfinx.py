#!/usr/bin/python3
"""A nearly incompressible beam by Aspic and by dolfinx: error and CPU time on the same meshes.

bench/beam_dolfinx.py [--aspic build/release/bin/aspic] [--cells 2 4 8] [--csv FILE]

A beam 2 x 1 x 1, E = 1, nu = 0.4999, clamped at x = 0, with a small traction along y on its end. Aspic: quadratic tets
with the mean volume. dolfinx: quadratic displacements and linear pressures (Taylor-Hood), Newton's method with MUMPS.
The compliance is compared with the limit 35.96 of statics/beam_incompressible in `aspic verify`. One thread each; the
CPU time is that of the step, without reading, compiling or writing. Needs the Debian package python3-dolfinx.
"""
import argparse
import csv
import logging
import os
import pathlib
import subprocess
import sys
import tempfile
import time

os.environ["OMP_NUM_THREADS"] = "1"
LIMIT, TRACTION, NU = 35.96, 1e-5, 0.4999
SCENE = """gravity = [0, 0, 0]
[time]
integrator = "quasi_static"
step = 1.0
duration = 1.0
[solver]
tolerance = 1e-6
[output]
vtu = false
report = false
usd = false
[[body]]
name = "beam"
shape = {{ box = {{ upper = [2, 1, 1], cells = [{twice}, {n}, {n}] }} }}
order = 2
material = {{ model = "neo_hookean", young = 1.0, poisson = {nu}, density = 1.0 }}
[[body.pin]]
name = "wall"
where = "X < 1e-9"
[[body.traction]]
where = "X > 2 - 1e-9"
value = [0, {traction}, 0]
"""


def columns(path):
    with open(path) as file:
        return list(csv.DictReader(file))


def aspic(program, n):
    """Returns unknowns, compliance and CPU time [s]."""
    with tempfile.TemporaryDirectory() as folder:
        scene, out = pathlib.Path(folder, "beam.toml"), pathlib.Path(folder, "out")
        scene.write_text(SCENE.format(n=n, twice=2 * n, nu=NU, traction=TRACTION))
        subprocess.run([program, "run", scene, "--threads", "1", "--out", out, "--quiet"], check=True)
        rows = columns(out / "steps.csv")
        seconds = sum(float(row["cpu_seconds"]) for row in columns(out / "timings.csv"))
    work = float(rows[0]["potential_traction"]) - float(rows[-1]["potential_traction"])
    return 3 * (4 * n) * (2 * n + 1) ** 2, work / TRACTION**2, seconds


def taylor_hood(n):
    """The same by dolfinx."""
    import dolfinx
    import numpy as np
    import ufl
    from mpi4py import MPI
    from petsc4py import PETSc

    mesh = dolfinx.mesh.create_box(MPI.COMM_SELF, [[0, 0, 0], [2, 1, 1]], [2 * n, n, n])
    cell = mesh.ufl_cell()
    space = dolfinx.fem.FunctionSpace(mesh, ufl.MixedElement(ufl.VectorElement("P", cell, 2), ufl.FiniteElement("P", cell, 1)))
    state, test = dolfinx.fem.Function(space), ufl.TestFunction(space)
    u, p = ufl.split(state)
    mu, bulk = 1 / (2 * (1 + NU)), 1 / (3 * (1 - 2 * NU))
    F = ufl.Identity(3) + ufl.grad(u)
    J = ufl.det(F)
    psi = mu / 2 * (J ** (-2 / 3) * ufl.tr(F.T * F) - 3) + p * (J - 1) - p**2 / (2 * bulk)
    facets = dolfinx.mesh.locate_entities_boundary(mesh, 2, lambda x: np.isclose(x[0], 2))
    tags = dolfinx.mesh.meshtags(mesh, 2, np.sort(facets), np.ones(len(facets), dtype=np.int32))
    end = ufl.Measure("ds", domain=mesh, subdomain_data=tags)(1)
    energy = psi * ufl.dx(metadata={"quadrature_degree": 4}) - TRACTION * u[1] * end
    wall = dolfinx.mesh.locate_entities_boundary(mesh, 2, lambda x: np.isclose(x[0], 0))
    parts, _ = space.sub(0).collapse()
    dofs = dolfinx.fem.locate_dofs_topological((space.sub(0), parts), 2, wall)
    clamp = dolfinx.fem.dirichletbc(dolfinx.fem.Function(parts), dofs, space.sub(0))
    problem = dolfinx.fem.petsc.NonlinearProblem(ufl.derivative(energy, state, test), state, bcs=[clamp])
    solver = dolfinx.nls.petsc.NewtonSolver(MPI.COMM_SELF, problem)
    solver.rtol = 1e-6
    solver.convergence_criterion = "residual"
    solver.krylov_solver.setType("preonly")
    solver.krylov_solver.getPC().setType("lu")
    solver.krylov_solver.getPC().setFactorSolverType("mumps")
    begin = time.process_time()
    _, converged = solver.solve(state)
    seconds = time.process_time() - begin
    if not converged:
        sys.exit("dolfinx did not converge")
    work = dolfinx.fem.assemble_scalar(dolfinx.fem.form(TRACTION * u[1] * end))
    return space.dofmap.index_map.size_global * space.dofmap.index_map_bs, work / TRACTION**2, seconds


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--aspic", default="build/release/bin/aspic", help="Program")
    parser.add_argument("--cells", type=int, nargs="+", default=[2, 4, 8], help="Cells per unit of length")
    parser.add_argument("--csv", help="Write the table to this file")
    options = parser.parse_args()
    logging.disable(logging.WARNING)  # the compiler's commands
    rows = [["program", "cells", "unknowns", "error", "cpu_s"]]
    for n in options.cells:
        for name, solve in ("aspic", lambda k: aspic(options.aspic, k)), ("dolfinx", taylor_hood):
            unknowns, compliance, seconds = solve(n)
            rows.append([name, n, unknowns, f"{compliance / LIMIT - 1:.4f}", f"{seconds:.2f}"])
            print("  ".join(f"{word!s:>9}" for word in (rows[0] if len(rows) == 2 else rows[-1])), flush=True)
            if len(rows) == 2:
                print("  ".join(f"{word!s:>9}" for word in rows[-1]), flush=True)
    if options.csv:
        with open(options.csv, "w", newline="") as file:
            csv.writer(file).writerows(rows)


if __name__ == "__main__":
    main()
