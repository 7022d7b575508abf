#!/usr/bin/env python3
"""tools/test_times.py [BUILD]: the time of each group of tests in the last run of ctest, longest first, and of single long tests."""
import collections
import pathlib
import re
import sys

build = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else "build/release")
log = (build / "Testing/Temporary/LastTest.log").read_text(errors="replace")
times = [(name, float(seconds)) for name, seconds in
         re.findall(r"^\d+/\d+ Test: (\S+)$(?:.*?)^Test time = +([\d.]+) sec$", log, re.M | re.S)]
groups = collections.defaultdict(lambda: [0, 0.0])
for name, seconds in times:
    group = groups[name.split(".")[0]]
    group[0] += 1
    group[1] += seconds
print(f"{'group':24}{'tests':>6}{'s':>8}")
for name, (count, seconds) in sorted(groups.items(), key=lambda item: -item[1][1]):
    print(f"{name:24}{count:6}{seconds:8.1f}")
print(f"{'all':24}{len(times):6}{sum(s for _, s in times):8.1f}\n\ntests longer than 10 s")
for name, seconds in sorted(times, key=lambda item: -item[1]):
    if seconds > 10:
        print(f"{seconds:8.1f}  {name}")
