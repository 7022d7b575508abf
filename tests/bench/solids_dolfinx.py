#!/usr/bin/python3
"""Nearly incompressible solids by Aspic and by dolfinx: error and CPU time on the same meshes.

tests/bench/solids_dolfinx.py [beam] [cook] [--aspic build/release/bin/aspic] [--cells 2 4 8] [--csv FILE]

beam: 2 x 1 x 1, E = 1, clamped at x = 0, with a small traction along y on its end. The compliance is compared with the
limit 35.96 of statics/beam_incompressible in `aspic verify`. cook: Cook's membrane in plane strain, mu = 80.1938, a
load of 100 on its right edge in ten steps; the displacement of the middle of this edge is compared with the limit 6.963
of statics/cook_incompressible. nu = 0.4999, W = mu/2 (J^(-2/3) I1 - 3) + K/2 (J - 1)^2. Aspic: quadratic tets with the
mean volume. dolfinx: quadratic displacements and linear pressures (Taylor-Hood), Newton's method with MUMPS. Both
solve to a residual of 1e-6. One thread each; the CPU time is that of the steps, without reading, compiling or writing.
Needs the Debian packages python3-dolfinx and python3-meshio.
"""
import argparse
import csv
import dataclasses
import logging
import os
import pathlib
import subprocess
import sys
import tempfile
import time

import numpy as np

os.environ["OMP_NUM_THREADS"] = "1"
NU = 0.4999


@dataclasses.dataclass
class Problem:
    limit: float  # of the compared displacement over the traction
    mu: float
    traction: float
    steps: int
    length: float  # x of the loaded face
    watched: tuple  # the place whose displacement along y is compared
    is_plane: bool = False
    size: tuple = (2, 1, 1)

    def mesh(self, n):
        import dolfinx
        from mpi4py import MPI

        cells = [n * self.size[0], n * self.size[1], n * self.size[2]] if not self.is_plane else [n, n, 1]
        mesh = dolfinx.mesh.create_box(MPI.COMM_SELF, [[0, 0, 0], list(map(float, self.size))], cells)
        if self.is_plane:  # the unit square becomes Cook's trapezoid, as thick as its cells are long
            X, Y, Z = mesh.geometry.x.T.copy()
            mesh.geometry.x[:] = np.stack([48 * X, 44 * X + Y * (44 - 28 * X), Z * 48 / n], axis=1)
        return mesh


PROBLEMS = {"beam": Problem(35.96, 1 / (2 * (1 + NU)), 1e-5, 1, 2, ()),
            "cook": Problem(6.963 / 6.25, 80.1938, 6.25, 10, 48, (48, 52, 0), True, (1, 1, 1))}

SCENE = """gravity = [0, 0, 0]
[time]
integrator = "quasi_static"
step = {step}
duration = 1.0
[solver]
tolerance = 1e-6
[output]
report = false
usd = false
[[body]]
name = "solid"
mesh = "solid.mesh"
order = 2
material = {{ model = "neo_hookean_isochoric", young = {young}, poisson = {nu}, density = 1.0 }}
[[body.pin]]
where = "X < 1e-9"
{plane}[[body.traction]]
where = "X > {length} - 1e-9"
value = [0, "{traction}", 0]
"""


def write_medit(path, mesh):
    x, tets = mesh.geometry.x, mesh.geometry.dofmap.array.reshape(-1, 4).copy()
    edges = x[tets[:, 1:]] - x[tets[:, :1]]
    tets[np.linalg.det(edges) < 0] = tets[np.linalg.det(edges) < 0][:, [0, 2, 1, 3]]
    with open(path, "w") as file:
        file.write(f"MeshVersionFormatted 2\nDimension 3\nVertices\n{len(x)}\n")
        file.writelines(f"{a!r} {b!r} {c!r} 0\n" for a, b, c in x.tolist())
        file.write(f"Tetrahedra\n{len(tets)}\n")
        file.writelines("%d %d %d %d 0\n" % tuple(t + 1) for t in tets)
        file.write("End\n")


def columns(path):
    with open(path) as file:
        return list(csv.DictReader(file))


def aspic(program, problem, mesh):
    """Returns dofs, displacement over traction, and CPU time [s]."""
    import meshio

    plane = '[[body.pin]]\nwhere = "X > 1e-9"\naxes = "z"\n' if problem.is_plane else ""
    with tempfile.TemporaryDirectory() as folder:
        scene, out = pathlib.Path(folder, "solid.toml"), pathlib.Path(folder, "out")
        write_medit(scene.with_suffix(".mesh"), mesh)
        scene.write_text(SCENE.format(step=1 / problem.steps, young=2 * problem.mu * (1 + NU), nu=NU, plane=plane,
                                      length=problem.length, traction=f"{problem.traction} * t" if problem.steps > 1 else problem.traction))
        subprocess.run([program, "run", scene, "--threads", "1", "--out", out, "--quiet"], check=True)
        rows = columns(out / "steps.csv")
        seconds = sum(float(row["cpu_seconds"]) for row in columns(out / "timings.csv"))
        x = meshio.read(sorted((out / "frames").glob("*.vtu"))[-1]).points
    free = np.count_nonzero(np.abs(x[:, 0]) > 1e-9) * (2 if problem.is_plane else 3)
    if problem.watched:
        i = np.argmin(np.linalg.norm(mesh.geometry.x - problem.watched, axis=1))
        return free, (x[i, 1] - mesh.geometry.x[i, 1]) / problem.traction, seconds
    work = float(rows[0]["potential_traction"]) - float(rows[-1]["potential_traction"])
    return free, work / problem.traction**2, seconds


def taylor_hood(problem, mesh):
    """The same by dolfinx."""
    import dolfinx
    import ufl
    from mpi4py import MPI
    from petsc4py import PETSc

    cell = mesh.ufl_cell()
    space = dolfinx.fem.FunctionSpace(mesh, ufl.MixedElement(ufl.VectorElement("P", cell, 2), ufl.FiniteElement("P", cell, 1)))
    state, test = dolfinx.fem.Function(space), ufl.TestFunction(space)
    u, p = ufl.split(state)
    bulk = 2 * problem.mu * (1 + NU) / (3 * (1 - 2 * NU))
    F = ufl.Identity(3) + ufl.grad(u)
    J = ufl.det(F)
    psi = problem.mu / 2 * (J ** (-2 / 3) * ufl.tr(F.T * F) - 3) + p * (J - 1) - p**2 / (2 * bulk)
    facets = dolfinx.mesh.locate_entities_boundary(mesh, 2, lambda x: np.isclose(x[0], problem.length))
    tags = dolfinx.mesh.meshtags(mesh, 2, np.sort(facets), np.ones(len(facets), dtype=np.int32))
    end = ufl.Measure("ds", domain=mesh, subdomain_data=tags)(1)
    load = dolfinx.fem.Constant(mesh, PETSc.ScalarType(0))
    energy = psi * ufl.dx(metadata={"quadrature_degree": 4}) - load * u[1] * end
    held = [held_dofs(space, mesh, lambda x: np.isclose(x[0], 0))]
    if problem.is_plane:
        held.append(held_dofs(space, mesh, lambda x: np.full(x.shape[1], True), 2))
    nonlinear = dolfinx.fem.petsc.NonlinearProblem(ufl.derivative(energy, state, test), state, bcs=held)
    solver = dolfinx.nls.petsc.NewtonSolver(MPI.COMM_SELF, nonlinear)
    solver.rtol = 1e-6
    solver.convergence_criterion = "residual"
    solver.krylov_solver.setType("preonly")
    solver.krylov_solver.getPC().setType("lu")
    solver.krylov_solver.getPC().setFactorSolverType("mumps")
    begin = time.process_time()
    for step in range(problem.steps):
        load.value = problem.traction * (step + 1) / problem.steps
        _, converged = solver.solve(state)
        if not converged:
            sys.exit("dolfinx did not converge")
    seconds = time.process_time() - begin
    count = space.dofmap.index_map.size_global * space.dofmap.index_map_bs
    free = count - len(np.unique(np.concatenate([bc.dof_indices()[0] for bc in held])))
    if problem.watched:
        return free, displacement_at(state, space, problem.watched) / problem.traction, seconds
    work = dolfinx.fem.assemble_scalar(dolfinx.fem.form(load * u[1] * end))
    return free, work / problem.traction**2, seconds


def held_dofs(space, mesh, where, axis=None):
    """Returns zero displacements, of one component or all, where the condition holds."""
    import dolfinx

    part = space.sub(0) if axis is None else space.sub(0).sub(axis)
    alone, _ = part.collapse()
    dofs = dolfinx.fem.locate_dofs_geometrical((part, alone), where)
    return dolfinx.fem.dirichletbc(dolfinx.fem.Function(alone), dofs, part)


def displacement_at(state, space, place):
    import dolfinx

    part = space.sub(0).sub(1)
    alone, _ = part.collapse()
    dofs = dolfinx.fem.locate_dofs_geometrical((part, alone), lambda x: np.linalg.norm(x.T - place, axis=1) < 1e-6)
    return state.x.array[dofs[0][0]]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("problems", nargs="*", help=" ".join(PROBLEMS))
    parser.add_argument("--aspic", default="build/release/bin/aspic", help="Program")
    parser.add_argument("--cells", type=int, nargs="+", help="Cells per unit of length or along an edge; even for cook")
    parser.add_argument("--csv", help="Write the table to this file")
    options = parser.parse_args()
    logging.disable(logging.WARNING)  # the compiler's commands
    rows = [["problem", "program", "cells", "dofs", "error", "cpu_s"]]
    show = lambda row: print("  ".join(f"{word!s:>9}" for word in row), flush=True)
    show(rows[0])
    for name in options.problems or PROBLEMS:
        problem = PROBLEMS[name]
        for n in options.cells or ((4, 8, 16) if problem.is_plane else (2, 4, 8)):
            mesh = problem.mesh(n)
            for program, result in (("aspic", aspic(options.aspic, problem, mesh)), ("dolfinx", taylor_hood(problem, mesh))):
                dofs, compliance, seconds = result
                rows.append([name, program, n, dofs, f"{compliance / problem.limit - 1:.4f}", f"{seconds:.2f}"])
                show(rows[-1])
    if options.csv:
        with open(options.csv, "w", newline="") as file:
            csv.writer(file).writerows(rows)


if __name__ == "__main__":
    main()
