#!/usr/bin/env python3
"""tools/check_names.py finds words in identifiers, and only there."""
import pathlib
import subprocess
import sys
import tempfile
import unittest

TOOL = pathlib.Path(__file__).resolve().parent.parent / "tools/check_names.py"


def hits(text, ending):
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder, f"sample{ending}")
        file.write_text(text)
        return subprocess.run([sys.executable, TOOL, file], text=True, stdout=subprocess.PIPE).stdout.splitlines()


class Names(unittest.TestCase):
    def test_splits_snake_case_and_camel_case(self):
        for name in ("take_off_errors", "TakeOff", "kTakeOff", "left_out_errors_", "Look", "learnMore", "unknown", "young_unknowns"):
            found = hits(f"\nint {name} = 0;\n", ".cpp")
            self.assertEqual(len(found), 1, name)
            self.assertIn(f"sample.cpp:2: {name}:", found[0])

    def test_accepts_other_words_and_uses(self):
        self.assertEqual(hits("int outlook, lookup, unknown_key, take, off;\n// the unknown\nauto s = \"look\";\n", ".cpp"), [])
        self.assertEqual(hits("let x: unknown; camera.lookAt(y); f(`look`);\n", ".ts"), [])
        self.assertEqual(hits('"""look"""\nname = "look"  # look\n', ".py"), [])


unittest.main()
