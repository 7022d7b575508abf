#!/usr/bin/env python3
"""Fails if a folder lacks a README, if one is longer than 15 lines, if docs/*.md are too long, or if a text names a file that does not
exist.

Lowercase names in backticks of a README are files: of the folder, with or without their ending, or paths from the top; `*` is
any text. Functions end with (). In other pages, paths from the top are files, and links lead to files and headings.
"""
import fnmatch
import functools
import pathlib
import re
import subprocess
import sys

DIVIDED = ("apps", "bindings", "distributed", "inverse", "src")  # each of their folders has a README
LINES = 15
WORDS = 20_000  # of the pages in docs without those of LESSONS
LESSONS = {"tutorial.md", "gallery.md", "teaching.md", "lecture_to_code.md"}  # to be followed, not to be looked up
OLD = r"at [0-9a-f]{8}\b"  # a file of an earlier commit
NEW = "docs/extending.md"  # names files that its reader makes
OTHERS = {"double", "newton_cg", "residual_threshold"}  # a type, a method, a column
WRITTEN = {"./run", "./test", "body*.mesh", "bunny.obj", "scenes/bunny.obj", "capture.toml", "obstacle*.obj", "parameters.json", "scene.toml", "steps.csv"}  # by users or programs
TARGETS = r"\w*aspic\w*|bench_\w+"

root = pathlib.Path(__file__).resolve().parent.parent
tracked = [pathlib.PurePosixPath(p) for p in subprocess.check_output(["git", "ls-files"], cwd=root, text=True).split()]
folders = {folder for path in tracked for folder in path.parents}
top = {path.parts[0] for path in tracked if len(path.parts) > 1 and not path.parts[0].startswith(".")}


def is_of_missing_package(path):
    """Whether a folder of the top was removed, such as `inverse`: the core is complete without it."""
    inside = path.resolve().relative_to(root).parts
    return len(inside) > 0 and inside[0] in top and not (root / inside[0]).exists()


def names_in(folder):
    """Names by which a README may call files and folders: paths from the top, modules, and what is below the folder."""
    names = {str(path) for path in folders.union(tracked)} | {path.name for path in folders}
    for path in tracked:
        if folder in path.parents:
            inside = path.relative_to(folder)
            names |= {str(inside), str(inside.with_suffix("")), path.name, path.name.split(".")[0]}
            names |= {str(part) for part in inside.parents}
    return names


def missing_readmes():
    wanted = {*top} | {str(folder) for folder in folders if len(folder.parts) == 2 and folder.parts[0] in DIVIDED}
    for folder in sorted(wanted - {str(path.parent) for path in tracked if path.name == "README.md"}):
        yield f"{folder}: a README.md is missing"


def faults_of_readme(readme):
    if str(readme) == "README.md" or readme.is_relative_to("examples/data"):
        return
    known = names_in(readme.parent)
    lines = (root / readme).read_text().splitlines()
    if len(lines) > LINES:
        yield f"{readme}: {len(lines)} lines; at most {LINES}"
    for number, line in enumerate(lines, 1):
        for name in re.findall(r"`([a-z0-9_*./]+)`", line):
            if name in OTHERS | WRITTEN or re.fullmatch(TARGETS, name) or fnmatch.filter(known, name.rstrip("/")):
                continue
            yield f"{readme}:{number}: `{name}` is no file; correct the name, or write `{name}()` for a function"


@functools.cache
def anchors(page):
    """Names of the headings of a page in links."""
    headings = re.findall(r"^#+ (.*)", page.read_text(), re.M)
    return {re.sub(r"[^\w -]", "", heading.lower()).replace(" ", "-") for heading in headings}


def faults_of_page(page):
    """Links, and paths from the top in backticks or commands; what builds and runs write is not in the tree."""
    files = {str(path) for path in folders.union(tracked)}
    for number, line in enumerate((root / page).read_text().splitlines(), 1):
        for name in re.findall(rf"(?<![\w./-])(?:{'|'.join(sorted(top))})/[\w*./-]*[\w*]", line):
            patterns = [name, name + ".*", str(page.parent / name)]
            if re.search(r"/[A-Z]+$", name):  # the user's choice
                continue
            if not any(fnmatch.filter(files, pattern) for pattern in patterns) and not re.search(OLD, line) and name not in WRITTEN:
                yield f"{page}:{number}: {name} is no file"
        for link, anchor in re.findall(r"\]\(([^)#:\s]*)(?:#([^)\s]*))?\)", line):
            target = root / page.parent / link if link else root / page
            if is_of_missing_package(target):
                continue
            if not target.exists() or anchor and target.suffix == ".md" and anchor not in anchors(target):
                yield f"{page}:{number}: the link {link}{anchor and '#'}{anchor} leads nowhere"


def too_many_words():
    count = sum(len((root / page).read_text().split()) for page in tracked if str(page.parent) == "docs" and page.suffix == ".md" and page.name not in LESSONS)
    if count > WORDS:
        yield f"docs: {count} words; at most {WORDS}: cut what another page, a table or `--help` states"


def faults():
    yield from missing_readmes()
    yield from too_many_words()
    for page in tracked:
        if is_of_missing_package(root / page):
            continue
        if page.suffix == ".md" and page.name != "CHANGELOG.md" and not page.is_relative_to("docs/adr") and str(page) != NEW:
            if page.name == "README.md":
                yield from faults_of_readme(page)
            yield from faults_of_page(page)


found = list(faults())
print("\n".join(found) or "READMEs: all files exist")
sys.exit(1 if found else 0)
