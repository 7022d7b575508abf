#!/usr/bin/env python3
"""Fails if a folder has more lines of code, or of tests, than its budget in tools/budgets.csv.

A change that needs more raises the budget and gives the reason in its message. --update writes the
present lines, rounded up to 50.
"""
import collections
import csv
import pathlib
import re
import subprocess
import sys

CODE = re.compile(r"\.(cpp|h|inc|ts|pyi?|js|mjs|css|html|sh|cmake|in|awk)$|CMakeLists\.txt$|^(run|test|\.ci/run)$|^tools/[^.]*$")
TEST = re.compile(r"_test\.|/test_|\.test\.|^tests/(?!bench|fuzz|reference|verification)|[^s]/tests?/")
DIVIDED = ("apps", "bindings", "distributed", "inverse", "src", "tests", "web")
STEP = 50

root = pathlib.Path(__file__).resolve().parent.parent
table = root / "tools/budgets.csv"


def folder_of(path):
    parts = path.split("/")
    return "/".join(parts[:2]) if parts[0] in DIVIDED and len(parts) > 2 else parts[0] if len(parts) > 1 else "."


def lines():
    """{folder: [lines of code, lines of tests]}"""
    found = collections.defaultdict(lambda: [0, 0])
    for path in subprocess.check_output(["git", "ls-files"], cwd=root, text=True).splitlines():
        if CODE.search(path) and (root / path).is_file():
            found[folder_of(path)][bool(TEST.search(path))] += len((root / path).read_text().splitlines())
    return found


def update(found):
    with open(table, "w", newline="") as file:
        rows = csv.writer(file, lineterminator="\n")
        rows.writerow(["folder", "code", "tests"])
        rows.writerows([folder, *(-(-n // STEP) * STEP for n in counts)] for folder, counts in sorted(found.items()))


def main():
    found = lines()
    if sys.argv[1:] == ["--update"]:
        return update(found)
    with open(table, newline="") as file:
        budgets = {row["folder"]: (int(row["code"]), int(row["tests"])) for row in csv.DictReader(file)}
    faults = [f"{folder}: {now} lines of {kind}, the budget is {most}"
              for folder, counts in sorted(found.items())
              for kind, now, most in zip(("code", "tests"), counts, budgets.get(folder, (0, 0))) if now > most]
    code, tests = (sum(counts[i] for counts in found.values()) for i in (0, 1))
    print("\n".join(faults) or f"{code} lines of code, {tests} of tests: all folders are within their budgets")
    sys.exit(bool(faults))


main()
