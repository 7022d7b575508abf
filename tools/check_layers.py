#!/usr/bin/env python3
"""Fails when a module includes what it may not know. The two tables are the architecture."""
import pathlib
import re
import sys

MODULES = {  # module: the modules it may include
    "base": "",
    "math": "base",
    "mesh": "base math",
    "io": "base math mesh",
    "linalg": "base math",
    "material": "base math",
    "energy": "base math mesh linalg material",
    "optimize": "base math linalg",
    "dynamics": "base math mesh linalg material energy optimize",
    "fit": "base math mesh linalg material energy optimize dynamics",
    "scene": "base math mesh io linalg material energy optimize dynamics",
    "capture": "base math mesh io linalg material energy optimize dynamics fit scene",
    "verification": "base math mesh linalg material energy optimize dynamics",
}
LIBRARIES = {  # first part of a third-party header: the files that may include it
    "Eigen": r"src/linalg/.*\.cpp|bench/naive.*|.*_test\.(cpp|h)",
    "Spectra": r"src/linalg/.*\.cpp",
    "metis.h": r"src/linalg/.*\.cpp",
    "muParser.h": r"src/scene/expression\.cpp",
    "toml++": r"src/scene/.*\.cpp",
    "nlohmann": r"src/scene/.*\.cpp|apps/.*|tests/.*|.*_test\.cpp",
    "expat.h": r"src/io/.*\.cpp",
    "zlib.h": r"src/io/.*\.cpp|.*_test\.h",
    "boost": r"apps/viewer/server\w*\.(h|cpp)|.*_test\.cpp",
    "CGAL": r"apps/mesh/.*",
    "CLI": r"apps/aspic/.*|apps/mesh/.*|bench/.*",
    "fmt": r"apps/.*",
    "spdlog": r"apps/.*",
    "cholmod.h": r".*_test\.cpp|bench/.*",
    "gtest": r".*_test\.cpp|tests/.*|.*_test\.h",
    "gmock": r".*_test\.cpp|tests/.*",
    "benchmark": r"bench/.*",
}

root = pathlib.Path(__file__).resolve().parent.parent
violations = []
folders = [root / name for name in ("src", "inverse", "verification", "apps", "bench", "tests")]
for path in sorted(p for folder in folders for p in folder.rglob("*") if p.suffix in (".h", ".cpp")):
    name = path.relative_to(root).as_posix()
    module = name.removeprefix("src/").removeprefix("inverse/").split("/")[0]
    module = module if module in MODULES else None
    is_test = name.endswith(("_test.cpp", "_test.h"))
    for number, line in enumerate(path.read_text().splitlines(), 1):
        ours = re.match(r'#include "(\w+)/', line)
        if ours and module and not is_test and ours[1] in MODULES and ours[1] != module:
            if ours[1] not in MODULES[module].split():
                violations.append(f"{name}:{number}: {module} must not include {ours[1]}")
        theirs = re.match(r'#include <([\w+.]+)', line)
        if theirs and theirs[1] in LIBRARIES and not re.fullmatch(LIBRARIES[theirs[1]], name):
            violations.append(f"{name}:{number}: {theirs[1]} may not be included here")
        if module and name.endswith(".h") and re.match(r"#include <(iostream|regex)>", line):
            violations.append(f"{name}:{number}: slow to compile; not in a header")
print("\n".join(violations) or "layers are as drawn")
sys.exit(bool(violations))
