"""Equilibria of soft solids by quadratic tets in NumPy and SciPy, independent of Aspic: its own meshes, elements and law.

Energy density: mu/2 (x + b x^2) + k1/(2 k2) (exp(k2 s^2) - 1) + K/4 (j^2 - 1 - 2 log j), x = J^(-2/3) I1 - 3, where j is the mean of J over a tet
(mean dilatation). mu and K are those of E and nu at small strains. s is the strain |F a|^2 - 1 of fibres along a, smoothly
0 in compression. The mesh is a graded box of cells that are cut into
twelve tets around their center; interior vertices are jittered. Lengths in m, forces in N, stresses in Pa.
"""
import dataclasses
import itertools

import numpy as np
import scipy.sparse as sparse
import scipy.sparse.linalg as splinalg

ROUND_OFF = 1e-5  # relative residual that is accepted where the energy does not fall any more
UP = np.array([0.0, 0.0, 1.0])
BLOCK = 256  # tets that are evaluated at once, whose arrays fit into a cache
EDGES = np.array([(0, 1), (1, 2), (0, 2), (0, 3), (1, 3), (2, 3)])
A, B = (5 + 3 * 5 ** 0.5) / 20, (5 - 5 ** 0.5) / 20
POINTS = B + (A - B) * np.eye(4)  # barycentric coordinates, weight 1/4 each; exact for polynomials of degree 2
# Points of a triangle with weights that sum to 1; exact for polynomials of degree 4 [Dunavant 1985].
P, Q = 0.445948490915965, 0.091576213509771
FACE_POINTS = np.array([p for a in (P, Q) for p in ((a, a, 1 - 2 * a), (a, 1 - 2 * a, a), (1 - 2 * a, a, a))])
FACE_WEIGHTS = np.repeat([0.223381589678011, 0.109951743655322], 3)


def shapes(l):
    """Quadratic shape functions of tets (4 coordinates, 10 nodes) or triangles (3 coordinates, 6 nodes)."""
    l = np.asarray(l)
    edges = EDGES[:3] if l.shape[-1] == 3 else EDGES
    return np.concatenate([l * (2 * l - 1), 4 * l[..., edges[:, 0]] * l[..., edges[:, 1]]], axis=-1)


def shape_slopes(l):
    """dN/dl of a tet: 10 x 4."""
    slopes = np.zeros((10, 4))
    slopes[np.arange(4), np.arange(4)] = 4 * l - 1
    for k, (i, j) in enumerate(EDGES):
        slopes[4 + k, i], slopes[4 + k, j] = 4 * l[j], 4 * l[i]
    return slopes


@dataclasses.dataclass
class Mesh:
    X: np.ndarray      # nodes: corners, then middles of edges
    tets: np.ndarray   # 10 nodes each
    faces: np.ndarray  # 6 nodes of each boundary triangle, outward

    def linear(self):
        """Values at all nodes of fields that are linear in each tet, from those at the corners."""
        corners = self.tets[:, :4].max() + 1
        middles = np.unique(np.concatenate([self.tets[:, 4:].reshape(-1, 1), self.tets[:, EDGES].reshape(-1, 2)], 1), axis=0)
        rows = np.concatenate([np.arange(corners), middles[:, 0], middles[:, 0]])
        columns = np.concatenate([np.arange(corners), middles[:, 1], middles[:, 2]])
        values = np.concatenate([np.ones(corners), np.full(2 * len(middles), 0.5)])
        return sparse.csr_matrix((values, (rows, columns)), (len(self.X), corners))


def box(xs, ys, zs, jitter=0.2, seed=0):
    """Quadratic mesh of a box with the given grid planes. Planes are kept: jitter moves vertices inside cells' layers
    only along them, and cell centers in all directions."""
    random = np.random.default_rng(seed)
    n = [len(v) for v in (xs, ys, zs)]
    grid = np.stack(np.meshgrid(xs, ys, zs, indexing="ij"), -1)
    widths = [np.min(np.diff(v)) for v in (xs, ys, zs)]
    for axis in (0, 1):
        inside = tuple(slice(1, -1) for _ in range(3))
        grid[inside][..., axis] += jitter * widths[axis] * random.uniform(-0.5, 0.5, grid[inside].shape[:3])
    index = np.arange(np.prod(n)).reshape(n)
    steps = np.array(list(itertools.product(range(2), repeat=3)))
    base = np.stack(np.meshgrid(*(np.arange(m - 1) for m in n), indexing="ij"), -1).reshape(-1, 1, 3)
    cells = np.ravel_multi_index(tuple(np.moveaxis(base + steps, -1, 0)), n)
    moves = jitter * random.uniform(-0.3, 0.3, (len(cells), 3)) * widths
    return cut_cells(grid.reshape(-1, 3), cells, np.indices(n).sum(0).ravel() % 2, moves)


def cut_cells(X, cells, parity, moves=0):
    """Quadratic mesh of hexahedra, each cut into 12 tets around its center, which is moved by `moves`. Corner 4 a + 2 b + c
    of a cell is that at (a, b, c) of a unit cube. Vertices of an edge differ in `parity`, 0 or 1: the diagonal of a
    side joins those of parity 0."""
    centers, tets = len(X) + np.arange(len(cells)), []
    for axis, side in itertools.product(range(3), (0, 1)):
        a, b = (4 >> m for m in range(3) if m != axis)
        ring = cells[:, (4 >> axis) * side + np.array([0, a, a + b, b])]
        turn = parity[ring[:, :1]]
        ring = np.take_along_axis(ring, (np.arange(4) + turn) % 4, 1)
        tets += [np.column_stack([ring[:, [0, 1, 2]], centers]), np.column_stack([ring[:, [0, 2, 3]], centers])]
    return quadratic(np.concatenate([X, X[cells].mean(1) + moves]), np.stack(tets, 1).reshape(-1, 4))


def quadratic(X, tets):
    sides = X[tets[:, 1:]] - X[tets[:, :1]]
    flipped = np.linalg.det(sides) < 0
    tets[flipped] = tets[flipped][:, [0, 1, 3, 2]]
    pairs, inverse = np.unique(np.sort(tets[:, EDGES].reshape(-1, 2), 1), axis=0, return_inverse=True)
    all_tets = np.concatenate([tets, len(X) + inverse.reshape(-1, 6)], 1)
    nodes = np.concatenate([X, X[pairs].mean(1)])
    # A face in only one tet is on the boundary. Local edges: EDGES of the nodes in their order.
    local = np.array([(0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2)])
    faces = tets[:, local].reshape(-1, 3)
    _, first, counts = np.unique(np.sort(faces, 1), axis=0, return_index=True, return_counts=True)
    faces = faces[first[counts == 1]]
    keys = {tuple(p): len(X) + m for m, p in enumerate(pairs)}
    middles = [[keys[tuple(sorted((f[a], f[b])))] for a, b in EDGES[:3]] for f in faces]
    return Mesh(nodes, all_tets, np.concatenate([faces, np.array(middles).reshape(-1, 3)], 1))


@dataclasses.dataclass
class Indenter:
    """Rigid, frictionless, pressing down: all points within `rounding` of an upward cylinder of radius `flat` whose end
    is at `center`. A sphere: flat = 0. `stiffness` of the penalty in Pa/m; its pressure is quadratic in depths below
    `softening` and linear beyond."""
    center: np.ndarray
    flat: float
    rounding: float
    stiffness: float
    softening: float = 0
    is_curved: bool = True  # the matrix includes curvature()

    def depth(self, x):
        """Depth of points inside, and its gradient."""
        u = x - self.center
        radial = np.hypot(u[:, 0], u[:, 1])
        outside = np.maximum(0, 1 - self.flat / np.maximum(radial, 1e-300))
        away = np.stack([u[:, 0] * outside, u[:, 1] * outside, np.minimum(u[:, 2], 0)], 1)
        distance = np.linalg.norm(away, axis=1)
        is_above = (outside == 0) & (u[:, 2] > 0)  # inside the cylinder: pushed down
        n = np.where(is_above[:, None], [0.0, 0.0, 1.0], -away / np.maximum(distance, 1e-300)[:, None])
        return self.rounding + np.where(is_above, u[:, 2], -distance), n

    def curvature(self, x):
        """Second derivatives of depth(x), or zeros to leave them out of matrices."""
        return np.zeros((len(x), 3, 3))

    def response(self, d):
        """Energy per stiffness of depths, and its first two derivatives."""
        e = self.softening
        soft = d < e
        with np.errstate(divide="ignore", invalid="ignore"):
            return (np.where(soft, d ** 3 / (6 * e), d * (d - e) / 2 + e ** 2 / 6),
                    np.where(soft, d ** 2 / (2 * e), d - e / 2), np.where(soft, d / e, 1.0))


@dataclasses.dataclass
class Disc(Indenter):
    """Indenter with a flat end at `center` and the radius flat + rounding. Its profile is z = w h((r - flat - z) / w - 1)
    with the width w = `rounding`: h(t) is 0 below -1, t above 1, and has the second derivative 3/4 (1 - t^2) in between."""

    def polar(self, x):
        """Heights above the flat end, distances from the axis and directions away from it, and t."""
        u = x - self.center
        radial = np.hypot(u[:, 0], u[:, 1])
        e = np.column_stack([u[:, :2] / np.maximum(radial, 1e-300)[:, None], 0 * radial])
        return u[:, 2], radial, e, (radial - self.flat + u[:, 2]) / self.rounding - 1

    def depth(self, x):
        z, _, e, t = self.polar(x)
        near = np.clip(t, -1, 1)
        h = 3 / 16 + near / 2 + 3 / 8 * near ** 2 - near ** 4 / 16 + np.maximum(t - 1, 0)
        slope = self.slope(near)[:, None]
        return z - self.rounding * h, (1 - slope) * UP - slope * e

    @staticmethod
    def slope(t):
        return (2 + 3 * t - t ** 3) / 4

    def curvature(self, x):
        _, radial, e, t = self.polar(x)
        near, across = np.clip(t, -1, 1), e + UP
        around = np.diag([1, 1, 0]) - e[:, :, None] * e[:, None]
        return (-(0.75 * (1 - near ** 2) / self.rounding)[:, None, None] * across[:, :, None] * across[:, None]
                - (self.slope(near) / np.maximum(radial, 1e-300))[:, None, None] * around)


@dataclasses.dataclass
class Sliders:
    """Points in contact with lagged forces mu N, normals, and positions at the end of a step if they stick. The energy
    is that of a slip y: force * (sqrt(y^2 + width^2) - width)."""
    face: np.ndarray
    point: np.ndarray
    force: np.ndarray
    normal: np.ndarray
    stuck: np.ndarray
    width: float


@dataclasses.dataclass
class Fibres:
    direction: object      # of points
    ratio: float           # k1 / mu
    exponent: float = 1.0  # k2

    def response(self, strain):
        """Energy per k1, and its first two derivatives with respect to the strain."""
        e = 0.01
        t = np.clip(strain / e, 0, 1)
        taut = np.maximum(strain - e, 0)
        s = e * (t ** 3 - t ** 4 / 2) + taut
        ds, dds = 3 * t ** 2 - 2 * t ** 3, (6 * t - 6 * t ** 2) / e
        k = self.exponent
        growth = np.exp(k * s ** 2)
        return (growth - 1) / (2 * k), growth * s * ds, growth * ((1 + 2 * k * s ** 2) * ds ** 2 + s * dds)


def point_matrices(K, N, dofs, size):
    """Sum of matrices K, 3 x 3, of points of faces with the shape functions N."""
    blocks = (N[:, :, None, None, None] * N[:, None, :, None, None] * K[:, None, None]).transpose(0, 1, 3, 2, 4)
    rows, columns = np.repeat(dofs, 18, 1), np.tile(dofs, (1, 18))
    return sparse.csr_matrix((blocks.ravel(), (rows.ravel(), columns.ravel())), (size, size))


class Assembly:
    """Sums matrices of tets, 30 x 30 each, to one of all nodes."""

    def __init__(self, mesh):
        self.count = count = len(mesh.X)
        keys, place = np.unique((mesh.tets[:, :, None] * count + mesh.tets[:, None]).ravel(), return_inverse=True)
        self.columns, self.starts = keys % count, np.searchsorted(keys, count * np.arange(count + 1))
        self.sums = sparse.csr_matrix((np.ones(len(place)), (place, np.arange(len(place)))))

    def __call__(self, K):
        blocks = K.reshape(-1, 10, 3, 10, 3).transpose(0, 1, 3, 2, 4).reshape(-1, 9)
        return sparse.bsr_matrix(((self.sums @ blocks).reshape(-1, 3, 3), self.columns, self.starts),
                                 (3 * self.count, 3 * self.count)).tocsr()


class Solid:
    """young(points), poisson: at small strains. `b`: stiffening. `weight`: force per volume [N/m^3]."""

    def __init__(self, mesh, young, poisson, b=0.3, weight=(0, 0, 0), fibres=None):
        self.mesh, self.b, self.fibres = mesh, b, fibres
        corners = mesh.X[mesh.tets[:, :4]]
        sides = corners[:, 1:] - corners[:, :1]
        self.volume = np.linalg.det(sides) / 6
        assert self.volume.min() > 0
        inverse = np.linalg.inv(sides)  # grad l_i for i > 0: its columns
        barycentric = np.concatenate([-inverse.sum(2, keepdims=True), inverse], 2).transpose(0, 2, 1)
        self.G = np.array([shape_slopes(l) @ barycentric for l in POINTS])  # points, tets, nodes, xyz
        E = np.array([young(l @ corners) * np.ones(len(corners)) for l in POINTS])
        self.mu, self.K = E / (2 + 2 * poisson), E.mean(0) / (3 - 6 * poisson)
        if fibres:
            self.axes = np.array([np.broadcast_to(fibres.direction(l @ corners), (len(corners), 3)) for l in POINTS])
        self.indenter = self.sliders = None
        self.dofs = dofs = (3 * mesh.tets[:, :, None] + np.arange(3)).reshape(-1, 30)
        self.assembly = Assembly(mesh)
        X = mesh.X[mesh.faces[:, :3]]
        self.face_area = np.linalg.norm(np.cross(X[:, 1] - X[:, 0], X[:, 2] - X[:, 0]), axis=1) / 2
        self.face_shapes = shapes(FACE_POINTS)
        per_node = np.array([shapes(l) for l in POINTS]).sum(0) / 4
        load = self.volume[:, None, None] * per_node[:, None] * np.asarray(weight, float)
        self.load = np.bincount(dofs.ravel(), load.ravel(), mesh.X.size)

    def evaluate(self, x, wants_matrix=False):
        """Energy without contact, gradient and matrix; infinite energy if a tet is inverted."""
        energy, g = -self.load @ x, np.zeros((len(self.volume), 10, 3))
        K = np.zeros((len(g), 30, 30)) if wants_matrix else None
        for first in range(0, len(g), BLOCK):
            some = slice(first, first + BLOCK)
            more = self.evaluate_some(x.reshape(-1, 3)[self.mesh.tets[some]], some, g[some], K[some] if wants_matrix else None)
            if not np.isfinite(more):
                return np.inf, None, None
            energy += more
        gradient = np.bincount(self.dofs.ravel(), g.ravel(), x.size) - self.load
        return energy, gradient, self.assembly(K) if wants_matrix else None

    def evaluate_some(self, xe, some, g, K):
        """Returns the energy of the tets `some`, and adds their gradients to g and their matrices to K, if any."""
        V = self.volume[some]
        Fs = [xe.transpose(0, 2, 1) @ G[some] for G in self.G]
        Js = np.array([np.linalg.det(F) for F in Fs])
        if Js.min() <= 0:
            return np.inf
        j, bulk = Js.mean(0), self.K[some] / 2
        energy = (V * bulk / 2 * (j ** 2 - 1 - 2 * np.log(j))).sum()
        pressure = bulk * (j - 1 / j)
        dj = np.zeros((len(V), 10, 3))
        for q, (F, J) in enumerate(zip(Fs, Js)):
            G, mu = self.G[q][some], self.mu[q][some]
            H, I1, a = np.linalg.inv(F).transpose(0, 2, 1), (F ** 2).sum((1, 2)), J ** (-2 / 3)
            X, slope = a * I1 - 3, mu / 2 * (1 + 2 * self.b * (a * I1 - 3))
            energy += (V / 4 * mu / 2 * (X + self.b * X ** 2)).sum()
            s = lambda v: v[:, None, None]
            dX = s(a) * (2 * F - s(2 / 3 * I1) * H)
            P = s(slope) * dX + s(pressure * J) * H
            if self.fibres:
                fibre = self.axes[q][some]
                Fa = np.einsum("eij,ej->ei", F, fibre)
                f, df, ddf = (self.fibres.ratio * mu * v for v in self.fibres.response((Fa ** 2).sum(1) - 1))
                energy += (V / 4 * f).sum()
                dE = 2 * Fa[:, :, None] * fibre[:, None]
                P = P + s(df) * dE
            g += s(V / 4) * (G @ P.transpose(0, 2, 1))
            dj += (G @ (s(J) * H).transpose(0, 2, 1)) / 4
            if K is not None:
                D = lambda p, q: p.reshape(-1, 9, 1) * q.reshape(-1, 1, 9)
                # The derivative of H = F^-T: dH_ij = -H_il dF_kl H_kj.
                crossed = (H[:, :, None, None, :] * H.transpose(0, 2, 1)[:, None, :, :, None]).reshape(-1, 9, 9)
                tangent = s(slope * a) * (2 * np.eye(9) - 4 / 3 * (D(F, H) + D(H, F)) + s(4 / 9 * I1) * D(H, H)
                                          + s(2 / 3 * I1) * crossed)
                tangent += s(mu * self.b) * D(dX, dX) + s(pressure * J) * (D(H, H) - crossed)
                if self.fibres:
                    aa = fibre[:, None, :, None, None] * fibre[:, None, None, None, :] * np.eye(3)[None, :, None, :, None]
                    tangent += s(2 * df) * aa.reshape(-1, 9, 9) + s(ddf) * D(dE, dE)
                strain = np.zeros((len(V), 3, 3, 10, 3))  # dF / du
                for i in range(3):
                    strain[:, i, :, :, i] = G.transpose(0, 2, 1)
                strain = strain.reshape(-1, 9, 30)
                K += strain.transpose(0, 2, 1) @ ((s(V / 4) * tangent) @ strain)
        if K is not None:
            flat = dj.reshape(-1, 30)
            K += (V * bulk * (1 + j ** -2))[:, None, None] * flat[:, :, None] * flat[:, None]
        return energy

    def contact(self, x, wants_matrix=False):
        """Energy, gradient and matrix of the indenter, and its force on the body."""
        faces, N = self.mesh.faces, self.face_shapes
        points = np.einsum("qa,far->fqr", N, x.reshape(-1, 3)[faces]).reshape(-1, 3)
        depth, n = self.indenter.depth(points)
        weight = (self.face_area[:, None] * FACE_WEIGHTS).ravel() * self.indenter.stiffness
        pushed = np.flatnonzero(depth > 0)
        depth, n, weight, face, point = depth[pushed], n[pushed], weight[pushed], pushed // len(N), pushed % len(N)
        value, slope, curvature = self.indenter.response(depth)
        pull = (weight * slope)[:, None] * n
        dofs = (3 * faces[face][:, :, None] + np.arange(3)).reshape(-1, 18)
        rows = (N[point][:, :, None] * n[:, None]).reshape(-1, 18)  # d depth / d nodes
        gradient = np.bincount(dofs.ravel(), ((weight * slope)[:, None] * rows).ravel(), x.size)
        matrix = None
        if wants_matrix:
            K = curvature[:, None, None] * n[:, :, None] * n[:, None]
            if self.indenter.is_curved:
                K += slope[:, None, None] * self.indenter.curvature(points[pushed])
            matrix = point_matrices(weight[:, None, None] * K, N[point], dofs, x.size)
        return (weight * value).sum(), gradient, matrix, -pull.sum(0)

    def friction(self, x, wants_matrix=False):
        s, size = self.sliders, x.size
        N, nodes = self.face_shapes[s.point], self.mesh.faces[s.face]
        u = np.einsum("fa,far->fr", N, x.reshape(-1, 3)[nodes]) - s.stuck
        u -= (u * s.normal).sum(1, keepdims=True) * s.normal
        root = np.sqrt((u ** 2).sum(1) + s.width ** 2)
        dofs = (3 * nodes[:, :, None] + np.arange(3)).reshape(-1, 18)
        pull = (s.force / root)[:, None] * u
        gradient = np.bincount(dofs.ravel(), (N[:, :, None] * pull[:, None]).ravel(), size)
        matrix = None
        if wants_matrix:
            T = np.eye(3) - s.normal[:, :, None] * s.normal[:, None]
            K = (s.force / root)[:, None, None] * (T - u[:, :, None] * u[:, None] / root[:, None, None] ** 2)
            matrix = point_matrices(K, N, dofs, size)
        return (s.force * (root - s.width)).sum(), gradient, matrix, -pull.sum(0)

    def slide(self, x, held, path, mu, width):
        """Moves the indenter with friction along the path of its center, step by step. Returns x and its force."""
        faces, N = self.mesh.faces, self.face_shapes
        points = lambda x: np.einsum("qa,far->fqr", N, x.reshape(-1, 3)[faces]).reshape(-1, 3)
        weight = (self.face_area[:, None] * FACE_WEIGHTS).ravel() * self.indenter.stiffness
        for center in path:
            stuck = points(x) + center - self.indenter.center
            self.indenter.center, self.sliders = center, None
            x = self.solve(x, held)  # for the first normal forces
            for lag in range(50):
                depth, normal = self.indenter.depth(points(x))
                at = np.flatnonzero(depth > 0)
                force = mu * weight[at] * self.indenter.response(depth[at])[1]
                self.sliders = Sliders(at // len(N), at % len(N), force, normal[at], stuck[at], width)
                before, x = x, self.solve(x, held, 200)
                if np.abs(x - before).max() < 0.01 * width:
                    break
            else:
                raise RuntimeError("the normal forces do not settle")
        return x, self.contact(x)[3] + self.friction(x)[3]

    def total(self, x, wants_matrix=False):
        energy, gradient, matrix = self.evaluate(x, wants_matrix)
        if self.indenter is not None and np.isfinite(energy):
            more, slope, block, _ = self.contact(x, wants_matrix)
            energy, gradient = energy + more, gradient + slope
            matrix = matrix + block if wants_matrix else None
            if self.sliders is not None:
                more, slope, block, _ = self.friction(x, wants_matrix)
                energy, gradient = energy + more, gradient + slope
                matrix = matrix + block if wants_matrix else None
        return energy, gradient, matrix

    def solve(self, x, held, iterations=60, tolerance=1e-7):
        """Minimizes from x, whose entries `held` (a mask of degrees of freedom) stay. Returns the positions."""
        x, free = x.copy(), np.flatnonzero(~held)
        coarse = sparse.kron(self.mesh.linear(), sparse.eye(3)).tocsr()[free]
        coarse = coarse[:, np.flatnonzero(~held[:coarse.shape[1]])]  # vertices come first
        for _ in range(iterations):
            energy, gradient, matrix = self.total(x, True)
            size = np.abs(gradient[free]).max()
            balanced = np.abs(gradient).max()  # includes reactions
            if size <= tolerance * balanced:
                return x
            K = matrix[free][:, free]
            step = conjugate_gradients(K, -gradient[free], TwoLevel(K, coarse, free // 3), 1e-4)
            length, slope = 1.0, step @ gradient[free]
            while True:
                trial = x.copy()
                trial[free] += length * step
                value, rest, _ = self.total(trial)
                # Close to the minimum, differences of energies are round-off.
                if value <= energy + 1e-4 * length * slope or (
                        np.isfinite(value) and np.abs(rest[free]).max() < 0.5 * size):
                    break
                length /= 2
                if length < 1e-6:
                    if size <= ROUND_OFF * balanced:
                        return x
                    raise RuntimeError(f"no descent; residual {size:.3g} of {balanced:.3g} N")
            x = trial
        raise RuntimeError(f"no equilibrium; residual {size:.3g} of {balanced:.3g} N")


class TwoLevel:
    """Preconditioner: an exact solve for the displacements of linear tets, plus those of each node by itself."""

    def __init__(self, K, coarse, nodes):
        self.coarse = coarse
        self.factor = splinalg.splu((coarse.T @ K @ coarse).tocsc(), permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0,
                                    options={"SymmetricMode": True})
        K = K.tocoo()
        same = nodes[K.row] == nodes[K.col]
        block = sparse.csr_matrix((K.data[same], (K.row[same], K.col[same])), K.shape).tocsc()
        self.blocks = splinalg.splu(block, permc_spec="NATURAL", diag_pivot_thresh=0, options={"SymmetricMode": True})

    def __call__(self, r):
        return self.coarse @ self.factor.solve(self.coarse.T @ r) + self.blocks.solve(r)


def conjugate_gradients(K, b, precondition, tolerance, iterations=2000):
    x, r = np.zeros_like(b), b.copy()
    z = precondition(r)
    p, rz, first = z.copy(), r @ z, np.linalg.norm(b)
    for _ in range(iterations):
        Kp = K @ p
        curvature = p @ Kp
        if curvature <= 0:  # an indefinite matrix: the last descent direction
            return x if x.any() else z
        x += rz / curvature * p
        r -= rz / curvature * Kp
        if np.linalg.norm(r) <= tolerance * first:
            break
        z = precondition(r)
        p, rz = z + (r @ z) / rz * p, r @ z
    return x


class Interpolation:
    """Values of nodal fields at fixed points of the body at rest."""

    def __init__(self, mesh, points):
        corners = mesh.X[mesh.tets[:, :4]]
        inverse = np.linalg.inv(corners[:, 1:] - corners[:, :1])
        self.nodes, self.weights = [], []
        for p in points:
            l = np.einsum("er,erk->ek", p - corners[:, 0], inverse)
            l = np.concatenate([1 - l.sum(1, keepdims=True), l], 1)
            best = l.min(1).argmax()
            assert l[best].min() > -1e-6, p
            self.nodes.append(mesh.tets[best])
            self.weights.append(shapes(l[best]))

    def __call__(self, x):
        return np.einsum("pa,par->pr", np.array(self.weights), x.reshape(-1, 3)[np.array(self.nodes)])


def rotation(vector):
    """Matrix of a rotation vector [Rodrigues]."""
    angle = np.linalg.norm(vector)
    if angle == 0:
        return np.eye(3)
    a = np.asarray(vector) / angle
    cross = np.array([[0, -a[2], a[1]], [a[2], 0, -a[0]], [-a[1], a[0], 0]])
    return np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross
