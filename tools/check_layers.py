#!/usr/bin/env python3
"""Fails if a module includes a header of a module that it must not use, by the arrows in docs/architecture.md."""
import pathlib
import re
import sys

WEB = {  # folder of web/src: the folders it may import besides the files directly in web/src
    "panels": "plots view",
    "plots": "view",
    "view": "",
}
LIBRARIES = {  # first part of a third-party header: the files that may include it
    "Eigen": r"(src/linalg|inverse/(model|estimate))/.*\.cpp|tests/bench/naive.*|.*_test\.(cpp|h)",
    "Spectra": r"src/linalg/.*\.cpp",
    "metis.h": r"src/linalg/.*\.cpp",
    "muParser.h": r"src/scene/expression\.cpp",
    "toml++": r"src/scene/.*\.cpp",
    "nlohmann": r"src/(io|scene|results)/.*\.cpp|src/io/gltf_file\.h|apps/.*|inverse/commands/.*|tests/.*|.*_test\.cpp",
    "expat.h": r"src/io/.*\.cpp",
    "zlib.h": r"src/io/.*\.cpp|.*_test\.h|tests/fuzz/.*",
    "emscripten.h": r"apps/engine/.*",
    "boost": r"apps/viewer/server\w*\.(h|cpp)|.*_test\.cpp",
    "CGAL": r"apps/mesh/.*",
    "CLI": r"apps/aspic/.*|inverse/commands/.*|apps/mesh/.*|distributed/program/.*|tests/bench/.*",
    "mpi.h": r"distributed/ranks/.*\.cpp",
    "petscksp.h": r"distributed/ranks/petsc.*",
    "fmt": r"apps/.*|inverse/(bench|commands|page)/.*|distributed/program/.*",
    "spdlog": r"apps/.*",
    "cholmod.h": r".*_test\.cpp|tests/bench/.*",
    "pybind11": r"bindings/python/src/.*",
    "gtest": r".*_test\.cpp|(distributed/)?tests/.*|.*_test\.h",
    "gmock": r".*_test\.cpp|tests/.*",
    "benchmark": r"tests/bench/.*",
}

PARTS = ("src", "inverse", "distributed", "apps", "bindings/python", "tests/reference", "tests/verification")
PARTLY_MISSING = r"std::(ranges::|bit_cast\b|to_chars\(|from_chars\()"  # in the library of the WebAssembly build

root = pathlib.Path(__file__).resolve().parent.parent


def layers():
    """Returns each module of the diagram with the modules that its arrows reach."""
    picture = re.search(r"```mermaid\n(.*?)```", (root / "docs/architecture.md").read_text(), re.S)[1]
    arrows = re.findall(r"^ *(\w+)(?:\[.*?\])? --> (\w+)", picture, re.M)
    direct = {name: {to for start, to in arrows if start == name} for arrow in arrows for name in arrow}

    def reached(name, on_way=()):
        if name in on_way:
            sys.exit(f"docs/architecture.md: the arrows from {name} lead back to {name}")
        return direct[name].union(*(reached(to, (*on_way, name)) for to in direct[name]))

    return {name: reached(name) for name in direct}


def module_of(name):
    """Returns the module of a file; none for tests, examples and benchmarks."""
    parts = name.split("/")
    if name.endswith(("_test.cpp", "_test.h")) or "tests" in parts[1:] or not name.startswith(PARTS):
        return None
    return "mesher" if name.startswith("apps/mesh/") else parts[1]


def check_sources(may_include):
    for folder in ("src", "inverse", "distributed", "apps", "bindings", "tests", "examples"):
        for path in sorted(p for p in (root / folder).rglob("*") if p.suffix in (".h", ".cpp")):
            name = path.relative_to(root).as_posix()
            module = module_of(name)
            for number, line in enumerate(path.read_text().splitlines(), 1):
                ours = re.match(r'#include "(\w+)/', line)
                if ours and module and ours[1] in may_include and ours[1] not in (module, name.split("/")[1]):
                    if ours[1] not in may_include[module]:
                        yield f"{name}:{number}: {module} must not include {ours[1]}"
                if ours and ours[1] == "verification" and name.startswith(("src/", "inverse/")):
                    yield f"{name}:{number}: unit tests share tests/reference with the verification, nothing else"
                theirs = re.match(r"#include <([\w+.]+)", line)
                if theirs and theirs[1] in LIBRARIES and not re.fullmatch(LIBRARIES[theirs[1]], name):
                    yield f"{name}:{number}: {theirs[1]} may not be included here"
                if module not in (None, "mesher", "base") and (names := re.search(PARTLY_MISSING, line)):
                    yield f"{name}:{number}: {names[0]} is missing in libc++ 13; base/compat.h and base/number_chars.h replace it"
                if name.startswith("src/") and name.endswith(".h") and re.match(r"#include <(iostream|regex)>", line):
                    yield f"{name}:{number}: slow to compile; not in a header"


def check_page():
    source = root / "web/src"
    for path in sorted(source.rglob("*.ts")):
        folder = path.relative_to(source).parts[0]
        for number, line in enumerate(path.read_text().splitlines(), 1):
            target = re.search(r'(?:from|import) "(\.[^"]*)"', line)
            imported = (path.parent / target[1]).resolve() if target else source
            if not imported.is_relative_to(source):
                yield f"{path.relative_to(root)}:{number}: only inverse/web may be outside web/src, and imports it"
                continue
            to = imported.relative_to(source).parts
            if folder in WEB and len(to) > 1 and to[0] != folder and to[0] not in WEB[folder].split():
                yield f"{path.relative_to(root)}:{number}: {folder} must not import {to[0]}"


def main():
    may_include = layers()
    folders = [p for name in ("src", "inverse", "apps", "distributed") for p in (root / name).glob("*") if any(p.glob("*.cpp"))]
    missing = {f.name for f in folders} - {"mesh", "tests"} - may_include.keys()
    violations = [f"docs/architecture.md: the diagram does not show {name}" for name in sorted(missing)]
    violations += [*check_sources(may_include), *check_page()]
    print("\n".join(violations) or "all includes follow the diagram")
    sys.exit(bool(violations))


main()
