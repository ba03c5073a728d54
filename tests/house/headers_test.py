"""Public headers include only Eigen, mien's own public headers and the standard library."""

import pathlib
import re
import sys
import unittest

import house

STANDARD = re.compile(r"[a-z0-9_]+")


def problem_of(bracket, include):
    if bracket == '"':
        if not include.startswith("mien/"):
            return f'"{include}" is not one of mien\'s headers'
        if house.is_private(include):
            return f"{include} is private"
        return None
    if include.startswith("Eigen/") or STANDARD.fullmatch(include):
        return None
    return f"<{include}> is neither Eigen nor of the standard library"


def problems(root):
    found = []
    for path in house.sources(root / "src/mien"):
        if path.suffix != ".h" or house.is_private(path.relative_to(root)):
            continue
        text = path.read_text(encoding="utf-8")
        if not text.startswith("#pragma once\n///"):
            found.append(f"{path.relative_to(root)}: starts with #pragma once and a /// line that says what it is for")
        for bracket, include in house.includes(path):
            problem = problem_of(bracket, include)
            if problem:
                found.append(f"{path.relative_to(root)}: {problem}")
    return found


class Rule(unittest.TestCase):
    def test_what_is_allowed(self):
        for bracket, include in (("<", "vector"), ("<", "Eigen/Core"), ('"', "mien/core/error.h")):
            self.assertIsNone(problem_of(bracket, include))

    def test_what_is_not(self):
        for bracket, include in (("<", "unistd.h"), ("<", "embree3/rtcore.h"), ("<", "nlohmann/json.hpp"),
                                 ('"', "command.h"), ('"', "mien/io/detail/json.h")):
            self.assertIsNotNone(problem_of(bracket, include))


class PublicHeaders(unittest.TestCase):
    root = None

    def test_public_headers_need_eigen_and_the_standard_library_alone(self):
        self.assertEqual(problems(self.root), [])


if __name__ == "__main__":
    PublicHeaders.root = pathlib.Path(sys.argv.pop(1))
    unittest.main()
