#!/usr/bin/env python3
"""Checks cases.csv of a study against its file by an independent implementation: product, grids, strata, draws.

usage: sweep_oracle.py STUDY.toml FOLDER
"""
import csv
import itertools
import math
import pathlib
import sys
import tomllib
from fractions import Fraction

MASK = 2**64 - 1


def splitmix64(state):
    while True:
        state = (state + 0x9E3779B97F4A7C15) & MASK
        z = ((state ^ (state >> 30)) * 0xBF58476D1CE4E5B9) & MASK
        z = ((z ^ (z >> 27)) * 0x94D049BB133111EB) & MASK
        yield z ^ (z >> 31)


def fnv1a(text):
    value = 0xCBF29CE484222325
    for byte in text.encode():
        value = ((value ^ byte) * 0x100000001B3) & MASK
    return value


def shares(sample, key):
    """The shares of the draws of a key in [0, 1)."""
    count, stream = sample["count"], splitmix64((sample.get("seed", 1) + fnv1a(key)) & MASK)
    uniform = lambda: (next(stream) >> 11) * 2.0**-53
    if sample.get("method", "latin_hypercube") == "random":
        return [uniform() for _ in range(count)]
    stratum = list(range(count))
    for i in reversed(range(1, count)):
        j = next(stream) % (i + 1)
        stratum[i], stratum[j] = stratum[j], stratum[i]
    return [(s + uniform()) / count for s in stratum]


def flatten(table, path=""):
    for key, value in table.items():
        leaf = not isinstance(value, dict) or isinstance(value.get("from"), (int, float))
        if leaf:
            yield path + key, value
        else:
            yield from flatten(value, path + key + ".")


def position(value, spec):
    """The share of a value in its range."""
    low, high = spec["from"], spec["to"]
    return math.log(value / low) / math.log(high / low) if spec.get("scale") == "log" else (value - low) / (high - low)


def is_close(cell, value):
    if isinstance(value, (int, float)) and not isinstance(value, bool):
        return math.isclose(float(cell), value, rel_tol=1e-11)
    return cell == value if isinstance(value, str) else tomllib.loads("v = " + cell)["v"] == value


def check(study, rows):
    varied = list(flatten(study["vary"]))
    sample = study.get("sample", {"count": 1})
    draws, enumerated = {}, []  # keys with ranges to draw from; keys with values
    for key, spec in varied:
        if isinstance(spec, list):
            enumerated.append((key, spec))
        elif "count" in spec:
            n = spec["count"] - 1
            ratio = spec["to"] / spec["from"] if spec.get("scale") == "log" else None
            enumerated.append((key, [spec["from"] * ratio**(k / n) if ratio else spec["from"] + (spec["to"] - spec["from"]) * k / n
                                     for k in range(n + 1)]))
        else:
            draws[key] = spec
    members = list(itertools.product(*[values for _, values in enumerated]))
    assert len(rows) == len(members) * sample["count"], f"{len(rows)} rows"
    assert [row["case"] for row in rows] == [f"{i + 1:06}" for i in range(len(rows))]
    share_of = {key: shares(sample, key) for key in draws}
    for i, row in enumerate(rows):
        for (key, _), value in zip(enumerated, members[i // sample["count"]]):
            assert is_close(row[key], value), f"case {i + 1}: {key} = {row[key]}, expected {value}"
        for key, spec in draws.items():
            share, value = share_of[key][i % sample["count"]], float(row[key])
            if spec.get("scale") == "log":
                assert math.isclose(value, spec["from"] * (spec["to"] / spec["from"])**share, rel_tol=1e-13)
            else:  # one fused multiplication and addition
                assert value == float(Fraction(share) * Fraction(spec["to"] - spec["from"]) + Fraction(spec["from"]))
    if sample.get("method") != "random":
        for key, spec in draws.items():
            strata = [math.floor(position(float(row[key]), spec) * sample["count"]) for row in rows[:sample["count"]]]
            assert sorted(strata) == list(range(sample["count"])), f"{key}: strata {sorted(strata)}"
    return len(rows), len(draws)


if __name__ == "__main__":
    study = tomllib.loads(pathlib.Path(sys.argv[1]).read_text())
    with open(pathlib.Path(sys.argv[2]) / "cases.csv", newline="") as file:
        cases, drawn = check(study, list(csv.DictReader(file)))
    print(f"{cases} cases, {drawn} drawn keys: as expected")
