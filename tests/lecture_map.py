#!/usr/bin/env python3
"""Fails if docs/lecture_to_code.md names a file, an identifier or a page that does not exist, or omits a page."""
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
errors, pages = [], set()


def is_absent(file):
    """Whether the file is of the package of inverse problems, which is not here as a whole."""
    return file.startswith("inverse/") and not (ROOT / "inverse").exists()


for line in (ROOT / "docs" / "lecture_to_code.md").read_text().splitlines():
    row = re.match(r"\| ([\d, -]+) \|(.*)\|(.*)\|(.*)\|$", line)
    if not row:
        continue
    for first, last in re.findall(r"(\d+)(?:-(\d+))?", row[1]):
        pages.update(range(int(first), int(last or first) + 1))
    for names, file in re.findall(r"((?:`\w+`(?:, | and )?)+)[^`]*?\bin `([\w/.]+)`", row[3]):
        text = (ROOT / file).read_text() if (ROOT / file).is_file() else ""
        if not text and not is_absent(file):
            errors.append(f"page {row[1]}: there is no file {file}")
        errors += [f"page {row[1]}: {file} has no {name}" for name in re.findall(r"`(\w+)`", names)
                   if text and not re.search(rf"\b{name}\b", text)]
    for file in re.findall(r"(?:scenes|src|inverse|tests|apps|docs)/[\w/.]+\w", row[3] + row[4]):
        if not (ROOT / file).exists() and not is_absent(file):
            errors.append(f"page {row[1]}: there is no {file}")
    for page in re.findall(r"aspic lecture (\d+)", row[4]):
        if int(page) not in pages:
            errors.append(f"page {row[1]}: its command shows page {page}")
if pages != set(range(1, 63)):
    errors.append(f"missing or unknown pages: {sorted(pages ^ set(range(1, 63)))}")
print("\n".join(errors) or "docs/lecture_to_code.md is valid")
sys.exit(bool(errors))
