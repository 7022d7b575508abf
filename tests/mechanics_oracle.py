#!/usr/bin/python3
"""Compares the fields of output.mechanics with their definitions in numpy, on frames that meshio reads.

Usage: mechanics_oracle.py ASPIC
"""
import csv
import pathlib
import subprocess
import sys
import tempfile

import meshio
import numpy as np

SCENE = """gravity = [0, 0, 0]
time = {{ step = 1, duration = 1, integrator = "quasi_static" }}
output = {{ mechanics = true, precision = "double", report = false }}
solver = {{ tolerance = 1e-10 }}
[[body]]
name = "bar"
order = {order}
shape = {{ box = {{ upper = [2, 1, 1], cells = [3, 2, 2] }} }}
material = {{ model = "neo_hookean_log", young = 1e5, poisson = 0.3 }}
[[body.pin]]
name = "wall"
where = "X < 0.001"
[[body.pin]]
name = "grip"
where = "X > 1.999"
motion = {{ displacement = ["0.4*t", "0.2*t", "0.1*t*Y"] }}
"""


def matrices(six):
    xx, yy, zz, xy, yz, zx = six.T
    return np.stack([xx, xy, zx, xy, yy, yz, zx, yz, zz], axis=1).reshape(-1, 3, 3)


def monomials(X):
    """The polynomials of degree two, and their gradients."""
    x, y, z = X
    one = [1, x, y, z, x * x, y * y, z * z, x * y, y * z, z * x]
    by_x = [0, 1, 0, 0, 2 * x, 0, 0, y, 0, z]
    by_y = [0, 0, 1, 0, 0, 2 * y, 0, x, z, 0]
    by_z = [0, 0, 0, 1, 0, 0, 2 * z, 0, y, x]
    return np.array(one), np.array([by_x, by_y, by_z])


def gradient(X, x):
    """dx/dX at the centroid of the polynomial through the nodes of a tet."""
    count = len(X)
    terms = 4 if count == 4 else 10
    coefficients = np.linalg.solve(np.array([monomials(p)[0][:terms] for p in X]), x)
    return coefficients.T @ monomials(X[:4].mean(axis=0))[1][:, :terms].T


def check(order, folder, aspic):
    scene, out = folder / "bar.toml", folder / f"out{order}"
    scene.write_text(SCENE.format(order=order))
    subprocess.run([aspic, "run", scene, "--out", out, "--quiet"], check=True)
    mesh = meshio.read(sorted((out / "frames").glob("*.vtu"))[-1])
    cells = mesh.cells_dict["tetra" if order == 1 else "tetra10"]
    field = {name: values[0] for name, values in mesh.cell_data.items()}
    rest = mesh.points - mesh.point_data["displacement"]
    F = np.array([gradient(rest[tet], mesh.points[tet]) for tet in cells])
    np.testing.assert_allclose(field["F"].reshape(-1, 3, 3), F, atol=1e-10)
    assert np.abs(F - np.eye(3)).max() > 0.1
    strain = (np.transpose(F, (0, 2, 1)) @ F - np.eye(3)) / 2
    np.testing.assert_allclose(matrices(field["strain"]), strain, atol=1e-10)
    sigma = matrices(field["cauchy"])
    np.testing.assert_allclose(field["principal_stress"], np.linalg.eigvalsh(sigma)[:, ::-1], rtol=1e-9, atol=1e-5)

    reaction = mesh.point_data["reaction"]
    row = list(csv.DictReader(open(out / "steps.csv")))[-1]
    for pin, held in (("wall", rest[:, 0] < 1e-6), ("grip", rest[:, 0] > 2 - 1e-6)):
        total = [float(row[f"reaction_bar.{pin}_{axis}"]) for axis in "xyz"]
        np.testing.assert_allclose(reaction[held].sum(axis=0), total, rtol=1e-9, atol=1e-6)
        assert abs(total[0]) > 1e3
    free = (rest[:, 0] > 1e-6) & (rest[:, 0] < 2 - 1e-6)
    assert np.all(reaction[free] == 0)
    if order == 2:
        return
    force = np.zeros_like(reaction)  # of the stresses: volume P grad N, P = det F sigma F^-T
    for tet, F_t, sigma_t in zip(cells, F, sigma):
        edges = (rest[tet[1:]] - rest[tet[0]]).T
        P = np.linalg.det(F_t) * sigma_t @ np.linalg.inv(F_t).T
        part = np.abs(np.linalg.det(edges)) / 6 * P @ np.linalg.inv(edges).T
        force[tet[1:]] += part.T
        force[tet[0]] -= part.sum(axis=1)
    np.testing.assert_allclose(reaction, np.where(free[:, None], 0, force), atol=1e-5)


def main():
    with tempfile.TemporaryDirectory() as folder:
        for order in (1, 2):
            check(order, pathlib.Path(folder), sys.argv[1])
            print(f"ok    order {order}")


main()
