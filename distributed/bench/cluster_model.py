#!/usr/bin/env python3
"""Predicts the weak scaling of one linear iteration of aspic-mpi: CG with smoothed aggregation (V-cycle).

usage: cluster_model.py [--vertices-per-rank N] [--ranks-per-node R] [NODES...]

Prints a Markdown table. A model of bytes, messages and latencies; imbalance and set-up are left out.
"""
import argparse
import math

# Assumed machine, per node except for the latencies.
MEMORY, NETWORK, LATENCY, REDUCTION = 400e9, 25e9, 2e-6, 2.5e-6  # [B/s], [B/s], [s] per message, [s] per doubling
INSIDE = 5e9  # between ranks of a node [B/s]
FLOPS = 2e9  # of the triangular solves of the coarsest level [1/s]
# Measured on meshes of tets: vertices of the first aggregates and of later ones, couplings per row, neighbors.
FIRST_AGGREGATE, LATER_AGGREGATE = 30, 9
FINE_COUPLINGS, COARSE_COUPLINGS, FINE_NEIGHBORS, COARSE_NEIGHBORS = 15, 40, 14, 26
EXCHANGES = 6  # per level: Chebyshev(2) before and after, the residual, and the product of CG


def ghosts(vertices):
    """Ghosts of a rank with this many vertices of a cube, in Hilbert order."""
    return min(4.6 * vertices ** (2 / 3) + 8, 3 * vertices + 26)


def levels(vertices):
    """Returns (vertices or aggregates, dofs of each) from fine to coarse."""
    result, count = [(vertices, 3)], vertices / FIRST_AGGREGATE
    while count * 6 > 300:
        result.append((count, 6))
        count /= LATER_AGGREGATE
    return [*result, (count, 6)]


def iteration(nodes, per_node, per_rank):
    """Returns seconds of (local work, exchanges, reductions, coarsest level)."""
    ranks = nodes * per_node
    all_levels = levels(per_rank * ranks)
    work = exchange = 0
    for level, (count, dofs) in enumerate(all_levels[:-1]):
        active = max(1, min(ranks, count * dofs / 50))  # GAMG keeps at least 50 equations per rank
        own = count / active
        couplings = FINE_COUPLINGS if level == 0 else COARSE_COUPLINGS
        work += 2 * EXCHANGES * own * couplings * dofs ** 2 * 12 / (MEMORY / per_node)
        neighbors = min(FINE_NEIGHBORS if level == 0 else COARSE_NEIGHBORS, active - 1)
        leaving = 4.6 * (per_node * own) ** (2 / 3) * dofs * 8 if nodes > 1 else 0
        exchange += EXCHANGES * (neighbors * LATENCY + ghosts(own) * dofs * 8 / INSIDE + leaving / NETWORK)
    count, dofs = all_levels[-1]
    coarsest = 2 * (count * dofs) ** 2 / FLOPS + 2 * LATENCY * math.log2(max(2, ranks))
    return work, exchange, 3 * REDUCTION * math.log2(max(2, ranks)), coarsest


def main():
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("nodes", type=int, nargs="*", default=[1, 16, 64, 256, 1024, 4096])
    arguments.add_argument("--vertices-per-rank", type=int, default=10_000)
    arguments.add_argument("--ranks-per-node", type=int, default=64)
    options = arguments.parse_args()
    one = sum(iteration(1, options.ranks_per_node, options.vertices_per_rank))
    print("| nodes | M tets | work, ms | exchange, ms | reductions, ms | coarsest, ms | efficiency |\n|---|---|---|---|---|---|---|")
    for nodes in options.nodes:
        parts = iteration(nodes, options.ranks_per_node, options.vertices_per_rank)
        tets = 5.5e-6 * nodes * options.ranks_per_node * options.vertices_per_rank
        cells = " | ".join(f"{1e3 * part:.2f}" for part in parts)
        print(f"| {nodes} | {tets:.0f} | {cells} | {100 * one / sum(parts):.0f} % |")


if __name__ == "__main__":
    main()
