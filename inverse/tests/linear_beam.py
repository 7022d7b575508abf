"""Small vibrations of an elastic box held at x = 0, by linear tets and backward Euler in plain Python: independent of
Aspic. Consistent mass, damping proportional to it."""
import itertools


def det3(a):
    return (a[0][0] * (a[1][1] * a[2][2] - a[1][2] * a[2][1]) - a[0][1] * (a[1][0] * a[2][2] - a[1][2] * a[2][0])
            + a[0][2] * (a[1][0] * a[2][1] - a[1][1] * a[2][0]))


def kuhn(size, cells):
    """Vertices, and six tets per cell around its diagonal."""
    n = [c + 1 for c in cells]
    index = lambda c: (c[0] * n[1] + c[1]) * n[2] + c[2]
    grid = itertools.product(*(range(m) for m in n))
    vertices = [tuple(s * i / c for s, i, c in zip(size, place, cells)) for place in grid]
    tets = []
    for cell in itertools.product(*(range(c) for c in cells)):
        for path in itertools.permutations(range(3)):
            corner, tet = list(cell), [index(cell)]
            for axis in path:
                corner[axis] += 1
                tet.append(index(corner))
            sides = [[vertices[v][i] - vertices[tet[0]][i] for i in range(3)] for v in tet[1:]]
            tets.append(tet if det3(sides) > 0 else [tet[0], tet[2], tet[1], tet[3]])
    return vertices, tets


def gradients(points):
    """Gradients of the four shape functions, and the volume."""
    e = [[points[k][i] - points[0][i] for i in range(3)] for k in (1, 2, 3)]
    d = det3(e)
    cross = lambda a, b: [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
    g = [[c / d for c in cross(e[1], e[2])], [c / d for c in cross(e[2], e[0])], [c / d for c in cross(e[0], e[1])]]
    return [[-sum(row[i] for row in g) for i in range(3)]] + g, d / 6


def solve(A, b):
    """Gaussian elimination with a matrix of right-hand sides."""
    n, rows = len(A), [list(a) + list(r) for a, r in zip(A, b)]
    for k in range(n):  # symmetric and positive definite: no pivoting
        for i in range(k + 1, n):
            f = rows[i][k] / rows[k][k]
            if f:
                rows[i] = [x - f * y for x, y in zip(rows[i], rows[k])]
    for k in reversed(range(n)):
        rows[k] = [x / rows[k][k] for x in rows[k]]
        for i in range(k):
            f = rows[i][k]
            if f:
                rows[i] = [x - f * y for x, y in zip(rows[i], rows[k])]
    return [row[n:] for row in rows]


def swing(size, cells, material, gravity, step, steps):
    """Vertices, and their positions at each time. `material`: young, poisson, density, damping [1/s]."""
    vertices, tets = kuhn(size, cells)
    young, nu, density, damping = material
    mu, la = young / (2 + 2 * nu), young * nu / ((1 + nu) * (1 - 2 * nu))
    n = 3 * len(vertices)
    K, M, weight = [[0.0] * n for _ in range(n)], [[0.0] * n for _ in range(n)], [0.0] * n
    for tet in tets:
        g, volume = gradients([vertices[v] for v in tet])
        for a, b in itertools.product(range(4), range(4)):
            inner = sum(g[a][r] * g[b][r] for r in range(3))
            for i, j in itertools.product(range(3), range(3)):
                k = la * g[a][i] * g[b][j] + mu * g[a][j] * g[b][i] + (mu * inner if i == j else 0)
                K[3 * tet[a] + i][3 * tet[b] + j] += volume * k
            for i in range(3):
                M[3 * tet[a] + i][3 * tet[b] + i] += density * volume / 20 * (2 if a == b else 1)
        for a, i in itertools.product(range(4), range(3)):
            weight[3 * tet[a] + i] += density * volume / 4 * gravity[i]
    free = [3 * v + i for v, x in enumerate(vertices) if x[0] > 1e-9 for i in range(3)]
    A = [[(1 + step * damping) * M[i][j] + step ** 2 * K[i][j] for j in free] for i in free]
    inverse = solve(A, [[float(i == j) for j in range(len(free))] for i in range(len(free))])
    u, v, frames = [0.0] * len(free), [0.0] * len(free), []
    for _ in range(steps + 1):
        x = [list(p) for p in vertices]
        for k, dof in enumerate(free):
            x[dof // 3][dof % 3] += u[k]
        frames.append([tuple(p) for p in x])
        b = [sum(M[i][j] * vj for j, vj in zip(free, v)) + step * (weight[i] - sum(K[i][j] * uj for j, uj in zip(free, u)))
             for i in free]
        v = [sum(a * c for a, c in zip(row, b)) for row in inverse]
        u = [a + step * c for a, c in zip(u, v)]
    return vertices, frames
