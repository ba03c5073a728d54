"""Sources stay short and finished: at most 500 lines, nothing left to do."""

import pathlib
import re
import sys
import unittest

MAX_LINES = 500
FOLDERS = ("src", "cli", "tests", "bench", "examples", "cmake")
SUFFIXES = (".h", ".cpp", ".py", ".cmake", ".txt")
UNFINISHED = re.compile(r"\b(TO" + r"DO|FIX" + r"ME|XX" + r"X|HA" + r"CK)\b")


def problems_of(text):
    lines = text.splitlines()
    found = []
    if len(lines) > MAX_LINES:
        found.append(f"{len(lines)} lines; split it by topic below {MAX_LINES}")
    found += [f"line {number}: {line.strip()}" for number, line in enumerate(lines, 1) if UNFINISHED.search(line)]
    return found


class Rule(unittest.TestCase):
    def test_long_file(self):
        self.assertEqual(problems_of("x\n" * MAX_LINES), [])
        self.assertEqual(len(problems_of("x\n" * (MAX_LINES + 1))), 1)

    def test_unfinished_line(self):
        self.assertEqual(len(problems_of("int x;  // TO" + "DO: more\n")), 1)


class Sources(unittest.TestCase):
    root = None

    def test_sources_are_short_and_finished(self):
        found = []
        paths = [p for folder in FOLDERS for p in sorted((self.root / folder).rglob("*")) if p.suffix in SUFFIXES]
        for path in paths + [self.root / "dev", self.root / "CMakeLists.txt"]:
            found += [f"{path.relative_to(self.root)}: {p}" for p in problems_of(path.read_text(encoding="utf-8"))]
        self.assertEqual(found, [])


if __name__ == "__main__":
    Sources.root = pathlib.Path(sys.argv.pop(1))
    unittest.main()
