#!/usr/bin/env python3
"""Prints file:line of each identifier with words of tools/banned_names. Comments, strings and the type `unknown` are no identifiers."""
import pathlib
import re
import subprocess
import sys

root = pathlib.Path(__file__).resolve().parent.parent
STRING = r'"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])*\''
NOT_CODE = {
    ".py": rf'(?s:("""|\'\'\').*?\1)|{STRING}|#[^\n]*',
    ".ts": rf"{STRING}|`(?:\\.|[^`\\])*`|//[^\n]*|(?s:/\*.*?\*/)|\bunknown\b",
    ".cpp": rf'(?s:R"(\w*)\(.*?\)\1")|{STRING}|//[^\n]*|(?s:/\*.*?\*/)',
}
KIND = {".h": ".cpp", ".mjs": ".ts"}


def words(name):
    return [word.lower() for word in re.findall(r"[A-Z]+(?![a-z])|[A-Z]?[a-z]+", name)]


def rules():
    """Yields (words, whether only at the end, exceptions)."""
    for line in (root / "tools/banned_names").read_text().splitlines():
        if line and not line.startswith("#"):
            name, _, exceptions = line.partition(":")
            yield name.rstrip("$").split("_"), name.endswith("$"), exceptions.split()


def is_banned(path, name, rule):
    banned, at_end, exceptions = rule
    parts = words(name)
    places = [i for i in range(len(parts) - len(banned) + 1) if parts[i : i + len(banned)] == banned]
    if at_end:
        places = [i for i in places if i + len(banned) == len(parts)]
    return places and not any(name == e or e.endswith("/") and path.startswith(e) for e in exceptions)


def code_of(path):
    """Returns the text with blanks in place of comments and strings."""
    kind = pathlib.PurePath(path).suffix
    text = re.sub(r"(?<=[0-9a-fA-F])'(?=[0-9a-fA-F])", "_", (root / path).read_text(errors="replace"))
    return re.sub(NOT_CODE[KIND.get(kind, kind)], lambda found: re.sub(r"[^\n]", " ", found[0]), text)


def faults(files):
    every = list(rules())
    suspicious = re.compile("|".join(rule[0][0] for rule in every), re.I)
    for path in files:
        code = code_of(path)
        for name in filter(suspicious.search, sorted(set(re.findall(r"[A-Za-z_]\w*", code)))):
            for rule in every:
                if is_banned(path, name, rule):
                    number = code[: re.search(rf"\b{name}\b", code).start()].count("\n") + 1
                    yield f"{path}:{number}: {name}: '{' '.join(rule[0])}' is no term; docs/glossary.md has the standard ones"


def main():
    files = sys.argv[1:] or subprocess.check_output(["git", "ls-files", "*.cpp", "*.h", "*.ts", "*.mjs", "*.py"], cwd=root, text=True).split()
    found = list(faults([path for path in files if (root / path).is_file()]))
    print("\n".join(found), end="\n" if found else "")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
